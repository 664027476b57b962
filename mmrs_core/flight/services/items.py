"""Items of missions, fences and rally points."""

from __future__ import annotations

from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

MISSION = mavlink.MAV_MISSION_TYPE_MISSION
FENCE = mavlink.MAV_MISSION_TYPE_FENCE
RALLY = mavlink.MAV_MISSION_TYPE_RALLY
NAMES = {MISSION: "mission", FENCE: "fence", RALLY: "rally points"}

RELATIVE = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT
NO_FRAME = mavlink.MAV_FRAME_MISSION


@dataclass(frozen=True, slots=True)
class Item:
    """An item: a MAV_CMD, four parameters, degrees times ten million, metres above home."""

    command: int
    params: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    x: int = 0
    y: int = 0
    z: float = 0.0
    frame: int = RELATIVE
