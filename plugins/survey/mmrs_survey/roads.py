"""The rule for tasks along a road, river or line."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import device_for
from mmrs_core.planning.open_lines import open_lines
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import ActionAt, Part, Position, Repetition, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import flag, number, position, positions, text
from mmrs_survey.lines import (
    at_altitude,
    cuts_between,
    even_distances,
    length_of,
    lines_over,
    without_repeats,
)
from mmrs_survey.names import ROAD_TASK
from mmrs_survey.passing import trigger_of


def road_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return one stroke along the line, or several beside each other over its width."""
    lines = _lines(task.part)
    entry = at_altitude((position(task.part, "initialPosition"),), number(task.part, "altitude"))[0]
    refuse_heights(robot, (entry, *(point for line in lines for point in line)))
    refuse_blocked(robot, scene, (entry,), "the initial position")
    free, turned = len(lines) > 1, flag(task.part, "inverted")
    called = [f"pass {number}" for number in range(1, len(lines) + 1)] if free else ["the line"]
    drawn = lines if free or not turned else [line[::-1] for line in lines]
    found = open_lines(robot, scene, zip(called, drawn, strict=True))
    ways = list(zip(found.parts, found.stretches, strict=True))
    if turned and not free:
        ways = [(line[::-1], (index, stretch[::-1])) for line, (index, stretch) in ways[::-1]]
    strokes = [
        replace(_stroke(task.part, robot, line, free=free), part=called[index], stretch=stretch)
        for line, (index, stretch) in ways
    ]
    return Work(tuple(strokes), divisible=True, rule="road", ordered=not free, entry=entry, gaps=found.gaps)


def _lines(part: Part) -> tuple[tuple[Position, ...], ...]:
    line = without_repeats(at_altitude(positions(part, "points"), number(part, "altitude")))
    if not line:
        raise InfeasibleError("points are missing")
    line = line[::-1] if flag(part, "inverted") else line
    return lines_over(line, number(part, "width"), number(part, "footprintWidth"))


def _stroke(part: Part, robot: Robot, line: tuple[Position, ...], *, free: bool) -> Stroke:
    every = number(part, "photoDistance")
    if every is None:
        return Stroke(line, cuts=cuts_between(line, ()), reversible=free)
    action = text(part, "actionName")
    device = device_for(robot.type, action, text(part, "deviceId"))
    at = even_distances(length_of(line), every)
    stroke = Stroke(line, cuts=cuts_between(line, at), reversible=free)
    trigger = trigger_of(part, robot, device, every, min(up for _, _, up in line)) if len(at) > 1 else None
    if trigger is None:
        return replace(stroke, actions=tuple(ActionAt(where, action, device.id) for where in at))
    repetition = Repetition(every, trigger.action, device.id)
    return replace(stroke, repetition=repetition, speed=trigger.speed, slow_down=1.0)


ROAD_RULE = Rule("road", ROAD_TASK, road_work)
