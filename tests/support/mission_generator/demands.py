"""What random missions ask for beside places and order: times, crews, equipment, patterns, payload, choices.

Each is drawn from its own random numbers, so that the rest of a seed's mission stays as it is. The witness
of a solvable mission keeps all of it.
"""

from random import Random

from mission_generator import shapes
from mission_generator.names import ROBOT, SURVEY

OFTEN = 0.25
"""Share of missions that ask for one of these."""
LATEST = 600.0
"""Seconds within which every task may have begun, as far as its earliest start goes."""
ASIDE = ("Fork", "Join", "RelayTask")
"""Tasks of which nothing is asked here."""

SHARED = ("PhotoGridTask", "RoadTask", "PerimeterTask")
"""Tasks that several robots may be asked to share; of the first there is enough for three."""


def ask(maker, mission, types):
    """Let a mission ask for more."""
    tasks = [task for task in mission.tasks if task.eClass.name not in ASIDE]
    for name, asked in (
        ("choices", _choices),
        ("patterns", _patterns),
        ("equipment", _equipment),
        ("crews", _crews),
        ("priorities", _priorities),
        ("payloads", _payloads),
        ("windows", _windows),
    ):
        random = Random(f"{name} {maker.seed}")
        if random.random() < OFTEN:
            asked(random, maker, mission, tasks, types)


def around(maker, k: int, x: float, y: float, radius: float):
    """Return a task round a disc, instead of one in it; None mostly."""
    random = Random(f"around {maker.seed} {k}")
    if random.random() > 0.5 * OFTEN:
        return None
    name, every, height = f"task {k}", random.choice([6.0, 12.0]), random.choice([15.0, 30.0])
    common = {"name": name, "photoDistance": every, "clockwise": random.random() < 0.5, "altitude": height}
    if random.random() < 0.5:
        turns = random.choice([1, 1, 2])
        size = {"point": maker.point(x, y), "radius": round(random.uniform(0.6, 1.0) * radius, 1)}
        return maker.make(SURVEY, "OrbitTask", turns=turns, **size, **common)
    shell = shapes.star(random, (x, y), radius, random.randint(4, 8), 0.3)
    top = random.choice([None, height + 20.0])
    return maker.make(
        SURVEY,
        "PerimeterTask",
        initialPosition=maker.point(*shell[0]),
        shell=maker.ring(shell),
        distance=random.choice([0.0, 4.0, 8.0]),
        startFromTop=random.random() < 0.5,
        **common,
        **({} if top is None else {"topAltitude": top, "layers": random.choice([2, 3])}),
    )


def arms(mission):
    """Return the dependencies that lead into the arms of a choice; none where the fork is no choice."""
    found = [each for each in mission.taskDependencies if each.from_.eClass.name == "Fork"]
    return found if any(each.condition for each in found) else []


def _choices(random, maker, mission, tasks, types):
    forked = [each for each in mission.taskDependencies if each.from_.eClass.name == "Fork"]
    for k, dependency in enumerate(forked[:-1]):
        dependency.condition = f"clear {k}"
    maker.choosing = bool(forked)


def _patterns(random, maker, mission, tasks, types):
    for task in tasks:
        kind = task.eClass.name
        if kind in ("PhotoGridTask", "RoadTask"):
            task.turnaroundDistance = random.choice([0.0, 5.0, 15.0])
        if kind == "PhotoGridTask":
            task.startCorner = random.choice(["NEAREST", "NORTH_WEST", "SOUTH_EAST"])
            task.crossHatch, task.alternateSwaths = random.random() < 0.4, random.random() < 0.2
            if random.random() < 0.4:
                task.swathAngle = round(random.uniform(0.0, 180.0), 1)
            if task.footprintWidth is not None:
                task.sideOverlap, task.frontOverlap = random.choice([0.0, 0.4]), random.choice([0.0, 0.5])
                task.footprintLength = 0.75 * task.footprintWidth
        elif kind == "RoadTask" and random.random() < 0.5:
            task.photoDistance = random.choice([5.0, 15.0])
        elif kind == "RoadTask":
            task.width, task.footprintWidth, task.footprintLength = random.choice([12.0, 20.0]), 8.0, 6.0
            task.sideOverlap = task.frontOverlap = random.choice([0.0, 0.4])


def _equipment(random, maker, mission, tasks, types):
    """Ask for a device that one type has, or for an action that the first robot has."""
    first = types[mission.team.robots[0].type]
    owner = first if maker.solvable else types[random.choice(mission.team.robots).type]
    owner.devices.append(maker.make(ROBOT, "Device", id="thermometer"))
    for task in tasks:
        if random.random() < 0.4:
            task.requiredDevices = ["camera", "thermometer"]
        else:
            actions = [each.name for each in first.devices[0].supportedActions]
            task.requiredActions = [random.choice(actions)]


def able(task, robot_type):
    """Return whether robots of a type have all that a task requires."""
    devices = {each.id for each in robot_type.devices}
    actions = {action.name for device in robot_type.devices for action in device.supportedActions}
    return devices.issuperset(task.requiredDevices) and actions.issuperset(task.requiredActions)


def _crews(random, maker, mission, tasks, types):
    branches = {each.to.name for each in arms(mission)}
    for task in tasks:
        count = sum(able(task, types[robot.type]) for robot in mission.team.robots)
        shared = task.eClass.name in SHARED[: 1 if maker.solvable else 3]
        wanted = random.randint(1, min(3, count)) if shared and count else 1
        task.robotsWanted = 1 if task.name in branches else wanted


def _priorities(random, maker, mission, tasks, types):
    for task in tasks:
        task.priority = random.randint(0, 2)


def _payloads(random, maker, mission, tasks, types):
    """Let some robots carry something, with which they are no quicker than the slowest without."""
    shorter = 1.0 if maker.solvable else 0.8
    for each in types.values():
        each.maxPayload = 1.0
        capability = maker.capability(10.0, payloadWeight=1.0, lifetime=shorter * maker.lifetime)
        each.movementCapabilities.append(capability)
    for robot in mission.team.robots:
        robot.payload = random.choice([0.0, 0.4, 1.0])


def _windows(random, maker, mission, tasks, types):
    """Ask for times; those of a solvable mission suffice for one robot that does one task after the other."""
    witness = maker.witness()
    enough = sum(_most_seconds(task, witness, maker.lifetime) for task in tasks) if witness else 0.0
    for task in tasks:
        earliest = random.uniform(0.0, LATEST) if random.random() < 0.4 else 0.0
        if earliest:
            task.earliestStart = round(earliest, 1)
        if random.random() < 0.4:
            task.deadline = LATEST + enough if witness else round(earliest + random.uniform(150.0, 1500.0), 1)
        if random.random() < 0.2:
            task.maxDuration = enough if witness else round(random.uniform(60.0, 900.0), 1)


def _most_seconds(task, witness, lifetime: float) -> float:
    """Return the seconds in which one robot has surely done a task, in as many sorties as it takes."""
    photos = 60.0
    if task.eClass.name == "PhotoGridTask":
        east, north = ([getattr(point, axis) for point in task.shell] for axis in ("x", "y"))
        width, length = task.gridResolution, task.gridResolution
        if width is None:
            width = task.footprintWidth * (1.0 - task.sideOverlap)
            length = task.footprintLength * (1.0 - task.frontOverlap)
        photos += 2.0 * (max(east) - min(east) + width) * (max(north) - min(north) + width) / (width * length)
    useful = max(60.0, witness.limit - witness.longest_sortie)
    return (1.0 + 15.0 * photos / useful) * (lifetime + 300.0)
