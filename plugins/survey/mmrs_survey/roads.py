"""The rule for tasks along a road, river or line."""

from __future__ import annotations

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import device_for
from mmrs_core.planning.places import refuse_blocked, refuse_heights
from mmrs_core.scene import ActionAt, Part, Position, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import flag, number, position, positions, text
from mmrs_survey.lines import at_altitude, cuts_between, even_distances, length_of, passes, without_repeats
from mmrs_survey.names import ROAD_TASK


def road_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return one stroke along the line, or several beside each other over its width."""
    lines = _lines(task.part)
    entry = at_altitude((position(task.part, "initialPosition"),), number(task.part, "altitude"))[0]
    refuse_heights(robot, (entry, *(point for line in lines for point in line)))
    refuse_blocked(robot, scene, (entry,), "the initial position")
    for line in lines:
        refuse_blocked(robot, scene, line, "the line")
    strokes = tuple(_stroke(task.part, robot, line, free=len(lines) > 1) for line in lines)
    return Work(strokes, divisible=True, rule="road", ordered=len(lines) == 1, entry=entry)


def _lines(part: Part) -> tuple[tuple[Position, ...], ...]:
    line = without_repeats(at_altitude(positions(part, "points"), number(part, "altitude")))
    if not line:
        raise InfeasibleError("points are missing")
    if flag(part, "inverted"):
        line = line[::-1]
    width, strip = number(part, "width") or 0.0, number(part, "footprintWidth")
    if len(line) == 1 or strip is None or width <= strip:
        return (line,)
    return passes(line, width, strip)


def _stroke(part: Part, robot: Robot, line: tuple[Position, ...], *, free: bool) -> Stroke:
    every = number(part, "photoDistance")
    if every is None:
        return Stroke(line, cuts=cuts_between(line, ()), reversible=free)
    action = text(part, "actionName")
    device = device_for(robot.type, action, text(part, "deviceId")).id
    at = even_distances(length_of(line), every)
    actions = tuple(ActionAt(where, action, device) for where in at)
    return Stroke(line, actions, cuts=cuts_between(line, at), reversible=free)


ROAD_RULE = Rule("road", ROAD_TASK, road_work)
