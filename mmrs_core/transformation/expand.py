"""From tasks to work: what each task is made of, for each robot that could do it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from mmrs_core.contributions.rules import RobotKind, Rule, barriers, most_specific, robot_kind_of
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Device, Kinematics, Name, Robot, Scene, Task, Work
from mmrs_core.transformation.fitness import out_of_reach, unfit
from mmrs_core.transformation.soundness import work_of

CONTROL_TASK = ("urn:mmrs:mission:1.0", "ControlTask")


def expand(scene: Scene, rules: Mapping[Name, Rule], robot_kinds: Mapping[Name, RobotKind]) -> Scene:
    """Return the scene with every robot's kinematics and barriers, and the work of every task for each.

    Raises:
        InfeasibleError: if a task can be done by no robot, or a robot is of no known kind; lists all
            of them, each with the reason for each robot.
    """
    robots = tuple(_with_kinematics(robot, scene, robot_kinds) for robot in scene.robots)
    types = {robot.type.name: robot.type for robot in robots}
    barred = barriers(scene.elements, types.values(), robot_kinds)
    scene = replace(scene, robots=robots, areas=(*scene.areas, *barred))
    works: dict[tuple[str, str], Work] = {}
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
    clearance = robot.clearance + kinematics.turning_radius
    return replace(robot, kind=kind.name, kinematics=kinematics, clearance=clearance)


def _expand_task(
    task: Task,
    scene: Scene,
    rules: Mapping[Name, Rule],
    works: dict[tuple[str, str], Work],
    refusals: dict[tuple[str, str], str],
) -> None:
    name = most_specific(task.part.metaclasses, rules)
    if name is None:
        what = task.part.metaclasses[0][1] if task.part.metaclasses else "unknown type"
        raise InfeasibleError(f"task '{task.name}': no installed plug-in has a rule for a {what}")
    alike: dict[tuple[str, float, Kinematics | None], Work | str] = {}
    for robot in scene.robots:
        key = (robot.type.name, robot.clearance, robot.kinematics)
        if key not in alike:
            alike[key] = _work(task, robot, scene, rules[name])
        found = alike[key]
        if isinstance(found, Work):
            found = out_of_reach(found, robot) or found
        if isinstance(found, str):
            refusals[task.name, robot.name] = found
        else:
            works[task.name, robot.name] = found


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
