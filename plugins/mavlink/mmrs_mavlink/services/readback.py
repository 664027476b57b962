"""Which differences between an uploaded item and what the vehicle gives back are none.

What each autopilot keeps of an item was read in its source: ArduPilot in ``AP_Mission.cpp``
(``mavlink_int_to_mission_cmd``, ``mission_cmd_to_mavlink_int``), ``AC_PolyFence_loader.cpp`` and
``AP_Rally.h``; PX4 in ``mavlink_mission.cpp`` (``parse_`` and ``format_mavlink_mission_item``).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isnan

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from .items import FENCE, MISSION, NO_FRAME, RALLY, Item

HEIGHTS_ABOVE = {
    mavlink.MAV_FRAME_GLOBAL: "sea level",
    mavlink.MAV_FRAME_GLOBAL_INT: "sea level",
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT: "home",
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT: "home",
    mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT: "the terrain",
    mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: "the terrain",
}
"""What heights count from in a frame: vehicles give back another number of the same frame."""

ALL = (0, 1, 2, 3)
YAW = 3


@dataclass(frozen=True, slots=True)
class Keeping:
    """What an autopilot keeps of items.

    Attributes:
        params: by command, the parameters (0 to 3) that are kept; all of commands that are not here.
        degrees: units of the seventh decimal that places may lose.
        heights: metres that heights may lose, by kind of item.
        wraps: whether headings come back as another number for the same direction.
    """

    params: Mapping[int, tuple[int, ...]]
    degrees: int
    heights: Mapping[int, float]
    wraps: bool = False


ARDUPILOT = Keeping(
    {
        mavlink.MAV_CMD_NAV_WAYPOINT: (0,),
        mavlink.MAV_CMD_NAV_LOITER_UNLIM: (2,),
        mavlink.MAV_CMD_NAV_LOITER_TIME: (0,),
        mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH: (),
        mavlink.MAV_CMD_NAV_LAND: (0,),
        mavlink.MAV_CMD_NAV_TAKEOFF: (0,),
        mavlink.MAV_CMD_NAV_RALLY_POINT: (),
        mavlink.MAV_CMD_DO_SET_ROI_LOCATION: (),
        mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST: (0, 2),
    },
    degrees=1,
    heights={MISSION: 0.02, RALLY: 1.0},
)
"""Centimetres; of rally points whole metres only; of waypoints the hold, in whole seconds."""

PX4 = Keeping(
    {mavlink.MAV_CMD_NAV_RALLY_POINT: (), mavlink.MAV_CMD_DO_SET_ROI_LOCATION: ()},
    degrees=1,
    heights={MISSION: 0.01, RALLY: 0.01},
    wraps=True,
)
"""Numbers of single precision; headings between -180 and 180 degrees."""

KEEPING = {mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA: ARDUPILOT, mavlink.MAV_AUTOPILOT_PX4: PX4}
USUAL = Keeping({}, degrees=1, heights={MISSION: 0.02, RALLY: 0.02})


def alike(wanted: Item, found: Item, kind: int, autopilot: int) -> bool:
    """Return whether an item that was given back is the one that was uploaded."""
    keeping = KEEPING.get(autopilot, USUAL)
    if wanted.command != found.command:
        return False
    kept = keeping.params.get(wanted.command, ALL)
    same = all(_close(wanted.params[n], found.params[n], keeping.wraps and n == YAW) for n in kept)
    apart = max(abs(wanted.x - found.x), abs(wanted.y - found.y))
    return same and apart <= keeping.degrees and _as_high(wanted, found, kind, keeping)


def _close(a: float, b: float, heading: bool) -> bool:
    if isnan(a) or isnan(b):
        return isnan(a) and isnan(b)
    apart = abs((a - b + 180.0) % 360.0 - 180.0) if heading else abs(a - b)
    return apart <= 1e-3 * max(1.0, abs(a))


def _as_high(wanted: Item, found: Item, kind: int, keeping: Keeping) -> bool:
    """Return whether two heights are the same; fences and items without a place have none."""
    if kind == FENCE:
        return True
    if abs(wanted.z - found.z) > keeping.heights[kind]:
        return False
    return wanted.frame == NO_FRAME or HEIGHTS_ABOVE[wanted.frame] == HEIGHTS_ABOVE.get(found.frame)
