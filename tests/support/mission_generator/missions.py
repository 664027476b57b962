"""Random missions of multicopters over survey tasks.

A mission of the solvable sort is made so that a simple plan exists: everything that stands in the
way is convex, nothing is nearer to anything else than a wide robot needs to pass between, no task or
home touches anything, drones can fly above every obstacle or around it, and any single piece of work
with the way there and back fits into one sortie. The witness is that plan: the first robot flies one
piece after the other, recharging in between. Missions of the wild sort promise nothing of the kind.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import hypot
from random import Random

from mission_generator import demands, shapes
from mission_generator.names import CONTEXT, DRONE, MISSION, ROBOT, SURVEY

DEMANDING = 300_000
"""The first seed whose mission asks for times, crews, equipment, patterns and more."""
SIZE = 400.0
GAP = 30.0
RADIO, FAR = 300.0, 5000.0
"""Metres that radios reach in missions with relays, and in others."""
HOVERING = 500.0
"""Metres that they reach in missions in which robots are relays, which others then need for most tasks."""
DETOUR = 1.6
LARGEST = (10, 5)
"""Robots and tasks that a mission has at most, usually."""


@dataclass(frozen=True)
class Witness:
    """The simple plan of a solvable mission: seconds of the longest sortie it needs, and of the limit."""

    longest_sortie: float
    limit: float


@dataclass(frozen=True)
class Sample:
    """A random mission, its context and its robot types as model elements, ready for a ModelSet."""

    seed: int
    mission: object
    context: object
    robots: dict
    witness: Witness | None


class Maker:
    """Makes model elements of one random mission."""

    def __init__(self, seed: int, registry, largest: tuple[int, int]) -> None:
        self.seed, self.random, self.registry, self.largest = seed, Random(seed), registry, largest
        self.solvable = self.random.random() < 0.6
        self.taken: list[tuple[float, float, float]] = []
        self.far, self.through = 0.0, False
        self.inside: list[tuple[float, float, float]] = []
        self.work: list[tuple[float, float, float]] = []
        self.relayed = Random(f"relays {seed}").random() < 0.3
        self.demanding, self.choosing = seed >= DEMANDING, False
        self.hovering = not (self.solvable or self.relayed) and Random(f"hovering {seed}").random() < 0.4

    def make(self, namespace: str, metaclass: str, /, **features):
        return self.registry.create(namespace, metaclass, **features)

    def point(self, x: float, y: float, z: float = 0.0):
        self.far = max(self.far, hypot(x, y))
        return self.make(MISSION, "RelativeCoordinate", x=x, y=y, z=z)

    def ring(self, points):
        return [self.point(x, y) for x, y in points]

    def sample(self) -> Sample:
        random = self.random
        robots = self._robots(random.randint(1, self.largest[0]))
        tasks = self._tasks(random.randint(1, self.largest[1]))
        dependencies = self._dependencies(tasks)
        tasks += self._hovering() if self.hovering else []
        context = self._context()
        types = {t.name: t for t in self._types()}
        origin = self.make(
            MISSION, "GeoCoordinate", latitude=random.uniform(-60, 70), longitude=random.uniform(-179, 179)
        )
        local = self.make(MISSION, "RelativeCoordinate", x=0.0, y=0.0, z=0.0)
        mission = self.make(
            MISSION,
            "Mission",
            name=f"random {self.seed}",
            origin=local if random.random() < 0.2 else origin,
            team=self.make(MISSION, "Team", robots=robots),
            tasks=tasks,
            taskDependencies=dependencies,
            transitAltitude=random.choice([30.0, 45.0]),
            positionError=random.choice([0.0, 0.5]),
            reserve=0.2,
            minimumSeparation=self._separation(),
        )
        if self.demanding:
            demands.ask(self, mission, types)
        return Sample(self.seed, mission, context, types, self.witness())

    def _separation(self) -> float | None:
        """Return the metres that robots must keep apart, if any: less than homes are apart."""
        random = Random(f"separation {self.seed}")
        return random.choice([3.0, 5.0, 8.0]) if random.random() < 0.4 else None

    def _robots(self, count: int):
        discs = [(12.0 * k, -SIZE - 40.0, 6.0) for k in range(count)]
        self.taken.extend(discs)
        return [
            self.make(
                MISSION,
                "Robot",
                name=f"drone {k}",
                type="quick" if self.random.random() < 0.3 else "steady",
                home=self.point(x, y),
                travelMode=self.random.choice(["SAFE", "NORMAL", "AGGRESSIVE"]),
                returnHome=self.solvable or self.random.random() < 0.9,
            )
            for k, (x, y, _) in enumerate(discs)
        ]

    def _tasks(self, count: int):
        gap = GAP if self.solvable else -15.0
        discs = shapes.separated(self.random, count, SIZE, (25.0, 90.0), gap, self.taken)
        self.taken.extend(discs)
        self.work = discs or [(0.0, 0.0, 40.0)]
        tasks = [self._task(k, *disc) for k, disc in enumerate(discs)]
        return tasks or [self._task(0, 0.0, 0.0, 40.0)]

    def _task(self, k: int, x: float, y: float, radius: float):
        kind = self.random.choice(["PhotoGridTask"] * 3 + ["GoToTask", "RoadTask", "ObserveTask"])
        task = getattr(self, f"_{kind}")(f"task {k}", x, y, radius)
        return (demands.around(self, k, x, y, radius) if self.demanding else None) or task

    def _PhotoGridTask(self, name, x, y, radius):  # noqa: N802
        shell = shapes.star(self.random, (x, y), radius, self.random.randint(4, 11))
        holes = []
        if self.random.random() < 0.4:
            hole = shapes.ngon((x, y), radius * 0.25, self.random.randint(3, 6), 0.3)
            if shapes.contains(shell, hole):
                holes = [self.make(MISSION, "Ring", points=self.ring(hole))]
        elif self.random.random() < 0.5:
            self.inside.append((x, y, radius * 0.2))
        grid = self.random.choice([8.0, 12.0, 20.0])
        footprint = self.random.random() < 0.4
        size = (
            {"footprintWidth": grid, "footprintLength": grid, "sideOverlap": 0.2, "frontOverlap": 0.3}
            if footprint
            else {"gridResolution": grid}
        )
        return self.make(
            SURVEY,
            "PhotoGridTask",
            name=name,
            initialPosition=self.point(*shell[0]),
            shell=self.ring(shell),
            holes=holes,
            altitude=self.random.choice([15.0, 25.0, 40.0]),
            **size,
        )

    def _GoToTask(self, name, x, y, radius):  # noqa: N802
        speed = self.random.choice(["NORMAL", "SLOW", "QUICK"])
        return self.make(SURVEY, "GoToTask", name=name, point=self.point(x, y, 20.0), type=speed)

    def _RoadTask(self, name, x, y, radius):  # noqa: N802
        line = [(x - radius / 2, y), (x, y + radius / 3), (x + radius / 2, y)]
        return self.make(
            SURVEY,
            "RoadTask",
            name=name,
            initialPosition=self.point(*line[0]),
            points=self.ring(line),
            altitude=20.0,
            inverted=self.random.random() < 0.5,
        )

    def _ObserveTask(self, name, x, y, radius):  # noqa: N802
        return self.make(
            SURVEY, "ObserveTask", name=name, point=self.point(x, y), duration=20.0, altitude=25.0
        )

    def _dependencies(self, tasks):
        if len(tasks) < 3 or self.random.random() < 0.3:
            pairs = [(a, b) for a, b in pairwise(tasks) if self.random.random() < 0.3]
        else:
            fork = self.make(MISSION, "Fork", name="fork")
            join = self.make(MISSION, "Join", name="join")
            first, *middle, last = list(tasks)
            if len(middle) < 2:
                middle.append(last)
            pairs = [(first, fork)]
            for task in middle:
                pairs += [(fork, task), (task, join)]
            if last is not middle[-1]:
                pairs.append((join, last))
            tasks += [fork, join]
        return [self.make(MISSION, "TaskDependency", **{"from_": a, "to": b}) for a, b in pairs]

    def _context(self):
        gap = GAP if self.solvable else -20.0
        count = self.random.randint(0, 8)
        discs = shapes.separated(self.random, count, SIZE, (5.0, 50.0), gap, self.taken)
        forbidden, obstacles = [], []
        for k, (x, y, radius) in enumerate([*discs, *self.inside]):
            ring = self.ring(shapes.ngon((x, y), radius, self.random.randint(3, 8), k * 0.7))
            safety = self.random.choice([0.0, 1.0, 4.0])
            if self.random.random() < 0.5:
                features = {"name": f"forbidden {k}", "shell": ring, "safetyDistance": safety}
                forbidden.append(self.make(CONTEXT, "Area", **features))
            else:
                top = self.random.choice([10.0, 22.0, 60.0, 200.0])
                obstacles.append(
                    self.make(
                        CONTEXT,
                        "Obstacle",
                        name=f"obstacle {k}",
                        shell=ring,
                        safetyDistance=safety,
                        maxHeight=top,
                    )
                )
        landing = self.ring(shapes.ngon((0.0, -SIZE - 90.0), 20.0, 6, 0.0))
        emergency = [self.make(CONTEXT, "Area", name="landing", shell=landing)]
        return self.make(
            CONTEXT,
            "Context",
            forbiddenAreas=forbidden,
            obstacles=obstacles,
            emergencyAreas=emergency,
            corridors=self._corridors(),
            elements=[*self._relays()] if self.relayed else [],
            environment=None if self.solvable else self._wind(),
        )

    def _corridors(self):
        """Return up to two corridors south of the homes, where nothing is in the way."""
        random = Random(f"corridors {self.seed}")
        if random.random() < 0.75:
            return []
        self.through = True
        found = []
        for k, use in enumerate(
            random.choice([["BOTH"], ["ENTRY"], ["EXIT"], ["ENTRY", "EXIT"], ["BOTH"] * 2])
        ):
            x, y = random.uniform(-150.0, 250.0), -SIZE - random.uniform(130.0, 170.0) - 60.0 * k
            line = [(x, y), (x + random.choice([-60.0, 60.0]), y + random.uniform(-20.0, 20.0))]
            if random.random() < 0.4:
                line.insert(1, (x, y - 25.0))
            low = random.choice([None, 18.0, 35.0])
            high = random.choice([None, (low or 0.0) + 25.0])
            heights = {"minHeight": low, "maxHeight": high}
            found.append(
                self.make(
                    CONTEXT,
                    "Corridor",
                    name=f"corridor {k}",
                    points=self.ring(line),
                    width=random.uniform(10.0, 20.0),
                    use=use,
                    robotTypes=["steady"] if random.random() < 0.2 else [],
                    **{name: value for name, value in heights.items() if value is not None},
                )
            )
        return found

    def _relays(self):
        """Return relays in a row from the homes to each task, so that paths between tasks lead back.

        Rows are wide enough for every detour around an obstacle; in wild missions some relays are missing.
        """
        random = Random(f"relays of {self.seed}")
        begin = (50.0, -SIZE - 40.0)
        corridors = [(50.0, -SIZE - 240.0, 0.0)] if self.through else []
        for row, (x, y, _) in enumerate([*self.work, *corridors]):
            count = int(hypot(x - begin[0], y - begin[1]) / 200.0) + 1
            for k in range(1, count + 1):
                east, north = (a + (b - a) * k / count for a, b in zip(begin, (x, y), strict=True))
                position = self.point(east, north, random.choice([0.0, 10.0, 25.0]))
                far = random.uniform(RADIO, 2.0 * RADIO)
                if self.solvable or random.random() < 0.8:
                    name = f"relay {row}.{k}"
                    yield self.make(CONTEXT, "Relay", name=name, position=position, range=far)

    def _hovering(self):
        """Yield tasks of robots that are relays: one in the middle, and perhaps another one beyond it."""
        random = Random(f"hovering in {self.seed}")
        for k in range(random.choice([1, 1, 2])):
            place = random.uniform(-60.0, 160.0), -SIZE - 40.0 + 420.0 * (k + 1) - random.uniform(0.0, 60.0)
            height = random.choice([30.0, 60.0, 90.0])
            yield self.make(SURVEY, "RelayTask", name=f"hover {k}", point=self.point(*place, height))

    def _wind(self):
        return self.make(
            CONTEXT,
            "Environment",
            windSpeed=self.random.uniform(0.0, 7.0),
            windDirection=self.random.uniform(0.0, 360.0),
        )

    def _types(self):
        short = not self.solvable and self.random.random() < 0.4
        self.lifetime = 150.0 if short else self.random.choice([1200.0, 1800.0])
        for name, fastest in (("steady", 10.0), ("quick", 16.0)):
            actions = [self.make(ROBOT, "SupportedAction", name="TakePicture", duration=1.0)]
            properties = []
            if self.random.random() < 0.5:
                distance = self.make(ROBOT, "Parameter", key="distance")
                actions += [
                    self.make(ROBOT, "SupportedAction", name="TriggerByDistance", parameters=[distance])
                ]
                properties = [self.make(ROBOT, "Property", name="capture.interval", value="1.5")]
            camera = self.make(ROBOT, "Device", id="camera", supportedActions=actions, properties=properties)
            yield self.make(
                DRONE,
                "Drone",
                name=name,
                gps=True,
                communicationRange=RADIO if self.relayed else HOVERING if self.hovering else FAR,
                relayRange=HOVERING if self.hovering else None,
                onBoardObstacleAvoidance=False,
                launchType="VTOL",
                maxAltitude=120.0,
                positionHold=10.0,
                size=self.make(
                    DRONE,
                    "DroneSize",
                    width=0.6,
                    length=0.6,
                    height=0.3,
                    weight=1.5,
                    propellers=4,
                    propellerSize=250.0,
                ),
                devices=[camera],
                batteries=[self.make(ROBOT, "Battery", capacity=5000.0, voltage=14.8, rechargeTime=120.0)],
                movementCapabilities=[self.capability(fastest, payloadWeight=0.0, lifetime=self.lifetime)],
            )

    def capability(self, fastest: float, **features):
        """Return how robots move with a payload of one weight."""
        limits = {"maxAcceleration": 3.0, "maxClimbRate": 3.0, "maxDescentRate": 2.0}
        speed = self.make(ROBOT, "Interval", min=0.0, max=fastest)
        return self.make(ROBOT, "MovementCapability", speed=speed, **limits, **features)

    def witness(self) -> Witness | None:
        """Return the witness of a solvable mission: the longest sortie is far out and back, once.

        Where it is chosen what to do, far out and back twice: to where that is decided, and to what is done.
        """
        if not self.solvable:
            return None
        slowest = 0.5 * 10.0
        climbs = 120.0 / 3.0 + 120.0 / 2.0
        way = 2 * DETOUR * (self.far + SIZE * (2 if self.through else 1)) / slowest
        way *= 2 if self.choosing else 1
        return Witness(way + climbs + 60.0, self.lifetime * 0.8)


def sample(seed: int, registry, largest: tuple[int, int] = LARGEST) -> Sample:
    """Return the random mission of that seed; the same seed makes the same mission.

    Args:
        seed: of the mission. registry: of its languages.
        largest: robots and tasks that it has at most.
    """
    made = Maker(seed, registry, largest).sample()
    if made.witness is not None and made.witness.longest_sortie > made.witness.limit:
        return Sample(made.seed, made.mission, made.context, made.robots, None)
    return made
