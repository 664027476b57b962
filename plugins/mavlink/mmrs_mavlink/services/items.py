"""Items of missions, fences and rally points."""

from __future__ import annotations

from dataclasses import dataclass

MISSION, FENCE, RALLY = 0, 1, 2
"""MAV_MISSION_TYPE."""

NAMES = {MISSION: "mission", FENCE: "fence", RALLY: "rally points"}

RELATIVE, NO_FRAME = 3, 2
"""MAV_FRAME_GLOBAL_RELATIVE_ALT and MAV_FRAME_MISSION."""

WAYPOINT, LOITER, CHANGE_SPEED = 16, 17, 178
"""MAV_CMD_NAV_WAYPOINT, MAV_CMD_NAV_LOITER_UNLIM and MAV_CMD_DO_CHANGE_SPEED."""

FENCE_VERTEX, RALLY_POINT = 5002, 5100
"""MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION and MAV_CMD_NAV_RALLY_POINT."""


@dataclass(frozen=True, slots=True)
class Item:
    """An item: a MAV_CMD, four parameters, degrees times ten million, metres above home."""

    command: int
    params: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    x: int = 0
    y: int = 0
    z: float = 0.0
    frame: int = RELATIVE
