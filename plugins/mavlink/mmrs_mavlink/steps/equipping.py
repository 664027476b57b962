"""What a vehicle is told before its program begins, or goes on."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from mmrs_runtime.faults import FENCE_BREACHED, Refused

from ..program import Robot
from ..vehicles.vehicle import Vehicle
from .responses import policy_for

if TYPE_CHECKING:
    from ..services.uploads import Uploads


def equip(robot: Robot, vehicle: Vehicle, uploads: Uploads, say: Callable[[str], None]) -> None:
    """Have a vehicle know what it must, and what to do by itself outside its fence.

    Args:
        robot: whose policies count.
        vehicle: of the robot.
        uploads: of its program.
        say: tells people what the vehicle refuses, where the program can do without.

    Raises:
        Refused: the vehicle does not accept what it must know, or does not become ready.
    """
    vehicle.prepare(uploads)
    if not uploads.fence:
        return
    try:
        vehicle.answer_breach(policy_for(FENCE_BREACHED, robot).response)
    except Refused as error:
        say(str(error))
