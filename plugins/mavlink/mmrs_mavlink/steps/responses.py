"""What a robot is to do when something has gone wrong, as policies say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from mmrs_runtime import policies
from mmrs_runtime.faults import POSITION_LOST, TAKEN_OVER
from mmrs_runtime.policies import ESCAPE, HOLD, NOTHING, RETURN, UNDECLARED

from ..program import Policy, Robot

BLOCKED = (
    "cannot fly straight to an emergency area from everywhere on its path: when its link is lost, its vehicle"
    " retraces its path instead"
)

NO_ESCAPE = "has no clear path to an emergency area: instead of going there, it retraces its path home"

NEEDS_POSITION = frozenset({RETURN, ESCAPE, HOLD})
"""Responses that need a known position."""


def policy_for(event: str, robot: Robot, first: Sequence[Policy] = ()) -> Policy:
    """Return what a robot does about an event: by the wait's policies, its own, or the defaults."""
    if event == TAKEN_OVER:
        return Policy(event, NOTHING)
    if declared := policies.policy_for(event, (*first, *robot.policies)):
        return declared
    return Policy(event, robot.profile.usual_responses.get(event) or UNDECLARED.get(event, HOLD))


def lacks_escape(robot: Robot) -> bool:
    """Return whether a robot is to go to an emergency area some time, and has no path to any."""
    waits = [policy for step in robot.steps if step.then is not None for policy in step.then.policies]
    flees = any(policy.response == ESCAPE for policy in (*robot.policies, *waits))
    return flees and not robot.escapes


def alone(policy: Policy, robot: Robot) -> Policy:
    """Return the vehicle's failsafe for a lost link.

    It flies to the nearest rally point in a straight line and knows nothing of forbidden areas: where
    such a line may be blocked, it retraces its path instead.
    """
    blocked = policy.response == ESCAPE and not robot.straight
    return replace(policy, response=RETURN) if blocked else policy


def instead_of(response: str, event: str, robot: Robot) -> str:
    """Return what a robot does about an event instead of a response that is impossible then; or nothing.

    Without a position it can neither return nor, if it flies, hold position: it lands.
    """
    impossible = event == POSITION_LOST and response in NEEDS_POSITION
    return robot.profile.without_position if impossible else ""
