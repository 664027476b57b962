"""What a robot is to do when something has gone wrong, as policies say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from mmrs_runtime import policies
from mmrs_runtime.faults import OBJECT_NOT_FOUND, POSITION_LOST, TAKEN_OVER
from mmrs_runtime.policies import ESCAPE, HOLD, LAND, NOTHING, RETURN, SURFACE, UNDECLARED

from ..program import Policy, Robot

BLOCKED = (
    "cannot fly straight to an emergency area from everywhere on its way: where nobody hears it, its vehicle"
    " goes back the way it came instead"
)

NO_ESCAPE = "has no clear way to an emergency area: where it is to go there, it goes home the way it came"

NEEDS_POSITION = frozenset({RETURN, ESCAPE, HOLD})
"""Responses that nobody can carry out who does not know where it is."""

DOWN: Mapping[str, str] = {"copter": LAND, "sub": SURFACE, "rover": HOLD}
"""What is left, by kind of vehicle, where nothing else can be carried out: a rover halts."""


def policy_for(event: str, robot: Robot, first: Sequence[Policy] = ()) -> Policy:
    """Return what a robot does about an event: by the wait's policies, its own, or the defaults."""
    if event == TAKEN_OVER:
        return Policy(event, NOTHING)
    if declared := policies.policy_for(event, (*first, *robot.policies)):
        return declared
    if event == OBJECT_NOT_FOUND and robot.vehicle == "sub":
        return Policy(event, SURFACE)
    return Policy(event, UNDECLARED.get(event, HOLD))


def lacks_escape(robot: Robot) -> bool:
    """Return whether a robot is to go to an emergency area some time, and there is no way to any."""
    waits = [policy for step in robot.steps if step.then is not None for policy in step.then.policies]
    flees = any(policy.response == ESCAPE for policy in (*robot.policies, *waits))
    return flees and not robot.escapes


def alone(policy: Policy, robot: Robot) -> Policy:
    """Return what the vehicle is told to do by itself about a lost link.

    It flies to the nearest rally point in a straight line and knows nothing of forbidden areas: where
    such a line may be blocked, it goes back the way it came instead.
    """
    blocked = policy.response == ESCAPE and not robot.straight
    return replace(policy, response=RETURN) if blocked else policy


def response_to(event: str, robot: Robot, first: Sequence[Policy] = ()) -> str:
    """Return how a robot responds to an event, or what comes nearest to it that can be done then.

    Without a position there is no way back and, for what flies, no staying either: it comes down.
    """
    response = policy_for(event, robot, first).response
    if event == POSITION_LOST and robot.vehicle == "copter" and response in NEEDS_POSITION:
        return LAND
    return response
