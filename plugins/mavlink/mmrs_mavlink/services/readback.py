"""Which differences between an uploaded item and what the vehicle gives back are none."""

from __future__ import annotations

from math import isnan

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..profiles.autopilot import Keeping
from .items import FENCE, NO_FRAME, Item

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


def alike(wanted: Item, found: Item, kind: int, keeping: Keeping) -> bool:
    """Return whether an item that was given back is the one that was uploaded, as far as it is kept."""
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
