"""How a run of the uploaded mission begins where the program wants it, on ArduPilot and on PX4.

An ArduPilot that is not in AUTO goes on from the item that it is told to the next one that it flies to,
and tells the number of that one; what stands before it is done when AUTO begins (``AP_Mission.cpp``,
``set_current_cmd``; ``GCS_Common.cpp``, ``MSG_CURRENT_WAYPOINT``). With MIS_RESTART = 1 it begins with
the first item whatever it was told (``start_or_resume``). A PX4 tells the item that it was told
(``mission.cpp``, ``set_current_mission_index``), and has no such parameter. Both forget the speed of a
mission when AUTO is entered.
"""

from __future__ import annotations

from collections.abc import Sequence

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..faults import Refused
from ..links.autopilots import is_px4
from ..links.link import Link
from ..services import parameters
from ..services.items import Item

LAST_TO_FLY = int(mavlink.MAV_CMD_NAV_LAST)
"""Items with higher commands are carried out on the way; the vehicle goes nowhere for them."""

RESTART = "MIS_RESTART"
FROM_THE_FIRST = 1


def first_flown(mission: Sequence[Item], seq: int) -> int:
    """Return the number of the first item from `seq` on that the vehicle flies to."""
    return next(index for index in range(seq, len(mission)) if mission[index].command <= LAST_TO_FLY)


def speed_before(mission: Sequence[Item], seq: int) -> float | None:
    """Return the speed that its run has said before an item, metres per second; None: none yet."""
    for item in reversed(mission[:seq]):
        if item.command == mavlink.MAV_CMD_NAV_LOITER_UNLIM:
            return None
        if item.command == mavlink.MAV_CMD_DO_CHANGE_SPEED:
            return item.params[1]
    return None


def keep_place(link: Link) -> str:
    """Have the vehicle begin AUTO at the item that it was told.

    Returns:
        What was changed, for people; empty where nothing was.

    Raises:
        Refused: it would begin every run with the first item of its mission.
    """
    if is_px4(link) or round(parameters.read(link, [RESTART]).get(RESTART, 0)) != FROM_THE_FIRST:
        return ""
    if not parameters.write(link, RESTART, 0.0):
        raise Refused(
            f"{RESTART} = 1: the vehicle would begin every run with the first item of its mission, "
            "and does not confirm 0"
        )
    return f"{RESTART} = 0, which was 1: each run begins with its own first place"
