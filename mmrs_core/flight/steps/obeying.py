"""Whether a vehicle is seen to carry out a response."""

from __future__ import annotations

from collections.abc import Callable

from ..orders.obedience import OBEYED_IN
from ..orders.orders import HOLD, LAND
from ..program import Robot
from ..vehicles.vehicle import Vehicle
from .energy import COMES_DOWN
from .ways import Track, way_back

STOP_THRUST = "STOP_THRUST"


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
