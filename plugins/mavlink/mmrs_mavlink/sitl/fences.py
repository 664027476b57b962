"""Fences of a simulated vehicle: limits about its home, and polygons and circles to stay in or out of."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist, hypot

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.items import FENCE

Point = tuple[float, float]
INCLUSIONS = {
    int(mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION),
    int(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION),
}
CIRCLES = {
    int(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION),
    int(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION),
}


def outside_fence(pilot: SimulatedAutopilot) -> bool:
    """Return whether a vehicle is outside the parts of its fence that its parameters enable."""
    fence, values = pilot.settings.profile.autopilot.fence, pilot.parameters
    if not values.get(fence.enabled_by, 1):
        return False
    enabled = int(values[fence.types]) if fence.types else -1
    north, east, up = pilot.body.position
    extents = {"radius": hypot(north, east), "height": up if pilot.flies else 0.0}
    limited = [each for each in fence.limits if not fence.types or enabled & each.bit]
    if any(0.0 < values[each.parameter] < extents[each.of] for each in limited):
        return True
    return bool(not fence.types or enabled & fence.polygons) and not _inside_zones(pilot)


def _inside_zones(pilot: SimulatedAutopilot) -> bool:
    """Return whether the zones of its fence permit a vehicle's position."""
    place, corners = pilot.body.position[:2], list[Point]()
    for item in pilot.stores[FENCE]:
        corners.append(pilot.place_of(item)[:2])
        if item.command in CIRCLES:
            within = dist(place, corners.pop()) <= item.params[0]
        elif len(corners) >= item.params[0]:
            within, corners = _surround(corners, place), []
        else:
            continue
        if within != (item.command in INCLUSIONS):
            return False
    return True


def _surround(corners: Sequence[Point], place: Point) -> bool:
    """Return whether a position is inside a polygon: a ray to the east crosses an odd number of edges."""
    crossed = 0
    for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
        if (a[0] > place[0]) != (b[0] > place[0]):
            crossed += place[1] < a[1] + (place[0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
    return crossed % 2 == 1
