"""The rule for measurements at points, along a line or on a grid."""

from __future__ import annotations

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.coverage import Sweep, work_over
from mmrs_core.planning.devices import device_for
from mmrs_core.planning.open_lines import work_along
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import ActionAt, Part, Position, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import number, pairs, positions, ring, text
from mmrs_survey.lines import at_altitude, cuts_between, even_distances, length_of, without_dense
from mmrs_survey.names import MEASURE_TASK

RULE = "measure"


def measure_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return the points given, the points along their line, or the points of a grid in the shell."""
    part = task.part
    spacing, up = number(part, "spacing"), _height(part, scene)
    if ring(part, "shell"):
        return _grid(part, robot, scene, spacing, up)
    points = at_altitude(positions(part, "points"), up)
    if not points:
        raise InfeasibleError("has neither points nor a shell to measure at")
    refuse_heights(robot, points)
    action = _action(part, robot)
    if spacing is None or len(points) == 1:
        return _at_points(points, action, robot, scene)
    lines = [("the line", tuple(without_dense(points)))]
    return work_along(scene, robot, lines, lambda _, line: _along(line, spacing, action), rule=RULE)


def _height(part: Part, scene: Scene) -> float | None:
    altitude, depth = number(part, "altitude"), number(part, "depth")
    if altitude is not None and depth is not None:
        raise InfeasibleError("both an altitude and a depth are given")
    return altitude if depth is None else scene.frame.surface - depth


def _action(part: Part, robot: Robot) -> ActionAt:
    name = text(part, "actionName")
    device = device_for(robot.type, name, text(part, "deviceId"))
    return ActionAt(0.0, name, device.id, pairs(part, "parameters"))


def _at_points(points: tuple[Position, ...], action: ActionAt, robot: Robot, scene: Scene) -> Work:
    for position, point in enumerate(points, 1):
        refuse_blocked(robot, scene, (point,), f"point {position}")
    return Work(
        tuple(Stroke((point,), (action,)) for point in points), divisible=True, rule=RULE, ordered=False
    )


def _along(points: tuple[Position, ...], spacing: float, action: ActionAt) -> Stroke:
    at = even_distances(length_of(points), spacing)
    actions = tuple(ActionAt(where, action.action, action.device, action.parameters) for where in at)
    return Stroke(points, actions, cuts=cuts_between(points, at), reversible=True)


def _grid(part: Part, robot: Robot, scene: Scene, spacing: float | None, up: float | None) -> Work:
    if spacing is None or not spacing > 0.0:
        raise InfeasibleError("a spacing of the grid is missing")
    height = up if up is not None else _common_height(positions(part, "shell"))
    refuse_heights(robot, ((0.0, 0.0, height),))
    action = _action(part, robot)
    return work_over(
        scene,
        robot,
        ring(part, "shell"),
        Sweep(
            altitude=height,
            width=spacing,
            length=spacing,
            rule=RULE,
            action=action.action,
            device=action.device,
            parameters=action.parameters,
        ),
    )


def _common_height(shell: tuple[Position, ...]) -> float:
    heights = {round(up, 3) for _, _, up in shell}
    if len(heights) != 1:
        raise InfeasibleError("an altitude or a depth is missing: the shell's points differ in height")
    return shell[0][2]


MEASURE_RULE = Rule(RULE, MEASURE_TASK, measure_work)
