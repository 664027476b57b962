"""Rules for tasks about an object: look at it from all around, go up to it and face it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import ceil, cos, dist, pi, radians, sin

from mmrs_auv.names import ALIGN_TASK, INSPECT_OBJECT_TASK
from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.contributions.rules import MoveSpec, Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import carried, device_for
from mmrs_core.planning.positions import (
    bearing_of_homes,
    refuse_blocked,
    refuse_heights,
    refuse_unsteady,
    stand_off,
)
from mmrs_core.scene import ActionAt, Look, Part, Position, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import number, position, text

MOST_VIEWS = 360
STEP = pi / 12.0
"""Radians at most between points of the way around an object, so that it keeps its distance."""


def inspect_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return a way around the object that faces it, with a hold and an action at each place."""
    refuse_unsteady(robot)
    part, middle = task.part, position(task.part, "point")
    refuse_heights(robot, (middle,))
    distance, views = _distance(part), round(number(part, "views") or 0)
    if not 1 <= views <= MOST_VIEWS:
        raise InfeasibleError(f"{views} views are asked for, of 1 to {MOST_VIEWS}")
    device = carried(robot.type, text(part, "deviceId"))
    look, hold = Look(middle, device), number(part, "duration") or 0.0
    strokes = []
    for way in _ways(middle, distance, views, bearing_of_homes(scene, middle)):
        refuse_blocked(robot, scene, way, "the way around the object")
        done = _doing(part, robot, _length(way))
        strokes.append(Stroke(way, done, look, hold=hold))
    return Work(tuple(strokes), divisible=False, rule="inspect_object", ordered=True)


def _ways(middle: Position, distance: float, views: int, first: float) -> Iterator[tuple[Position, ...]]:
    """Yield the path to each position, from the one before; the first is a position alone."""
    step = 2.0 * pi / views
    pieces = max(1, ceil(step / STEP))
    yield (_around(middle, distance, first),)
    for index in range(1, views):
        begin = first + (index - 1) * step
        yield tuple(_around(middle, distance, begin + step * part / pieces) for part in range(pieces + 1))


def _around(middle: Position, distance: float, bearing: float) -> Position:
    return (middle[0] + distance * sin(bearing), middle[1] + distance * cos(bearing), middle[2])


def align_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return the path to an object from outside of where it may be, the hold there, and the path back.

    The second stroke ends the task where the robot's position is certain again, wherever the object
    was found.
    """
    refuse_unsteady(robot)
    part, expected = task.part, position(task.part, "point")
    refuse_heights(robot, (expected,))
    distance, tolerance = _distance(part), number(part, "tolerance")
    run_up = (tolerance or 0.0) + robot.clearance
    begin, end = _leg(part, robot, scene, expected, distance, run_up)
    there = Stroke(
        (begin, end),
        _doing(part, robot, run_up),
        Look(expected, carried(robot.type, text(part, "deviceId"))),
        hold=number(part, "duration") or 0.0,
        object=text(part, "object"),
        object_distance=distance,
        object_tolerance=tolerance,
    )
    return Work((there, Stroke((begin,))), divisible=False, rule="align")


def _leg(
    part: Part, robot: Robot, scene: Scene, point: Position, distance: float, run_up: float
) -> tuple[Position, Position]:
    bearing = number(part, "bearing")
    if bearing is None:
        return stand_off(robot, scene, point, distance, distance + run_up)
    behind = radians(bearing) + pi
    leg = (_around(point, distance + run_up, behind), _around(point, distance, behind))
    refuse_blocked(robot, scene, leg, "the approach to the object")
    return leg


def align_moves(stroke: Stroke, task: Task, robot: Robot, scene: Scene) -> tuple[MoveSpec, ...]:
    """Return the moves to the object: go, face it, hold; a hold for the end of the path back."""
    if stroke.object is None or stroke.look is None:
        return (MoveSpec((BEHAVIOUR, "HoldPosition"), {"duration": 0.0}),)
    return (
        MoveSpec(
            (BEHAVIOUR, "GoTo"),
            target=stroke.look.at,
            object=stroke.object,
            object_tolerance=stroke.object_tolerance,
            distance=stroke.object_distance,
            look=stroke.look if stroke.look.device else None,
        ),
        MoveSpec(
            (BEHAVIOUR, "HeadTo"),
            object=stroke.object,
            object_tolerance=stroke.object_tolerance,
            look=stroke.look,
            facing=True,
        ),
        MoveSpec((BEHAVIOUR, "HoldPosition"), {"duration": stroke.hold}, after=stroke.actions),
    )


def _distance(part: Part) -> float:
    distance = number(part, "distance")
    if distance is None or not distance > 0.0:
        raise InfeasibleError("a distance from the object is missing")
    return distance


def _doing(part: Part, robot: Robot, at: float) -> tuple[ActionAt, ...]:
    action = text(part, "actionName")
    if not action:
        return ()
    return (ActionAt(at, action, device_for(robot.type, action, text(part, "deviceId")).id),)


def _length(way: tuple[Position, ...]) -> float:
    return sum(dist(one, other) for one, other in pairwise(way))


OBJECT_RULES = (
    Rule("inspect_object", INSPECT_OBJECT_TASK, inspect_work),
    Rule("align", ALIGN_TASK, align_work, align_moves),
)
