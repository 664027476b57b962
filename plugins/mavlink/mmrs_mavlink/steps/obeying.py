"""Whether a vehicle is seen to carry out a response."""

from __future__ import annotations

from collections.abc import Callable

from mmrs_runtime.controllers.return_paths import Track
from mmrs_runtime.policies import HOLD, RETURN

from ..program import Robot
from ..vehicles.footing import aside, misplaced
from ..vehicles.vehicle import Vehicle
from .motors import TOUCHING
from .responding import OFF, course_of


def obeying(response: str, robot: Robot, vehicle: Vehicle, track: Track) -> Callable[[], bool]:
    """Return what tells, from now on, whether a vehicle does what a response asks for.

    Args:
        response: as in policies.
        robot: its program.
        vehicle: that carries it out.
        track: the places that the robot has passed, by which it goes back.
    """
    evidence, course = vehicle.evidence(), course_of(response, robot, vehicle, track)
    if course.places:
        _, goal = course.places[0]
        return lambda: evidence.bound_for(goal, robot.cruise)
    return evidence.is_off if course.rest == OFF else lambda: evidence.in_mode(course.rest)


def undone(response: str, robot: Robot, vehicle: Vehicle, tolerance: float) -> str:
    """Return why a vehicle with nothing left to do has not carried out its command; empty where it has.

    One that is disarmed further from home than `tolerance`, metres, does not return; a submarine
    that is disarmed below the surface does not hold.
    """
    state = vehicle.state()
    away = aside(robot.home, state.place)
    if response == RETURN and not state.armed and away > tolerance:
        return f"it stands {away:.0f} m from its home"
    if response == HOLD and robot.profile.dives and not state.armed and state.place.height < -TOUCHING:
        return "it is disarmed, below the surface"
    return ""


def away(robot: Robot, vehicle: Vehicle, tolerance: float) -> str:
    """Return that a vehicle on the ground is further than `tolerance` metres from home, or nothing."""
    return misplaced(robot.home, robot.home, vehicle.state().place, tolerance)


def astray(robot: Robot, vehicle: Vehicle, tolerance: float) -> str:
    """Return that a vehicle on the ground cannot take off where it is, and where to carry it; or nothing."""
    return misplaced(robot.home, vehicle.start, vehicle.state().place, tolerance)
