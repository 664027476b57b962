"""What a vehicle receives before its program begins, or continues."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from mmrs_runtime.faults import FENCE_BREACHED, RefusedError

from ..program import Robot
from ..vehicles.vehicle import Vehicle
from .responses import policy_for

if TYPE_CHECKING:
    from ..services.uploads import Uploads


def equip(robot: Robot, vehicle: Vehicle, uploads: Uploads, say: Callable[[str], None]) -> None:
    """Upload what a vehicle must know, and its response outside its fence.

    Args:
        robot: whose policies count.
        vehicle: of the robot.
        uploads: of its program.
        say: reports refusals that the program can do without.

    Raises:
        RefusedError: the vehicle does not accept an upload that it needs, or does not become ready.
    """
    vehicle.prepare(uploads)
    if not uploads.fence:
        return
    try:
        vehicle.answer_breach(policy_for(FENCE_BREACHED, robot).response)
    except RefusedError as error:
        say(str(error))
