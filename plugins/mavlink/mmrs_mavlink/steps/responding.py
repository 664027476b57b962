"""Carries out the responses of a robot to faults and to orders."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from mmrs_runtime.controllers.return_paths import Track, steps_back
from mmrs_runtime.faults import LINK_LOST, NO_PROGRESS, REFUSED, FaultError
from mmrs_runtime.policies import COMES_DOWN, ESCAPE, HOLD, LAND, NOTHING, RETURN

from ..profiles import modes
from ..program import Place, Policy, Robot
from ..vehicles.vehicle import Vehicle
from .responses import alone, policy_for

SURFACE = "SURFACE"
STOP_THRUST = "STOP_THRUST"
OFF = "off"
"""The mode for disarming, whatever happens then."""

HINDRANCES = frozenset({NO_PROGRESS, REFUSED})
"""Faults of a vehicle that does not carry out a command, while all else is well."""

Movement = Callable[[], None]
Repeat = Callable[[Movement], None]


@dataclass(frozen=True, slots=True)
class Course:
    """The outcome of a response, for one robot at its position.

    Attributes:
        places: that it goes to first, each with its number in the track; None: not on it.
        rest: the mode in which it comes to rest then, or `OFF`.
        stays: whether an operator must watch it there, as long as it is armed.
    """

    places: tuple[tuple[int | None, Place], ...]
    rest: str
    stays: bool


def course_of(response: str, robot: Robot, vehicle: Vehicle, track: Track) -> Course:
    """Return what a response comes to now.

    Args:
        response: as in policies, but not ``NOTHING``.
        robot: its program.
        vehicle: that carries it out.
        track: the places that the robot has passed, by which it goes back.
    """
    down = robot.profile.rests
    if response in (RETURN, ESCAPE):
        flies, state = robot.profile.flies, vehicle.state()
        if (flies and not state.armed) or not (track or flies):
            return Course((), modes.HOLD, True)
        return Course(tuple(steps_back(robot, response, track, state.place)), down[LAND], False)
    if response == STOP_THRUST:
        return Course((), OFF, False)
    return Course((), down.get(response, modes.HOLD), response not in down)


def respond(
    response: str, robot: Robot, vehicle: Vehicle, track: list[tuple[str, Place]], repeat: Repeat
) -> bool:
    """Carry out a response.

    Args:
        response: as in policies, or ``NOTHING``.
        robot: whose program it was.
        vehicle: its vehicle.
        track: the positions it has passed, with the moves that ended there; what it has retraced is
            removed, so that another response begins where this one was left.
        repeat: carries out a movement, again if it was held in the middle of it.

    Returns:
        Whether the vehicle now holds and must be watched.

    Raises:
        FaultError: the response cannot be carried out either.
    """
    if response == NOTHING:
        return False
    vehicle.take_back()
    course = course_of(response, robot, vehicle, track)
    for index, place in course.places:
        repeat(partial(vehicle.go_to, place, robot.cruise, None, True))
        if index is not None:
            del track[index + 1 :]
    if course.stays:
        return vehicle.hold()
    _come_to_rest(course.rest, vehicle, repeat)
    return False


def respond_or_less(
    response: str,
    robot: Robot,
    vehicle: Vehicle,
    track: list[tuple[str, Place]],
    repeat: Repeat,
    tell: Callable[[str, FaultError, str], None],
    *,
    low: bool,
) -> bool:
    """Carry out a response, or a simpler one, where the vehicle does not carry out a command.

    Args:
        response, robot, vehicle, track, repeat: as for `respond`.
        tell: called with the response that cannot be carried out, why, and its replacement.
        low: whether the battery is, so that there must be no waiting in the air.

    Returns:
        Whether the vehicle now holds and must be watched.

    Raises:
        FaultError: no simpler response can be carried out either, or there is another fault.
    """
    while True:
        try:
            return respond(response, robot, vehicle, track, repeat)
        except FaultError as fault:
            less = plainer(response, robot.profile.down, low=low) if fault.event in HINDRANCES else ""
            if not less or not vehicle.state().armed:
                raise
            tell(response, fault, less)
            response = less


def comes_down_alone(robot: Robot, vehicle: Vehicle, policies: Sequence[Policy]) -> bool:
    """Return whether a vehicle lands once it receives no messages, or has landed.

    Args:
        robot: whose policies count, after those of the wait.
        vehicle: of the robot.
        policies: of the wait that the robot is in.
    """
    policy = alone(policy_for(LINK_LOST, robot, policies), robot)
    return policy.response in COMES_DOWN or not vehicle.state().armed


def plainer(response: str, down: str, *, low: bool) -> str:
    """Return what is done where a response cannot be carried out; empty: there is nothing plainer.

    Args:
        response: as in policies.
        down: what is left to its class of vehicle.
        low: whether its battery is.
    """
    if response in (LAND, SURFACE):
        return ""
    left = down if low or response == HOLD else HOLD
    return "" if left == response else left


def _come_to_rest(rest: str, vehicle: Vehicle, repeat: Repeat) -> None:
    if rest == modes.LAND:
        repeat(vehicle.land)
    elif rest == modes.SURFACE:
        repeat(vehicle.surface)
    elif rest == OFF:
        vehicle.disarm()
    else:
        repeat(lambda: _halt(vehicle))


def _halt(vehicle: Vehicle) -> None:
    vehicle.hold()
