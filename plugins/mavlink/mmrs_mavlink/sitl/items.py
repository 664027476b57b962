"""Items of missions, fences and rally points: which are accepted, and how they are stored and returned."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isnan

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import PX4, Autopilot

MISSION, FENCE, RALLY = 0, 1, 2

ABOVE_SEA = frozenset({0, 5})
RETURNED_FRAMES: Mapping[int, int] = {5: 0, 6: 3, 11: 10}
POSITIONAL_FRAMES = frozenset({0, 3, 5, 6, 10, 11})
FREE_HEADING = frozenset({16, 17, 21, 22})
"""Commands whose heading may be NaN."""

MOVING = frozenset({16, 17, 19, 21, 22})
FENCES = frozenset({5001, 5002, 5003, 5004})
PLACED = MOVING | FENCES | {5100, 201, 195, 179, 189}
ONLY_ARDUPILOT = frozenset({115, 181, 182, 183, 184, 207})
"""Commands that an ArduPilot's mission can hold and a PX4's cannot."""


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
        """Return whether it is flown; others are executed during the flight to the next one."""
        return self.command <= int(mavlink.MAV_CMD_NAV_LAST)


def fault_of(item: StoredItem, kind: int, autopilot: Autopilot) -> int:
    """Return the MAV_MISSION_RESULT by which an item is refused; 0 if it is accepted."""
    missions = autopilot.missions.commands or (PX4.missions.commands or frozenset()) | ONLY_ARDUPILOT
    if item.command not in {MISSION: missions, FENCE: FENCES, RALLY: {5100}}.get(kind, ()):
        return int(mavlink.MAV_MISSION_UNSUPPORTED)
    if item.command in PLACED and item.frame not in POSITIONAL_FRAMES:
        return int(mavlink.MAV_MISSION_UNSUPPORTED_FRAME)
    free = FREE_HEADING | {19} if autopilot.copies_bytes else FREE_HEADING
    for index, value in enumerate(item.params[: 3 if item.command in free else 4]):
        if isnan(value):
            return int(mavlink.MAV_MISSION_INVALID_PARAM1) + index
    return 0


def kept(item: StoredItem, kind: int, autopilot: Autopilot) -> StoredItem:
    """Return an item as it is stored.

    ArduPilot stores the parameters that its profile names, altitudes in centimetres, those of rally points in
    metres, holds in whole seconds, no altitude of a fence, and of a frame only its altitude reference. PX4
    stores floats.
    """
    if autopilot.copies_bytes:
        return item
    if kind == FENCE:
        return replace(item, frame=0, z=0.0)
    if kind == RALLY:
        return replace(item, frame=3, z=float(int(item.z)))
    stored = autopilot.keeping.params.get(item.command, range(4))
    a, b, c, d = (value if n in stored and not isnan(value) else 0.0 for n, value in enumerate(item.params))
    if item.command == mavlink.MAV_CMD_NAV_WAYPOINT:
        a = float(int(a))
    frame = RETURNED_FRAMES.get(item.frame, item.frame) if item.command in PLACED else 0
    height = int(item.z * 100.0 + (0.5 if item.z >= 0 else -0.5)) / 100.0
    return replace(item, frame=frame, params=(a, b, c, d), z=height)
