"""Borders that hold no area, widened so that what they stand for does not go unnoticed."""

from __future__ import annotations

from math import cos, radians

from shapely.geometry import LineString, Point, Polygon

METRES_PER_DEGREE = 111_320.0
"""Of latitude, on a sphere; good to half a per cent, which a widening does not notice."""

Corner = tuple[float, float]
"""Latitude and longitude in degrees."""


def widened(corners: tuple[Corner, ...], metres: float) -> tuple[Corner, ...] | None:
    """Return the border around corners that hold no area; None if they hold one.

    A point becomes a square, a line a strip with square ends.

    Args:
        corners: at least one.
        metres: how far to each side.
    """
    south, west = corners[0]
    shrink = cos(radians(south)) or 1.0
    flat = [
        ((east - west) * METRES_PER_DEGREE * shrink, (north - south) * METRES_PER_DEGREE)
        for north, east in corners
    ]
    distinct = tuple(dict.fromkeys(flat))
    if len(distinct) > 2 and Polygon(distinct).area > metres * metres:
        return None
    line = Point(distinct[0]) if len(distinct) == 1 else LineString(distinct)
    ring = line.buffer(metres, cap_style="square", join_style="mitre").exterior.coords[:-1]
    return tuple((south + y / METRES_PER_DEGREE, west + x / (METRES_PER_DEGREE * shrink)) for x, y in ring)
