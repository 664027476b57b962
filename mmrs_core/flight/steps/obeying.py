"""Whether a vehicle is seen to carry out a response."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot

from ..places import offset
from ..program import Robot
from ..vehicles.vehicle import Vehicle
from .responding import OFF, course_of
from .responses import RETURN
from .ways import Track


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
    """Return why a vehicle has not done what it was told to, although nothing is left to do; or nothing.

    One whose motors are off further from home than `tolerance`, metres, does not return.
    """
    away = astray(robot, vehicle, tolerance)
    return away if response == RETURN and not vehicle.state().armed else ""


def astray(robot: Robot, vehicle: Vehicle, tolerance: float) -> str:
    """Return that a vehicle on the ground is further than so many metres from home; empty where it is not."""
    away = hypot(*offset(robot.home, vehicle.state().place)[:2])
    return f"it stands {away:.0f} m from its home" if away > tolerance else ""
