"""Whether a vehicle is seen to carry out a response."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot

from ..orders.obedience import OBEYED_IN
from ..orders.orders import HOLD, LAND
from ..places import offset
from ..policies import COMES_DOWN
from ..program import Robot
from ..vehicles.vehicle import Vehicle
from .ways import Track, way_back

STOP_THRUST = "STOP_THRUST"
RETURN = "RETURN"
AT_HOME = 20.0
"""Metres from home within which a robot has come home, as far as positions tell."""


def obeying(response: str, robot: Robot, vehicle: Vehicle, track: Track) -> Callable[[], bool]:
    """Return what tells, from now on, whether a vehicle does what a response asks for.

    Args:
        response: as in policies.
        robot: its program.
        vehicle: that carries it out.
        track: the places that the robot has passed, by which it goes back.
    """
    if response == STOP_THRUST:
        return lambda: not vehicle.state().armed
    evidence = vehicle.evidence()
    goal = next(way_back(robot, response, track, vehicle.state().place), None)
    if goal is None:
        wanted = OBEYED_IN[LAND if response in COMES_DOWN else HOLD]
        return lambda: evidence.in_mode(wanted)
    return lambda: evidence.bound_for(goal, robot.cruise)


def undone(response: str, robot: Robot, vehicle: Vehicle) -> str:
    """Return why a vehicle has not done what it was told to, although nothing is left to do; or nothing.

    One whose motors are off elsewhere than at home does not return.
    """
    away = astray(robot, vehicle, AT_HOME)
    return away if response == RETURN and not vehicle.state().armed else ""


def astray(robot: Robot, vehicle: Vehicle, tolerance: float) -> str:
    """Return that a vehicle on the ground is further than so many metres from home; empty where it is not."""
    away = hypot(*offset(robot.home, vehicle.state().place)[:2])
    return f"it stands {away:.0f} m from its home" if away > tolerance else ""
