"""What must hold for drones, for missions that use them, and for behaviours that fly them."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from mmrs_core.analysis.constraints.ranges import Range, positive
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.coordinates import Ground, heights_of_task
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages.element import Element, container_of, is_kind, label_of, metaclass_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_multicopter.kinds import LOWEST_FLIGHT
from mmrs_multicopter.names import DRONE, DRONE_SIZE, GO_TO, LAND, MULTICOPTER, TAKE_OFF

EXACT = 1e-6
"""Metres."""


def too_high(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks above the ceiling of every robot; none where some robot is not a drone."""
    ground = sketch_of(models).ground
    ceiling = _highest_ceiling(mission, models, ground)
    for task in children(mission, "tasks"):
        height = max(heights_of_task(task, ground), default=-inf)
        if height > ceiling:
            yield Finding(
                task, f"task '{label_of(task)}' is at {height:g} m, the team's drones reach {ceiling:g} m"
            )


def too_low(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks below the floor of every robot; none where some robot is not a drone."""
    ground = sketch_of(models).ground
    floors = [_floor(member, models, ground) for member in children(child(mission, "team"), "robots")]
    floor = min(floors, default=-inf)
    for task in children(mission, "tasks"):
        height = min(heights_of_task(task, ground), default=inf)
        if height < floor - EXACT:
            yield Finding(
                task,
                f"task '{label_of(task)}' is at {height:g} m, "
                f"the team's drones fly no lower than {floor:g} m",
            )


def cut_transit(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield a mission whose transits are above the ceiling of every robot; none where some is not a drone."""
    ceiling = _highest_ceiling(mission, models, sketch_of(models).ground)
    transit = number(mission, "transitAltitude")
    if transit is not None and transit > ceiling:
        yield Finding(
            mission,
            f"transitAltitude of '{label_of(mission)}' is {transit:g} m, "
            f"the team's drones go at {ceiling:g} m instead",
        )


def _highest_ceiling(mission: Element, models: ModelSet, ground: Ground) -> float:
    team = child(mission, "team")
    return max((_ceiling(member, models, ground) for member in children(team, "robots")), default=inf)


def _ceiling(member: Element, models: ModelSet, ground: Ground) -> float:
    """Return how high a robot gets, metres above the origin; inf where that is not known."""
    drone, home = _drone(member, models), _home_height(member, ground)
    highest = number(drone, "maxAltitude") if drone is not None else None
    return inf if highest is None or home is None else home + highest


def _floor(member: Element, models: ModelSet, ground: Ground) -> float:
    """Return how low a robot flies, metres above the origin; -inf where that is not known."""
    home = _home_height(member, ground)
    return -inf if _drone(member, models) is None or home is None else home + LOWEST_FLIGHT


def _drone(member: Element, models: ModelSet) -> Element | None:
    robot_type = models.robots.get(text(member, "type"))
    return robot_type if robot_type is not None and is_kind(robot_type, *DRONE) else None


def _home_height(member: Element, ground: Ground) -> float | None:
    home = child(member, "home")
    return ground.positions[home][2] if home is not None and home in ground.positions else None


MISSION = ("urn:mmrs:mission:1.0", "Mission")
TEAM_MEMBER = ("urn:mmrs:mission:1.0", "Robot")

SMALLEST_PROPELLER = 20.0
"""Millimetres under which a propeller's size was most likely given in inches or metres."""
FASTEST = 40.0
"""Metres per second, 144 km/h; beyond it the unit is suspect."""


def _implausibly_fast(drone: Element, models: ModelSet) -> Iterator[Finding]:
    for capability in children(drone, "movementCapabilities"):
        speed = child(capability, "speed")
        fastest = number(speed, "max") if speed is not None else None
        if fastest is not None and fastest > FASTEST:
            yield Finding(
                capability,
                f"largest speed of '{label_of(drone)}' is {fastest:g} m/s, faster than drones that work fly",
            )


def _not_upright(drone: Element, models: ModelSet) -> Iterator[Finding]:
    how = text(drone, "launchType")
    if how and how != "VTOL":
        yield Finding(
            drone, f"launchType of '{label_of(drone)}' is {how}, but launches are planned straight up"
        )


def _plain_size(drone: Element, models: ModelSet) -> Iterator[Finding]:
    size = child(drone, "size")
    if size is not None and not is_kind(size, *DRONE_SIZE):
        yield Finding(size, f"size of '{label_of(drone)}' does not tell its propellers")


def _propeller_tiny(size: Element, models: ModelSet) -> Iterator[Finding]:
    diameter = number(size, "propellerSize")
    if diameter is not None and 0.0 < diameter < SMALLEST_PROPELLER:
        yield Finding(size, f"propellerSize is {diameter:g} mm, which is smaller than any propeller in use")


def _windier_than_held(member: Element, models: ModelSet) -> Iterator[Finding]:
    drone = _type_of(member, "type", models)
    environment = child(models.context, "environment") if models.context is not None else None
    if drone is None or environment is None or not is_kind(drone, *DRONE):
        return
    wind, held = number(environment, "windSpeed"), number(drone, "positionHold")
    if wind is not None and held is not None and wind > held:
        yield Finding(
            member,
            f"robot '{label_of(member)}' holds a position in wind of up to {held:g} m/s, "
            f"the context has {wind:g} m/s",
        )


def _take_off_too_high(take_off: Element, models: ModelSet) -> Iterator[Finding]:
    drone = _type_of(container_of(take_off), "typeName", models)
    altitude = number(take_off, "altitude")
    highest = number(drone, "maxAltitude") if drone is not None else None
    if altitude is not None and highest is not None and altitude > highest:
        yield Finding(
            take_off, f"altitude of the take-off is {altitude:g} m, the type's maxAltitude is {highest:g} m"
        )


def _flown_by_no_drone(move: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield moves of other robots, but none of a subclass: its plug-in knows whose it is."""
    if metaclass_of(move).key[0] != MULTICOPTER:
        return
    robot_type = _type_of(container_of(move), "typeName", models)
    if robot_type is not None and not is_kind(robot_type, *DRONE):
        yield Finding(move, f"robot type '{label_of(robot_type)}' is not a Drone and cannot make this move")


def _type_of(robot: Element | None, feature: str, models: ModelSet) -> Element | None:
    return models.robots.get(text(robot, feature)) if robot is not None else None


CONSTRAINTS = (
    Constraint(
        "MUL001",
        "The largest altitude of a drone is above zero",
        DRONE,
        positive("maxAltitude"),
        "give the height above the take-off point that the drone reaches, in metres",
    ),
    Constraint(
        "MUL002",
        "Drones take off and land upright",
        DRONE,
        _not_upright,
        "check that the launch site suits the drone, or use a type with VTOL",
        Severity.WARNING,
    ),
    Constraint(
        "MUL003",
        "The size of a drone is a DroneSize",
        DRONE,
        _plain_size,
        'write xsi:type="multicopter:DroneSize" and add propellers and propellerSize',
        Severity.WARNING,
    ),
    Constraint(
        "MUL004",
        "A drone has at least three propellers",
        DRONE_SIZE,
        Range(("propellers",), low=3.0),
        "count each propeller, of coaxial pairs too",
    ),
    Constraint(
        "MUL005",
        "The size of propellers is above zero",
        DRONE_SIZE,
        positive("propellerSize"),
        "give the diameter in millimetres",
    ),
    Constraint(
        "MUL006",
        "The size of propellers is given in millimetres",
        DRONE_SIZE,
        _propeller_tiny,
        "one inch is 25.4 mm, one metre is 1000 mm",
        Severity.WARNING,
    ),
    Constraint(
        "MUL007",
        "The wind in which a drone holds its position is above zero",
        DRONE,
        positive("positionHold"),
        "give the wind speed in metres per second, or leave it out where it is not known",
    ),
    Constraint(
        "MUL008",
        "Every drone can hold its position in the wind of the context",
        TEAM_MEMBER,
        _windier_than_held,
        "use another robot type or wait for calmer weather",
    ),
    Constraint(
        "MUL009",
        "Some robot of the team reaches the height of each task",
        MISSION,
        too_high,
        "lower the task or add a robot that flies higher",
    ),
    Constraint(
        "MUL010",
        "A take-off leads up",
        TAKE_OFF,
        positive("altitude"),
        "give the height above the take-off point, in metres",
    ),
    Constraint(
        "MUL011",
        "A take-off ends below the drone's largest altitude",
        TAKE_OFF,
        _take_off_too_high,
        "lower the take-off's altitude",
    ),
    *(
        Constraint(
            code,
            f"Only drones do the move {metaclass[1]} of multicopters",
            metaclass,
            _flown_by_no_drone,
            "use moves that the robot's kind knows, or make its type a Drone",
        )
        for code, metaclass in (("MUL012", TAKE_OFF), ("MUL013", LAND), ("MUL014", GO_TO))
    ),
    Constraint(
        "MUL015",
        "Some robot of the team flies as low as each task",
        MISSION,
        too_low,
        "give the task an altitude of at least 1 m above home, or add a robot that works there",
    ),
    Constraint(
        "MUL016",
        "Some robot of the team reaches the transit altitude",
        MISSION,
        cut_transit,
        "lower transitAltitude, or add a robot that flies higher",
        Severity.WARNING,
    ),
    Constraint(
        "MUL017",
        "The speed of a drone is given in metres per second",
        DRONE,
        _implausibly_fast,
        "divide by 3.6 if this was meant in kilometres per hour",
        Severity.WARNING,
    ),
)
