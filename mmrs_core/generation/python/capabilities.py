"""How programs in Python express elements of behaviours, whatever they drive."""

from __future__ import annotations

from collections.abc import Mapping

OF_PROGRAMS: Mapping[str, str] = {
    "Behaviour.name": "in descriptions and messages",
    "Behaviour.minimumSeparation": "is for the planner and the checks",
    "Behaviour.acceptedUnknowns": "is for the checks",
    "Behaviour.idleRobots": "are for the checks; they are not run",
    "Behaviour.reserve": "a battery with no more left is low",
    "Behaviour.robots": "a controller each, and one for the fleet",
    "Robot.id": "name of the controller and of its logs",
    "Robot.slots": "kept by the controller, served to others",
    "Target.name": "is informative",
    "Start, Stop": "beginning and end of the program",
    "GoTo.distance": "the robot stops short of the position",
    "Recharge": "stays until the battery is full, and at least so long",
    "Move.name": "in logs and messages",
    "Move.task": "in logs and comments",
    "Move.rule": "in comments",
    "MoveTransition.fluid": "continues without a stop",
    "MoveTransition.to": "steps in any order",
    "MoveTransition.policies": "before those of the robot",
    "Choice.conditionIdentifier": "a function of yours in conditions.py",
    "Choice by a standard condition": "known to the runtime",
    "UnicastNotify": "acknowledged command to the slot's owner",
    "MulticastNotify": "acknowledged commands to the slots' owners",
    "BroadcastNotify": "acknowledged commands to the slots' owners",
    "Notify.active": "takes the slot back",
    "Move.preActions": "done before the movement",
    "Move.postActions": "done after the movement",
}
