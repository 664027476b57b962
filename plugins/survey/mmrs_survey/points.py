"""Rules for tasks at one point: go there, hold and look or be a relay, find an object and go up to it."""

from __future__ import annotations

from math import inf

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.contributions.rules import MoveSpec, Rule
from mmrs_core.planning.devices import carried, device_for
from mmrs_core.planning.positions import refuse_blocked, refuse_heights, refuse_unsteady, stand_off
from mmrs_core.scene import ActionAt, Look, Part, Position, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import number, position, text
from mmrs_survey.names import APPROACH_TASK, GO_TO_TASK, OBSERVE_TASK, RELAY_TASK

SLOW = 0.5
"""Share of the cruise speed at which a robot goes to a point slowly."""


def go_to_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return the point, and how fast it is gone to."""
    point = position(task.part, "point")
    refuse_heights(robot, (point,))
    refuse_blocked(robot, scene, (point,), "the point")
    how = text(task.part, "type")
    stroke = Stroke(
        (point,), slow_down=SLOW if how == "SLOW" else None, speed=inf if how == "QUICK" else None
    )
    return Work((stroke,), divisible=False, rule="go_to")


def observe_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return a place from which the point is seen, what begins there, and how long to hold."""
    refuse_unsteady(robot)
    point = position(task.part, "point")
    place = _place_to_look_from(task.part, point, robot, scene)
    device = carried(robot.type, text(task.part, "deviceId"))
    look = Look(point, device) if place != point else None
    hold = Stroke((place,), look=look, hold=number(task.part, "duration") or 0.0)
    action = text(task.part, "actionName")
    begins = (Stroke((place,), (_doing(robot, action, device),), look),) if action else ()
    return Work((*begins, hold), divisible=False, rule="observe")


def _place_to_look_from(part: Part, point: Position, robot: Robot, scene: Scene) -> Position:
    altitude, distance = number(part, "altitude"), number(part, "distance") or 0.0
    centre = point if altitude is None else (point[0], point[1], altitude)
    refuse_heights(robot, (centre,))
    if distance > 0.0:
        return stand_off(robot, scene, centre, distance, distance)[0]
    refuse_blocked(robot, scene, (centre,), "the observing position")
    return centre


def relay_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return the point, at which the robot stays as a relay."""
    refuse_unsteady(robot)
    point = position(task.part, "point")
    refuse_heights(robot, (point,))
    refuse_blocked(robot, scene, (point,), "the point")
    return Work((Stroke((point,)),), divisible=False, rule="relay", relays=True)


def approach_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return the approach to an object, from outside of where it may be, and the return.

    The first stroke leads from the stand-off position to `distance` before where the object is
    expected, at which `look` points; the second ends the task where the robot's position is
    certain again, wherever the object was found.
    """
    expected = position(task.part, "point")
    refuse_heights(robot, (expected,))
    distance, tolerance = number(task.part, "distance") or 0.0, number(task.part, "tolerance")
    run_up = (tolerance or 0.0) + robot.clearance
    begin, end = stand_off(robot, scene, expected, distance, distance + run_up)
    device = carried(robot.type, text(task.part, "deviceId"))
    action = text(task.part, "actionName")
    there = Stroke(
        (begin, end),
        (_doing(robot, action, device, run_up),) if action else (),
        Look(expected, device),
        object=text(task.part, "object"),
        object_distance=distance,
        object_tolerance=tolerance,
    )
    return Work((there, Stroke((begin,))), divisible=False, rule="approach")


def approach_moves(stroke: Stroke, task: Task, robot: Robot, scene: Scene) -> tuple[MoveSpec, ...]:
    """Return the move up to the object with the actions there; a hold ends the return."""
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
            after=stroke.actions,
        ),
    )


def _doing(robot: Robot, action: str, device_id: str, at: float = 0.0) -> ActionAt:
    return ActionAt(at, action, device_for(robot.type, action, device_id).id)


POINT_RULES = (
    Rule("go_to", GO_TO_TASK, go_to_work),
    Rule("observe", OBSERVE_TASK, observe_work),
    Rule("relay", RELAY_TASK, relay_work),
    Rule("approach", APPROACH_TASK, approach_work, approach_moves),
)
