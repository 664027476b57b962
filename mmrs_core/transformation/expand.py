"""From tasks to work: what each task is made of, for each robot that could do it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil, dist, inf, isfinite

import numpy as np
from numpy.typing import NDArray

from mmrs_core.contributions.rules import ElementKind, RobotKind, Rule, barriers, most_specific, robot_kind_of
from mmrs_core.errors import InfeasibleError, MmrsError, PluginError
from mmrs_core.planning.positions import SLACK
from mmrs_core.planning.radio_remedies import for_radio
from mmrs_core.planning.reach import Reach, in_range_of, reach_of, unsure
from mmrs_core.planning.strokes import commanded_speed
from mmrs_core.planning.travel import kinematics_of
from mmrs_core.scene import (
    Device,
    Kinematics,
    Name,
    Part,
    Position,
    Robot,
    Scene,
    SharedWorks,
    Stroke,
    Task,
    Value,
    Work,
)
from mmrs_core.scene.relays import Relay, relay_range, relays_of, station_of
from mmrs_runtime.policies import in_precedence

_MOST_REMEDIES = 20
"""Tasks that can be done by no robot for which remedies are tried: the first ones."""

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
    works, sorts, found = _found(scene, rules)
    hurried = {robot.name: robot for robot in _hurried(sorts, found)}
    if hurried:
        robots = tuple(hurried.get(robot.name, robot) for robot in robots)
        scene = replace(scene, robots=robots)
        works, sorts, found = _found(scene, rules)
    stations = dict.fromkeys(_stations(found, sorts, scene.position_error))
    radio = _Radio((*relays_of(scene.elements), *stations), scene.position_error)
    refusals = _Refusals(works, robots, radio)
    for name, each in found.items():
        _share(name, each, sorts, refusals)
    reasons = list(_undoable(scene, works, refusals, radio))
    if reasons:
        raise InfeasibleError(f"{len(reasons)} of the tasks can be done by no robot", reasons)
    timed = scene.minimum_separation is not None and len(robots) > 1
    return replace(scene, works=works, refusals=refusals, timed=timed)


def _found(
    scene: Scene, rules: Mapping[Name, Rule]
) -> tuple[SharedWorks, list[_Sort], dict[str, list[Work | str]]]:
    """Return the sorts of robots, and by task the work for each of them, or why they cannot do it."""
    numbers = dict[tuple[str, float, Kinematics | None], int]()
    works = SharedWorks(
        {
            robot.name: numbers.setdefault((robot.type.name, robot.clearance, robot.kinematics), len(numbers))
            for robot in scene.robots
        }
    )
    sorts = [_Sort(scene.robots, sort, works.sorts) for sort in range(len(numbers))]
    tasks = [task for task in scene.tasks if not task.part.is_a(CONTROL_TASK)]
    return works, sorts, {task.name: _works_of(task, scene, rules, sorts) for task in tasks}


def _hurried(sorts: Sequence[_Sort], found: Mapping[str, Sequence[Work | str]]) -> Iterator[Robot]:
    """Yield the robots that works command to be quicker than they cruise, with the room for that."""
    for number, sort in enumerate(sorts):
        works = (each[number] for each in found.values())
        strokes = (stroke for work in works if isinstance(work, Work) for stroke in work.strokes)
        kinematics = kinematics_of(sort.first)
        more = kinematics.room(*(commanded_speed(each, kinematics) for each in strokes)) - kinematics.room()
        if more > 0.0:
            yield from (replace(robot, clearance=robot.clearance + more) for robot in sort.robots)


class _Radio:
    """Where the radios of robots reach; found once for those of one home.

    Attributes:
        relays: of the context, and all that robots may be.
        error: of positions, metres.
    """

    def __init__(self, relays: Sequence[Relay] = (), error: float = 0.0) -> None:
        self.relays, self.error = relays, error
        self._known: dict[tuple[Position, float], Reach | None] = {}

    def of(self, robot: Robot) -> Reach | None:
        key = robot.home, range_of(robot)
        if key not in self._known:
            self._known[key] = reach_of(robot, self.relays, self.error)
        return self._known[key]


class _Sort:
    """Robots that do alike what each of them can do, so that one work serves all whose radio reaches it."""

    def __init__(self, robots: Sequence[Robot], sort: int, sorts: Mapping[str, int]) -> None:
        self.places = [i for i, robot in enumerate(robots) if sorts[robot.name] == sort]
        self.robots = [robots[i] for i in self.places]
        self.first = self.robots[0]
        self._range = range_of(self.first)
        self._homes = np.array([robot.home for robot in self.robots])

    def reached(self, work: Work, radio: _Radio) -> NDArray[np.bool_] | bool:
        """Return, by robot, whether its radio reaches all of a work from its home, or over relays."""
        if self._range == inf:
            return True
        reached = _most_distant(work, self._homes) + radio.error <= self._range + SLACK
        if radio.relays:
            for i in np.flatnonzero(~reached).tolist():
                reach = radio.of(self.robots[i])
                reached[i] = reach is None or in_range_of(reach, work.strokes)
        return np.asarray(reached)


class _Refusals(Mapping[tuple[str, str], str]):
    """Why robots cannot do tasks; pairs take no room, for words are made when they are asked for."""

    def __init__(self, works: SharedWorks, robots: Sequence[Robot], radio: _Radio) -> None:
        self.works, self._robots, self.radio = works, {robot.name: robot for robot in robots}, radio
        self.of_sorts: dict[str, Sequence[Work | str]] = {}

    def __getitem__(self, pair: tuple[str, str]) -> str:
        """Return why a robot cannot do a task."""
        task, robot = pair
        if pair in self.works:
            raise KeyError(pair)
        found = self.of_sorts[task][self.works.sorts[robot]]
        if isinstance(found, str):
            return found
        return out_of_reach(found, self._robots[robot], self.radio.relays, self.radio.error) or ""

    def __iter__(self) -> Iterator[tuple[str, str]]:
        """Yield the pairs that have no work."""
        pairs = ((task, robot) for task in self.of_sorts for robot in self._robots)
        return (pair for pair in pairs if pair not in self.works)

    def __len__(self) -> int:
        """Return how many pairs have no work."""
        return len(self.of_sorts) * len(self._robots) - len(self.works)


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
    clearance = robot.clearance + kinematics.room()
    policies = in_precedence(kind=kind.policies)
    return replace(robot, kind=kind.name, kinematics=kinematics, clearance=clearance, policies=policies)


def _works_of(
    task: Task, scene: Scene, rules: Mapping[Name, Rule], sorts: Sequence[_Sort]
) -> list[Work | str]:
    """Return the work of a task for each sort of robots, or why they cannot do it."""
    name = most_specific(task.part.metaclasses, rules)
    if name is None:
        what = task.part.metaclasses[0][1] if task.part.metaclasses else "unknown type"
        raise InfeasibleError(f"task '{task.name}': no installed plug-in has a rule for a {what}")
    return [_work(task, sort.first, scene, rules[name]) for sort in sorts]


def _stations(
    found: Mapping[str, Sequence[Work | str]], sorts: Sequence[_Sort], error: float
) -> Iterator[Relay]:
    """Yield all relays that robots may be."""
    for task, works in found.items():
        for sort, work in zip(sorts, works, strict=True):
            station = None if isinstance(work, str) else station_of(task, work, sort.first.type, error)
            if station is not None:
                yield station


def _share(task: str, found: Sequence[Work | str], sorts: Sequence[_Sort], refusals: _Refusals) -> None:
    """Note which robots can do a task: those that have work for it, all of which their radio reaches."""
    able = np.zeros(len(refusals.works.sorts), np.bool_)
    for sort, work in zip(sorts, found, strict=True):
        able[sort.places] = not isinstance(work, str) and sort.reached(work, refusals.radio)
    refusals.of_sorts[task] = found
    refusals.works.add(task, [None if isinstance(each, str) else each for each in found], able.tobytes())


def _work(task: Task, robot: Robot, scene: Scene, rule: Rule) -> Work | str:
    missing = next(_missing(task, robot.type.devices), None) or unfit(robot, scene)
    if missing:
        return missing
    try:
        work = work_of(rule, task, robot, scene)
    except InfeasibleError as error:
        return "; ".join(error.reasons)
    if work.relays and relay_range(robot.type) is None:
        return "carries no relay: its type has no relayRange"
    return work


def _missing(task: Task, devices: Mapping[str, Device]) -> Iterator[str]:
    supported = {action for device in devices.values() for action in device.actions}
    yield from (f"has no device '{device}'" for device in task.devices if device not in devices)
    yield from (f"has no device for action '{action}'" for action in task.actions if action not in supported)


def _undoable(scene: Scene, works: SharedWorks, refusals: _Refusals, radio: _Radio) -> Iterator[str]:
    tasks = (each for each in scene.tasks if not each.part.is_a(CONTROL_TASK) and not works.able(each.name))
    for number, task in enumerate(tasks):
        why = "; ".join(f"{robot.name}: {refusals[task.name, robot.name]}" for robot in scene.robots)
        remedy = _remedy(task, scene, refusals, radio) if number < _MOST_REMEDIES else ""
        yield f"task '{task.name}' can be done by no robot ({why}){remedy}"


def _remedy(task: Task, scene: Scene, refusals: _Refusals, radio: _Radio) -> str:
    """Return what would do for the nearest of the robots whose radio is all that is short."""
    works = dict[str, Work]()
    for robot in scene.robots:
        work = refusals.of_sorts[task.name][refusals.works.sorts[robot.name]]
        if isinstance(work, Work):
            works[robot.name] = work
    if not works:
        return ""

    def missing(robot: Robot) -> float:
        away = _most_distant(works[robot.name], np.array([robot.home]))
        return float(away[0]) - range_of(robot)

    nearest = min((each for each in scene.robots if each.name in works), key=missing)
    return for_radio(scene, task, works, nearest, radio.relays)


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


def out_of_reach(work: Work, robot: Robot, relays: Sequence[Relay] = (), error: float = 0.0) -> str | None:
    """Return why the radio does not reach all of a work from the robot's home; None if it does.

    Args:
        work: of a task.
        robot: with its home.
        relays: of the context.
        error: of positions, metres.
    """
    reach = reach_of(robot, relays, error)
    if reach is None:
        return None
    most = float(_most_distant(work, np.array([robot.home]))[0]) + error
    if most <= reach.ranges[0] + SLACK:
        return None
    if not relays:
        return f"would be {ceil(most)} m from home, its radio reaches {reach.ranges[0]:g} m"
    strokes = [each for each in work.strokes if not in_range_of(reach, [each])]
    return f"would be {reach.beyond(strokes[0].points, unsure(strokes[0]))}" if strokes else None


def _most_distant(work: Work, homes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return, by home, the metres to the point of a work that is most distant from it."""
    points = np.array([(*point, unsure(stroke)) for stroke in work.strokes for point in stroke.points])
    found = np.zeros(len(homes))
    if len(points) < len(homes):
        for each in points:
            np.maximum(found, np.linalg.norm(homes - each[:3], axis=1) + each[3], out=found)
    else:
        found[:] = [(np.linalg.norm(points[:, :3] - each, axis=1) + points[:, 3]).max() for each in homes]
    return found


def range_of(robot: Robot) -> float:
    """Return how far the radio of a robot reaches, metres; inf where that is unknown."""
    return _number(robot.type.part.attributes.get("communicationRange"), inf)


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
    if work.relays and work.divisible:
        yield "returns a work of a relay that several robots may share"
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
