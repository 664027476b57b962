"""What a robot does when something has gone wrong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .faults import (
    BATTERY_LOW,
    LINK_LOST,
    STOPPED,
    TAKEN_OVER,
    Fault,
)
from .program import Place, Policy, Robot
from .vehicle import Vehicle

CONTINUE = "CONTINUE"
HOLD = "HOLD"
NOTHING = "NOTHING"

DEFAULTS: Mapping[str, str] = {LINK_LOST: "RETURN", BATTERY_LOW: "RETURN", TAKEN_OVER: NOTHING}
"""Responses where no policy says anything; to anything else, robots hold."""


def policy_for(event: str, robot: Robot, first: Sequence[Policy] = ()) -> Policy:
    """Return what a robot does about an event: by the wait's policies, its own, or the defaults."""
    for policy in (*first, *robot.policies):
        if policy.event == event:
            return policy
    return Policy(event, DEFAULTS.get(event, HOLD))


def respond(
    response: str, fault: Fault, robot: Robot, vehicle: Vehicle, track: Sequence[tuple[str, Place]]
) -> bool:
    """Carry out a response.

    Args:
        response: as in policies, or ``NOTHING``.
        fault: what it is a response to.
        robot: whose program it was.
        vehicle: its vehicle.
        track: the places it has passed, with the moves that ended there.

    Returns:
        Whether the vehicle now holds and somebody must watch it.

    Raises:
        Fault: the response cannot be carried out either.
    """
    if fault.event == LINK_LOST or response == NOTHING:
        return False
    if response == "RETURN":
        _go_back(robot, vehicle, track)
    elif response == "EMERGENCY_AREA":
        _escape(robot, vehicle, track)
    elif response == "LAND":
        _come_down(robot, vehicle)
    elif response == "SURFACE":
        vehicle.surface()
    elif response == "STOP_THRUST":
        vehicle.disarm()
    else:
        return vehicle.hold() and fault.event != STOPPED
    return False


def _go_back(robot: Robot, vehicle: Vehicle, track: Sequence[tuple[str, Place]]) -> None:
    for _, place in reversed(track):
        vehicle.go_to(place, None, None, True)
    if track:
        _come_down(robot, vehicle)
    else:
        vehicle.hold()


def _escape(robot: Robot, vehicle: Vehicle, track: Sequence[tuple[str, Place]]) -> None:
    escapes = dict(robot.escapes)
    for move, place in reversed(track):
        vehicle.go_to(place, None, None, True)
        if move in escapes:
            vehicle.go_to(escapes[move], None, None, False)
            break
    if track:
        _come_down(robot, vehicle)
    else:
        vehicle.hold()


def _come_down(robot: Robot, vehicle: Vehicle) -> None:
    if robot.vehicle == "copter":
        vehicle.land()
    elif robot.vehicle == "sub":
        vehicle.surface()
    else:
        vehicle.hold()
