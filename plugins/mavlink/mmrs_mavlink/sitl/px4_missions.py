"""Which missions a PX4 that has stored them flies, as its ``FeasibilityChecker.cpp`` has it."""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

from mmrs_mavlink.sitl.items import MISSION, MOVING

if TYPE_CHECKING:
    from mmrs_mavlink.sitl.autopilot import Autopilot


def is_feasible(pilot: Autopilot) -> bool:
    """Return whether it has a mission whose first place is near enough to home (MIS_DIST_1WP)."""
    items = pilot.stores[MISSION]
    first = next((item for item in items if item.command in MOVING and (item.x or item.y)), None)
    farthest = pilot.parameters["MIS_DIST_1WP"]
    if first is None or farthest <= 0.0:
        return bool(items)
    latitude, longitude, _ = pilot.home
    home, place = pilot.local(latitude, longitude, 0.0), pilot.place_of(first)
    return hypot(place[0] - home[0], place[1] - home[1]) < farthest
