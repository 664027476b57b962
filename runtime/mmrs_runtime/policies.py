"""Policies: events, responses, precedence, and how long an event is tolerated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf
from typing import Literal, TypeAlias, get_args

from .faults import (
    BATTERY_LOW,
    DEVICE_SILENT,
    GROUND_LOST,
    LINK_LOST,
    MOTOR_FAILED,
    PEER_LOST,
    POSITION_LOST,
    VEHICLE_RESTARTED,
    WAIT_TOO_LONG,
)

PolicyEvent: TypeAlias = Literal[
    "LINK_LOST",
    "PEER_LOST",
    "BATTERY_LOW",
    "WAIT_TOO_LONG",
    "DEVICE_SILENT",
    "POSITION_LOST",
    "OBSTACLE",
    "FENCE_BREACHED",
    "VEHICLE_RESTARTED",
    "LOG_FAILED",
    "GROUND_LOST",
    "MOTOR_FAILED",
]
PolicyResponse: TypeAlias = Literal[
    "HOLD", "RETURN", "EMERGENCY_AREA", "LAND", "SURFACE", "STOP_THRUST", "CONTINUE"
]
EVENTS: tuple[PolicyEvent, ...] = get_args(PolicyEvent)
RESPONSES: tuple[PolicyResponse, ...] = get_args(PolicyResponse)

HOLD = "HOLD"
RETURN = "RETURN"
ESCAPE = "EMERGENCY_AREA"
LAND = "LAND"
SURFACE = "SURFACE"
CONTINUE = "CONTINUE"
NOTHING = "NOTHING"
"""Response to a pilot: no policy answers that, the program lets go of the vehicle."""


@dataclass(frozen=True, slots=True)
class Policy:
    """What a robot does about an event.

    Attributes:
        event: a literal of PolicyEvent, such as ``LINK_LOST``.
        response: a literal of PolicyResponse, such as ``RETURN``, or NOTHING.
        after: seconds that the event lasts before the robot responds; None: the platform's default.
    """

    event: str
    response: str
    after: float | None = None


AFTER: Mapping[str, float] = {
    PEER_LOST: 30.0,
    LINK_LOST: 10.0,
    DEVICE_SILENT: 30.0,
    WAIT_TOO_LONG: inf,
    GROUND_LOST: 10.0,
}
"""Seconds that an event lasts before the robot responds, where its policy in a model does not define it;
otherwise 0.

A wait is part of the plan, however long: it is too long only where a model limits it.
"""

UNDECLARED_AFTER: Mapping[str, float] = {**AFTER, LINK_LOST: 5.0, DEVICE_SILENT: 5.0, POSITION_LOST: 2.0}
"""Seconds that real robots tolerate an event whose policy has none when it reaches them; otherwise 0.

Programs are written with the seconds of `AFTER`: so these are of events that no model names, and of a lost
position, which estimators report for moments.
"""

VALUE_SECONDS = 10.0
"""The same of a sensor that publishes no value: some do every few seconds only."""

LAST_RESORT = HOLD
"""A robot's response to an event without a declared one."""

BORNE: Mapping[str, str] = {GROUND_LOST: CONTINUE}
"""Responses that take precedence over it: a robot can finish without a ground station."""

UNDECLARED: Mapping[str, str] = {**BORNE, LINK_LOST: RETURN, BATTERY_LOW: RETURN, MOTOR_FAILED: LAND}
"""What real robots do where no policy says anything; to anything else they hold."""

COMES_DOWN = frozenset({RETURN, ESCAPE, LAND, SURFACE})
"""Responses after which a battery can be changed."""

OVERTAKES = frozenset({POSITION_LOST, VEHICLE_RESTARTED, MOTOR_FAILED, BATTERY_LOW, GROUND_LOST})
"""Events that are answered although the robot already responds to another."""

CAME_DOWN_AWAY = "came down for its battery where its sortie began, away from home"
"""Message about a robot that can continue from there, once its battery has been changed."""


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
    """Return the policy that counts for an event; None where none is declared."""
    return next((policy for policy in policies if policy.event == event), None)


def response_to(event: str, policies: Iterable[Policy]) -> str:
    """Return the response to an event, a literal of PolicyResponse."""
    policy = policy_for(event, policies)
    return policy.response if policy else BORNE.get(event, LAST_RESORT)


def patience(event: str, policies: Iterable[Policy]) -> float | None:
    """Return for how many seconds the robot tolerates an event; None: without limit, no policy names it."""
    policy = policy_for(event, policies)
    if policy is None:
        return None
    return AFTER.get(event, 0.0) if policy.after is None else policy.after


def seconds_of(policy: Policy, usual: Mapping[str, float] = UNDECLARED_AFTER) -> float:
    """Return for how many seconds a real robot tolerates the event of a policy; `usual` where it has none."""
    return usual.get(policy.event, 0.0) if policy.after is None else policy.after


def still_low(charge: float | None, reserve: float) -> str:
    """Return why a battery is too low for a flight; empty where it is not, or unknown.

    Args:
        charge: fraction of it that is left; None where unknown.
        reserve: fraction below which it counts as low.
    """
    if charge is None or charge >= reserve:
        return ""
    return f"its battery is still at {charge:.0%}"
