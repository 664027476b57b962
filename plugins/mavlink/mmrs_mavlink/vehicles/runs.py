"""How a run of the uploaded mission begins where the program wants it, on ArduPilot and on PX4.

An ArduPilot that is not in AUTO continues from the commanded item to the next one that it flies to,
and reports the number of that one; what stands before it is done when AUTO begins (``AP_Mission.cpp``,
``set_current_cmd``; ``GCS_Common.cpp``, ``MSG_CURRENT_WAYPOINT``). With MIS_RESTART = 1 it begins with
the first item whatever was commanded (``start_or_resume``). A PX4 reports the commanded item
(``mission.cpp``, ``set_current_mission_index``), and has no such parameter; but with COM_TAKEOFF_ACT = 1 it
begins its mission as soon as it has taken off (``Commander.cpp``, ``checkForMissionUpdate``), of whichever
run. An ArduPilot forgets the speed of a mission when AUTO is entered.
"""

from __future__ import annotations

from collections.abc import Sequence

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError

from ..links.autopilots import is_px4
from ..links.link import Link
from ..services import parameters
from ..services.items import CHANGE_SPEED, LOITER, Item
from . import modes

LAST_TO_FLY = int(mavlink.MAV_CMD_NAV_LAST)
"""Items with higher commands are carried out on the way; the vehicle goes nowhere for them."""

RESTART, AFTER_TAKE_OFF = "MIS_RESTART", "COM_TAKEOFF_ACT"
AT_ONCE = 1
"""The value of either by which a vehicle begins a run without a command."""

USUAL_SPEED = -1.0
"""With which DO_CHANGE_SPEED makes a PX4 take the speed of its parameters."""

TROUBLE = {
    RESTART: "the vehicle would begin every run with the first item of its mission",
    AFTER_TAKE_OFF: "the vehicle would begin its mission without a command after take-off",
}


def first_flown(mission: Sequence[Item], seq: int) -> int:
    """Return the number of the first item from `seq` on that the vehicle flies to."""
    return next(index for index in range(seq, len(mission)) if mission[index].command <= LAST_TO_FLY)


def speed_for(link: Link, mission: Sequence[Item], seq: int) -> float | None:
    """Return the speed to command to a vehicle that begins AUTO at an item; None: none is needed.

    A PX4 restores the speed that was last set before the item, of whichever run (``mission_base.cpp``,
    ``on_activation``): less than 0 makes it take its default.
    """
    said = speed_before(mission, seq)
    if said is not None or mission[seq].command == CHANGE_SPEED or not is_px4(link):
        return said
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
    name = AFTER_TAKE_OFF if is_px4(link) else RESTART
    if round(parameters.read(link, [name]).get(name, 0)) != AT_ONCE:
        return ""
    if not parameters.write(link, name, 0.0, modes.PARAMETER_KINDS.get(name, parameters.REAL)):
        raise RefusedError(f"{name} = 1: {TROUBLE[name]}, and does not confirm 0")
    return f"{name} = 0, which was 1: each run begins with its own first place"
