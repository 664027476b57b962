"""Which response a robot gives to a fault."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import inf

from mmrs_core.scene import Policy, PolicyEvent, PolicyResponse

AFTER: Mapping[str, float] = {
    "PEER_LOST": 30.0,
    "LINK_LOST": 10.0,
    "DEVICE_SILENT": 30.0,
    "WAIT_TOO_LONG": inf,
    "GROUND_LOST": 10.0,
}
"""Seconds that a fault lasts before the robot responds, where its policy does not say.

A wait is part of the plan, however long: it is too long only where somebody said how long that is.
"""

LAST_RESORT = "HOLD"
"""What a robot does about a fault that nobody declared a response to."""

BORNE: Mapping[str, PolicyResponse] = {"GROUND_LOST": "CONTINUE"}
"""What goes before that: nobody needs to look on for a robot to finish."""


def in_precedence(
    transition: Iterable[Policy] = (),
    mission: Iterable[Policy] = (),
    robot_type: Iterable[Policy] = (),
    kind: Mapping[PolicyEvent, PolicyResponse] | None = None,
) -> tuple[Policy, ...]:
    """Return policies such that the first for an event is the one that counts.

    Those of a single wait go before the mission's, the robot type's, and its kind's defaults.
    """
    defaults = (Policy(event, response) for event, response in (kind or {}).items())
    return (*transition, *mission, *robot_type, *defaults)


def policy_for(event: str, policies: Iterable[Policy]) -> Policy | None:
    """Return the policy that counts for an event; None where nobody declared one."""
    return next((policy for policy in policies if policy.event == event), None)


def response_to(event: str, policies: Iterable[Policy]) -> str:
    """Return the response to an event, a literal of PolicyResponse."""
    policy = policy_for(event, policies)
    return policy.response if policy else BORNE.get(event, LAST_RESORT)


def patience(event: str, policies: Iterable[Policy]) -> float | None:
    """Return for how many seconds the robot bears an event; None: for ever, no policy names it."""
    policy = policy_for(event, policies)
    if policy is None:
        return None
    return AFTER.get(event, 0.0) if policy.after is None else policy.after
