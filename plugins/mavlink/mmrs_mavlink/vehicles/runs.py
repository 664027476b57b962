"""How a run of the uploaded mission begins where the program wants it, with any autopilot."""

from __future__ import annotations

from collections.abc import Sequence

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError

from ..links.link import Link
from ..services import parameters
from ..services.items import CHANGE_SPEED, LOITER, Item

LAST_TO_FLY = int(mavlink.MAV_CMD_NAV_LAST)
"""Items with higher commands are carried out on the way; the vehicle goes nowhere for them."""

AT_ONCE = 1
"""The value by which a vehicle begins a run elsewhere, or without a command."""

USUAL_SPEED = -1.0
"""With which DO_CHANGE_SPEED makes a vehicle take the speed of its parameters."""


def first_flown(mission: Sequence[Item], seq: int) -> int:
    """Return the number of the first item from `seq` on that the vehicle flies to."""
    return next(index for index in range(seq, len(mission)) if mission[index].command <= LAST_TO_FLY)


def speed_for(link: Link, mission: Sequence[Item], seq: int) -> float | None:
    """Return the speed to command to a vehicle that begins AUTO at an item; None: none is needed.

    Where the speed of an earlier run is restored, less than 0 makes the vehicle take its default.
    """
    said = speed_before(mission, seq)
    if said is not None or mission[seq].command == CHANGE_SPEED:
        return said
    if not link.profile.autopilot.missions.keeps_speed:
        return None
    return USUAL_SPEED if any(item.command == CHANGE_SPEED for item in mission[:seq]) else None


def speed_before(mission: Sequence[Item], seq: int) -> float | None:
    """Return the speed that its run has said before an item, metres per second; None: none yet."""
    for item in reversed(mission[:seq]):
        if item.command == LOITER:
            return None
        if item.command == CHANGE_SPEED:
            return item.params[1]
    return None


def keep_place(link: Link) -> str:
    """Make the vehicle begin AUTO at the commanded item.

    Returns:
        What was changed, in words; empty where nothing was.

    Raises:
        RefusedError: it would begin runs elsewhere, or without a command.
    """
    name, trouble = link.profile.autopilot.missions.starts_itself
    if not name or round(parameters.read(link, [name]).get(name, 0)) != AT_ONCE:
        return ""
    if not parameters.write(link, name, 0.0):
        raise RefusedError(f"{name} = 1: {trouble}, and does not confirm 0")
    return f"{name} = 0, which was 1: each run begins with its own first place"
