"""Items of missions, fences and rally points: which are accepted, and how they are stored and returned."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isnan

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.settings import ARDUPILOT, PX4

MISSION, FENCE, RALLY = 0, 1, 2

ABOVE_SEA = frozenset({0, 5})
RETURNED_FRAMES: Mapping[int, int] = {5: 0, 6: 3, 11: 10}
POSITIONAL_FRAMES = frozenset({0, 3, 5, 6, 10, 11})
FREE_HEADING = frozenset({16, 17, 21, 22})
"""Commands whose heading may be NaN."""

FREE_HEADING_ON_PX4 = FREE_HEADING | {19}
NOT_ON_PX4 = frozenset({82, 115, 181, 182, 183, 184, 207})
"""Commands that an ArduPilot's mission can hold and a PX4's cannot."""

MOVING = frozenset({16, 17, 18, 19, 21, 22, 82})
FENCES = frozenset({5001, 5002, 5003, 5004})
PLACED = MOVING | FENCES | {5100, 201, 195, 179, 189}
OTHERS = frozenset(
    {20, 93, 112, 114, 115, 177, 178, 181, 182, 183, 184, 197, 203, 204, 205, 206, 207, 211}
    | {1000, 1001, 2000, 2001, 2500, 2501, 42600, 530, 531}
)
LAST_NAVIGATION = 95
"""Items with higher commands are executed during the flight to the next one."""

KNOWN = {MISSION: (PLACED - FENCES - {5100}) | OTHERS, FENCE: FENCES, RALLY: frozenset({5100})}


@dataclass(frozen=True, slots=True)
class StoredItem:
    """An item as received: degrees times ten million, metres."""

    frame: int
    command: int
    params: tuple[float, float, float, float]
    x: int
    y: int
    z: float

    @property
    def is_flown(self) -> bool:
        """Return whether the vehicle moves, waits or returns for this item."""
        return self.command <= LAST_NAVIGATION

    @property
    def above_sea(self) -> bool:
        """Return whether its altitude is above mean sea level."""
        return self.frame in ABOVE_SEA


def fault_of(item: StoredItem, kind: int = MISSION, firmware: str = ARDUPILOT) -> int:
    """Return the MAV_MISSION_RESULT by which an item is refused; 0 if it is accepted."""
    refused = NOT_ON_PX4 if firmware == PX4 else frozenset()
    if item.command not in KNOWN.get(kind, frozenset()) - refused:
        return int(mavlink.MAV_MISSION_UNSUPPORTED)
    if item.command in PLACED and item.frame not in POSITIONAL_FRAMES:
        return int(mavlink.MAV_MISSION_UNSUPPORTED_FRAME)
    free = FREE_HEADING_ON_PX4 if firmware == PX4 else FREE_HEADING
    for index, value in enumerate(item.params[: 3 if item.command in free else 4]):
        if isnan(value):
            return int(mavlink.MAV_MISSION_INVALID_PARAM1) + index
    return 0


def kept(item: StoredItem, kind: int, firmware: str) -> StoredItem:
    """Return an item as it is stored.

    ArduPilot stores altitudes in centimetres, those of rally points in metres, holds in whole seconds, no
    altitude of a fence, and of a frame only its altitude reference. PX4 stores floats.
    """
    if firmware == PX4:
        return item
    if kind == FENCE:
        return replace(item, frame=0, z=0.0)
    if kind == RALLY:
        return replace(item, frame=3, z=float(int(item.z)))
    params = tuple(0.0 if isnan(value) else value for value in item.params)
    if item.command == mavlink.MAV_CMD_NAV_WAYPOINT:
        params = (float(int(params[0])), 0.0, 0.0, 0.0)
    frame = RETURNED_FRAMES.get(item.frame, item.frame) if item.command in PLACED else 0
    height = int(item.z * 100.0 + (0.5 if item.z >= 0 else -0.5)) / 100.0
    return replace(item, frame=frame, params=(params[0], params[1], params[2], params[3]), z=height)
