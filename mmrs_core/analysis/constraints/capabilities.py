"""Robots that can do what a mission asks of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite

from mmrs_core.analysis.constraints.findings import BEHAVIOUR, MISSION, called, finding, guessed, listed
from mmrs_core.analysis.constraints.sketch import DrawnRobot, sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, number, text, texts, value
from mmrs_core.grounding.frame import coordinates_of, is_geographic, origin_of
from mmrs_core.languages.element import Element, Unknown, is_set, metaclass_of, place_of
from mmrs_core.languages.json_form.unknown import kept_name
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.naming import nearest

AIR_PRESSURE = 101_325.0
"""Pascals at the surface, standard atmosphere."""
GRAVITY = 9.80665
"""Metres per second squared, standard."""
LIGHTEST_WATER = 950.0
"""Kilograms per cubic metre, below any that robots meet: where the density is not known, nothing that
some water would allow is called impossible."""


def _kept_type(name: str, models: ModelSet) -> Unknown | None:
    """Return the robot type of that name in a language that is not installed; None if there is none."""
    if name in models.robots:
        return None
    unknown = (root for model in models.models for root in model.roots if isinstance(root, Unknown))
    return next((root for root in unknown if kept_name(root) == name), None)


def _type(robot: Element, models: ModelSet) -> Iterator[Finding]:
    name = text(robot, "type")
    if name and (kept := _kept_type(name, models)) is not None:
        message = f"its type {name!r} stands in {place_of(kept)}, in a language that is not installed"
        ns_uri = kept._mmrs_type.rpartition("#")[0]
        yield finding(robot, message, f"install the plug-in that provides {ns_uri}")
    elif name and name not in models.robots and "" not in models.robots:  # which may be the one that is meant
        known = f"known are {listed(sorted(models.robots))}"
        hint = guessed(known, name, models.robots) if models.robots else ""
        yield finding(robot, f"unknown robot type {name!r}", hint)


def devices_of(robot_type: Element | None) -> Mapping[str, frozenset[str]]:
    """Return the names of supported actions by identifier of device of a robot type."""
    devices: dict[str, frozenset[str]] = {}
    for device in children(robot_type, "devices"):
        name, actions = text(device, "id"), children(device, "supportedActions")
        devices[name] = devices.get(name, frozenset()) | {text(action, "name") for action in actions}
    return devices


def lacks(task: Element, robot_type: Element) -> tuple[str, ...]:
    """Return what a task asks for and a robot type does not have, in words."""
    devices = devices_of(robot_type)
    actions = frozenset(action for supported in devices.values() for action in supported)
    missing = [f"device '{each}'" for each in _devices_asked(task) if each not in devices]
    missing += [f"action '{each}'" for each in texts(task, "requiredActions") if each not in actions]
    device, action = text(task, "deviceId"), _action_asked(task)
    if action and action not in devices.get(device, actions):
        missing.append(f"action '{action}'" + (f" of device '{device}'" if device else ""))
    return tuple(dict.fromkeys(missing))


def _devices_asked(task: Element) -> tuple[str, ...]:
    named = text(task, "deviceId")
    return (*texts(task, "requiredDevices"), *([named] if named else []))


def _action_asked(task: Element) -> str:
    """Return the action that a task names; a default may belong to something that the task does not use."""
    named = "actionName" in metaclass_of(task).by_name and is_set(task, "actionName")
    return text(task, "actionName") if named else ""


def able(task: Element, models: ModelSet) -> tuple[DrawnRobot, ...]:
    """Return the robots of the team whose type has the devices and actions that a task names.

    There is none where the type of one is not known: what it can do is not known either.
    """
    return tuple(robot for robots in able_by_type(task, models) for robot in robots)


def able_by_type(task: Element, models: ModelSet) -> list[tuple[DrawnRobot, ...]]:
    """Return what `able` does, by type."""
    types = sketch_of(models).types
    if None in types:
        return []
    return [robots for robot_type, robots in types.items() if robot_type and not lacks(task, robot_type)]


def undoable(task: Element, models: ModelSet) -> bool:
    """Return whether it is known that no robot of the team has what a task names."""
    types = sketch_of(models).types
    return bool(types) and None not in types and not able_by_type(task, models)


def _nobody(task: Element, models: ModelSet) -> Iterator[Finding]:
    if undoable(task, models):
        types = {
            text(robot.type, "name"): robot.type
            for robot in sketch_of(models).robots
            if robot.type is not None
        }
        reasons = "; ".join(f"{name} lacks {' and '.join(lacks(task, each))}" for name, each in types.items())
        yield finding(task, f"no robot of the team can do it: {reasons}")


def _too_many(task: Element, models: ModelSet) -> Iterator[Finding]:
    wanted = number(task, "robotsWanted")
    if wanted is not None and 0 < (count := sum(map(len, able_by_type(task, models)))) < wanted:
        yield finding(task, f"wants {wanted:g} robots, but only {count} of the team can do it")


def _shared_point(task: Element, models: ModelSet) -> Iterator[Finding]:
    wanted = number(task, "robotsWanted")
    if wanted is not None and wanted > 1:
        yield finding(task, f"wants {wanted:g} robots, but a point cannot be shared")


def _too_deep(task: Element, models: ModelSet) -> Iterator[Finding]:
    depth = _depth(task, models)
    if depth is None:
        return
    types = {robots[0].type for robots in able_by_type(task, models) if robots[0].type is not None}
    limits = [_deepest(each, models) for each in types]
    known = [limit for limit in limits if limit is not None]
    if known and len(known) == len(limits) and depth > max(known):
        yield finding(
            task, f"is {depth:g} m below the surface, but no robot of the team works below {max(known):.4g} m"
        )


def _depth(task: Element, models: ModelSet) -> float | None:
    """Return how far below the surface the deepest point of a task lies, metres; None where none is given."""
    ground = sketch_of(models).ground
    altitude, depth = number(task, "altitude"), number(task, "depth")
    if depth is not None:
        return depth
    ups = [ground.positions[each][2] for each in coordinates_of(task) if each in ground.positions]
    lowest = altitude if altitude is not None else min(ups, default=None)
    return None if lowest is None or lowest >= ground.frame.surface else ground.frame.surface - lowest


def _deepest(robot_type: Element, models: ModelSet) -> float | None:
    pressure = number(robot_type, "maxOperatingPressure")
    environment = child(models.context, "environment") if models.context is not None else None
    density = number(environment, "waterDensity") if environment is not None else None
    if pressure is None or not isfinite(pressure):
        return None
    return max(pressure - AIR_PRESSURE, 0.0) / ((density or LIGHTEST_WATER) * GRAVITY)


def _overloaded(robot: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type, payload = models.robots.get(text(robot, "type")), number(robot, "payload")
    if robot_type is None or payload is None or payload <= 0:
        return
    largest = number(robot_type, "maxPayload")
    if largest is None:
        yield finding(
            robot, f"carries {payload:g} kg, but its type {text(robot, 'type')!r} states no maxPayload"
        )
    elif payload > largest:
        yield finding(robot, f"carries {payload:g} kg, but its type carries at most {largest:g} kg")


def _unmeasured(robot: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type, payload = models.robots.get(text(robot, "type")), number(robot, "payload")
    weights = [number(each, "payloadWeight") for each in children(robot_type, "movementCapabilities")]
    heaviest = max((each for each in weights if each is not None), default=None)
    if payload is not None and heaviest is not None and payload > heaviest:
        yield finding(
            robot,
            f"carries {payload:g} kg, but {called_type(robot_type)} gives figures up to {heaviest:g} kg only",
        )


_SENSORS = ("gyro", "accelerometer", "magnetometer", "barometer", "pressuremeter")
"""Sensors by which a robot type shows that it lists its sensors, so that it deliberately has no receiver."""


def _without_satellites(robot: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type, origin = models.robots.get(text(robot, "type")), origin_of(models.mission)
    if robot_type is None or origin is None or not is_geographic(origin):
        return
    if not value(robot_type, "gps") and any(value(robot_type, each) is True for each in _SENSORS):
        yield finding(
            robot, f"the mission is geographic, but its type {text(robot, 'type')!r} has sensors and no gps"
        )


def called_type(robot_type: Element | None) -> str:
    """Return what messages call a robot type."""
    return called(robot_type) if robot_type is not None else "its type"


def _accepted(root: Element, models: ModelSet) -> Iterator[Finding]:
    accepted = texts(root, "acceptedUnknowns")
    if not accepted:
        return  # most missions accept none, and need no check to be imported
    from mmrs_core.analysis.checks import CHECKS

    known = sorted(check.name for check in CHECKS)
    for name in accepted:
        if name not in known:
            guess = nearest(name, known)
            yield finding(
                root,
                f"accepts that {name!r} stays unknown, which is not a check of the core",
                f"checks are {', '.join(known)}{'; ' + guess if guess else ''}; a plug-in may have others",
            )


CONSTRAINTS = (
    Constraint(
        "MML004",
        "The type of every robot is known.",
        (MISSION, "Robot"),
        _type,
        "add the robot type to the project's robots folder",
    ),
    *Constraint(
        "MML012",
        "Unknowns are accepted by the names of checks.",
        (MISSION, "Mission"),
        _accepted,
        "name a check, such as clearance",
        Severity.WARNING,
    ).also(("BL049", (BEHAVIOUR, "Behaviour"))),
    Constraint(
        "MML064",
        "Every task has a robot with the devices and actions that it asks for.",
        (MISSION, "Task"),
        _nobody,
        "add a robot that has them to the team, or the device to a robot type",
    ),
    Constraint(
        "MML065",
        "No task wants more robots than can do it.",
        (MISSION, "Task"),
        _too_many,
        "lower robotsWanted, or add robots to the team",
    ),
    Constraint(
        "MML066",
        "Every task is within the robots' depth rating.",
        (MISSION, "Task"),
        _too_deep,
        "lift the task, or add a robot with a larger maxOperatingPressure to the team",
    ),
    Constraint(
        "MML067",
        "No robot carries more than its type can.",
        (MISSION, "Robot"),
        _overloaded,
        "reduce the payload, or state maxPayload in the robot type",
    ),
    Constraint(
        "MML068",
        "The figures of a robot's type reach as far as the payload it carries.",
        (MISSION, "Robot"),
        _unmeasured,
        "add a movement capability for that payload to the robot type",
    ),
    Constraint(
        "MML014",
        "Robots of a geographic mission find their positions by satellites.",
        (MISSION, "Robot"),
        _without_satellites,
        'write gps="true" if the robot type has a receiver, or give all places as relative coordinates',
        Severity.WARNING,
    ),
    Constraint(
        "MML069",
        "A task at one point wants one robot.",
        (MISSION, "PointTask"),
        _shared_point,
        "leave robotsWanted out; for several robots at the point, write a task for each",
    ),
)
