"""From tasks to work: what each task is made of, for each robot that could do it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from math import ceil, dist, inf, isfinite

from mmrs_core.contributions.rules import (
    ElementKind,
    RobotKind,
    Rule,
    barriers,
    most_specific,
    robot_kind_of,
)
from mmrs_core.errors import InfeasibleError, MmrsError, PluginError
from mmrs_core.scene import (
    Device,
    Kinematics,
    Name,
    Part,
    Robot,
    Scene,
    SharedWorks,
    Stroke,
    Task,
    Value,
    Work,
)

CONTROL_TASK = ("urn:mmrs:mission:1.0", "ControlTask")


def expand(
    scene: Scene,
    rules: Mapping[Name, Rule],
    robot_kinds: Mapping[Name, RobotKind],
    element_kinds: Mapping[Name, ElementKind],
) -> Scene:
    """Return the scene with every robot's kinematics and barriers, and the work of every task for each.

    Raises:
        InfeasibleError: if a task can be done by no robot, or a robot is of no known kind; lists all
            of them, each with the reason for each robot.
    """
    robots = tuple(_with_kinematics(robot, scene, robot_kinds) for robot in scene.robots)
    types = {robot.type.name: robot.type for robot in robots}
    barred = barriers(scene.elements, scene.areas, types.values(), robot_kinds, element_kinds)
    scene = replace(scene, robots=robots, areas=(*scene.areas, *barred))
    numbers = dict[tuple[str, float, Kinematics | None], int]()
    works = SharedWorks(
        {
            robot.name: numbers.setdefault((robot.type.name, robot.clearance, robot.kinematics), len(numbers))
            for robot in robots
        }
    )
    refusals: dict[tuple[str, str], str] = {}
    for task in scene.tasks:
        if not task.part.is_a(CONTROL_TASK):
            _expand_task(task, scene, rules, works, refusals)
    reasons = list(_undoable(scene, works, refusals))
    if reasons:
        raise InfeasibleError(f"{len(reasons)} of the tasks can be done by no robot", reasons)
    return replace(scene, works=works, refusals=refusals)


def _with_kinematics(robot: Robot, scene: Scene, kinds: Mapping[Name, RobotKind]) -> Robot:
    kind = robot_kind_of(robot.type, kinds)
    if kind is None:
        raise InfeasibleError(
            f"robot '{robot.name}': no installed plug-in knows how robots of type '{robot.type.name}' move"
        )
    try:
        kinematics = kind.kinematics(robot, scene)
    except InfeasibleError as error:
        raise InfeasibleError(f"robot '{robot.name}': {error}") from error
    clearance = robot.clearance + kinematics.room
    return replace(robot, kind=kind.name, kinematics=kinematics, clearance=clearance)


def _expand_task(
    task: Task,
    scene: Scene,
    rules: Mapping[Name, Rule],
    works: SharedWorks,
    refusals: dict[tuple[str, str], str],
) -> None:
    name = most_specific(task.part.metaclasses, rules)
    if name is None:
        what = task.part.metaclasses[0][1] if task.part.metaclasses else "unknown type"
        raise InfeasibleError(f"task '{task.name}': no installed plug-in has a rule for a {what}")
    alike: dict[int, Work | str] = {}
    without = set[str]()
    for robot in scene.robots:
        sort = works.sorts[robot.name]
        if sort not in alike:
            alike[sort] = _work(task, robot, scene, rules[name])
        found = alike[sort]
        refusal = found if isinstance(found, str) else out_of_reach(found, robot)
        if refusal:
            refusals[task.name, robot.name] = refusal
            without.add(robot.name)
    by_sort = [each if isinstance(each, Work) else None for _, each in sorted(alike.items())]
    works.add(task.name, by_sort, without)


def _work(task: Task, robot: Robot, scene: Scene, rule: Rule) -> Work | str:
    missing = next(_missing(task, robot.type.devices), None) or unfit(robot, scene)
    if missing:
        return missing
    try:
        return work_of(rule, task, robot, scene)
    except InfeasibleError as error:
        return "; ".join(error.reasons)


def _missing(task: Task, devices: Mapping[str, Device]) -> Iterator[str]:
    supported = {action for device in devices.values() for action in device.actions}
    yield from (f"has no device '{device}'" for device in task.devices if device not in devices)
    yield from (f"has no device for action '{action}'" for action in task.actions if action not in supported)


def _undoable(
    scene: Scene, works: Mapping[tuple[str, str], Work], refusals: Mapping[tuple[str, str], str]
) -> Iterator[str]:
    for task in scene.tasks:
        if task.part.is_a(CONTROL_TASK) or any((task.name, robot.name) in works for robot in scene.robots):
            continue
        why = "; ".join(f"{robot.name}: {refusals[task.name, robot.name]}" for robot in scene.robots)
        yield f"task '{task.name}' can be done by no robot ({why})"


def unfit(robot: Robot, scene: Scene) -> str | None:
    """Return why no robot of that type operates in the weather of the scene; None if it does.

    Unknown weather and unknown limits are not a reason.
    """
    interval = robot.type.part.attributes.get("operatingTemperature")
    temperature = scene.environment.get("temperature")
    if temperature is None or not isinstance(interval, Part):
        return None
    lowest = _number(interval.attributes.get("min"), -inf)
    highest = _number(interval.attributes.get("max"), inf)
    if lowest <= temperature <= highest:
        return None
    return f"operates from {lowest:g} to {highest:g} °C, not at {temperature:g} °C"


def out_of_reach(work: Work, robot: Robot) -> str | None:
    """Return why the radio does not reach all of a work from the robot's home; None if it does."""
    reach = _number(robot.type.part.attributes.get("communicationRange"), inf)
    if reach == inf:
        return None
    places = (point for stroke in work.strokes for point in stroke.points)
    farthest = max((dist(place, robot.home) for place in places), default=0.0)
    if farthest <= reach:
        return None
    return f"would be {ceil(farthest)} m from home, its radio reaches {reach:g} m"


def _number(value: Value, absent: float) -> float:
    return float(value) if isinstance(value, (int, float)) else absent


BEYOND = 1e-6
"""Metres by which an action may lie beyond a stroke's end, by rounding."""


def work_of(rule: Rule, task: Task, robot: Robot, scene: Scene) -> Work:
    """Return what a rule makes of a task.

    Raises:
        InfeasibleError: if the robot cannot do the task.
        PluginError: if the rule fails, or returns an unsound work; names the rule.
    """
    place = f" ({task.part.place})" if str(task.part.place) else ""
    where = f"rule '{rule.name}', task '{task.name}'{place}, robot '{robot.name}'"
    try:
        work = rule.work(task, robot, scene)
    except PluginError as error:
        raise PluginError(f"{where}: {error}") from error
    except MmrsError:
        raise
    except Exception as error:
        raise PluginError(f"{where}: fails: {error!r}") from error
    fault = next(_faults(work), None)
    if fault is not None:
        raise PluginError(f"{where}: {fault}")
    return work


def _faults(work: object) -> Iterator[str]:
    if not isinstance(work, Work):
        yield f"returns {type(work).__name__}, not a Work"
        return
    if not work.strokes:
        yield "returns a work without strokes"
    for index, stroke in enumerate(work.strokes):
        yield from (f"stroke {index} {fault}" for fault in _stroke_faults(stroke))


def _stroke_faults(stroke: Stroke) -> Iterator[str]:
    if not stroke.points:
        yield "has no point"
    if not all(isfinite(value) for point in stroke.points for value in point):
        yield "has a point that is not finite"
        return
    length = sum(dist(a, b) for a, b in pairwise(stroke.points))
    places = [action.at for action in stroke.commands]
    if not all(-BEYOND <= at <= length + BEYOND for at in places):
        yield f"has an action beyond its {length:g} m"
    if any(a > b for a, b in pairwise(places)):
        yield "has actions that are not in order"
    if not all(0.0 < cut < length for cut in stroke.cuts) or any(a >= b for a, b in pairwise(stroke.cuts)):
        yield f"has cuts that are not in order, or not within its {length:g} m"
    if not (isfinite(stroke.hold) and stroke.hold >= 0.0):
        yield f"holds for {stroke.hold} s"
    if stroke.repetition is not None and not (stroke.repetition.every > 0.0 and length > 0.0):
        yield f"repeats an action each {stroke.repetition.every:g} m along {length:g} m"
    if stroke.speed is not None and not stroke.speed > 0.0:
        yield f"has a speed of {stroke.speed} m/s"
