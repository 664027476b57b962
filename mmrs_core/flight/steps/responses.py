"""What a robot does when something has gone wrong."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from ..faults import (
    BATTERY_LOW,
    GROUND_LOST,
    LINK_LOST,
    POSITION_LOST,
    TAKEN_OVER,
)
from ..policies import NOTHING
from ..program import Place, Policy, Robot
from ..vehicles.vehicle import Vehicle
from .ways import steps_back

CONTINUE = "CONTINUE"
HOLD = "HOLD"
LAND = "LAND"
ESCAPE = "EMERGENCY_AREA"
RETURN = "RETURN"

DEFAULTS: Mapping[str, str] = {
    LINK_LOST: RETURN,
    BATTERY_LOW: RETURN,
    GROUND_LOST: CONTINUE,
    TAKEN_OVER: NOTHING,
}
"""Responses where no policy says anything; to anything else, robots hold."""

BLOCKED = (
    "cannot fly straight to an emergency area from everywhere on its way: where nobody hears it, its vehicle"
    " goes back the way it came instead"
)

NEEDS_POSITION = frozenset({RETURN, "EMERGENCY_AREA", HOLD})
"""Responses that nobody can carry out who does not know where it is."""

Movement = Callable[[], None]
Repeat = Callable[[Movement], None]


def policy_for(event: str, robot: Robot, first: Sequence[Policy] = ()) -> Policy:
    """Return what a robot does about an event: by the wait's policies, its own, or the defaults."""
    if event == TAKEN_OVER:
        return Policy(event, NOTHING)
    for policy in (*first, *robot.policies):
        if policy.event == event:
            return policy
    return Policy(event, DEFAULTS.get(event, HOLD))


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


def respond(
    response: str, robot: Robot, vehicle: Vehicle, track: list[tuple[str, Place]], repeat: Repeat
) -> bool:
    """Carry out a response.

    Args:
        response: as in policies, or ``NOTHING``.
        robot: whose program it was.
        vehicle: its vehicle.
        track: the places it has passed, with the moves that ended there; what it has gone back is
            taken off, so that another response begins where this one was left.
        repeat: carries out a movement, again if it was held in the middle of it.

    Returns:
        Whether the vehicle now holds and somebody must watch it.

    Raises:
        Fault: the response cannot be carried out either.
    """
    if response == NOTHING:
        return False
    vehicle.take_back()
    if response in (RETURN, "EMERGENCY_AREA"):
        return _go_back(response, robot, vehicle, track, repeat)
    if response == LAND:
        repeat(partial(_come_down, robot, vehicle))
    elif response == "SURFACE":
        repeat(vehicle.surface)
    elif response == "STOP_THRUST":
        vehicle.disarm()
    else:
        return vehicle.hold()
    return False


def _go_back(
    response: str, robot: Robot, vehicle: Vehicle, track: list[tuple[str, Place]], repeat: Repeat
) -> bool:
    flies = robot.vehicle == "copter"
    if (flies and not vehicle.state().armed) or not (track or flies):
        return vehicle.hold()
    for index, place in tuple(steps_back(robot, response, track, vehicle.state().place)):
        repeat(partial(vehicle.go_to, place, robot.cruise, None, True))
        if index is not None:
            del track[index + 1 :]
    repeat(partial(_come_down, robot, vehicle))
    return False


def _come_down(robot: Robot, vehicle: Vehicle) -> None:
    if robot.vehicle == "copter":
        vehicle.land()
    elif robot.vehicle == "sub":
        vehicle.surface()
    else:
        vehicle.hold()
