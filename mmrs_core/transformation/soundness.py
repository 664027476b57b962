"""Whether what a rule returned can be worked with: a plug-in's slip must not become a lost action."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import dist, isfinite

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import MmrsError, PluginError
from mmrs_core.scene import Robot, Scene, Stroke, Task, Work

BEYOND = 1e-6
"""Metres by which an action may lie beyond a stroke's end, by rounding."""


def work_of(rule: Rule, task: Task, robot: Robot, scene: Scene) -> Work:
    """Return what a rule makes of a task.

    Raises:
        InfeasibleError: if the rule says that the robot cannot do the task.
        PluginError: if the rule fails, or returns something that is no sound work; names the rule.
    """
    where = f"rule '{rule.name}', task '{task.name}', robot '{robot.name}'"
    try:
        work = rule.work(task, robot, scene)
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
    places = [action.at for action in stroke.actions]
    if not all(-BEYOND <= at <= length + BEYOND for at in places):
        yield f"has an action beyond its {length:g} m"
    if any(a > b for a, b in pairwise(places)):
        yield "has actions that are not in order"
    if not all(0.0 < cut < length for cut in stroke.cuts) or any(a >= b for a, b in pairwise(stroke.cuts)):
        yield f"has cuts that are not in order, or not within its {length:g} m"
    if not (isfinite(stroke.hold) and stroke.hold >= 0.0):
        yield f"holds for {stroke.hold} s"
    if stroke.speed is not None and not stroke.speed > 0.0:
        yield f"has a speed of {stroke.speed} m/s"
