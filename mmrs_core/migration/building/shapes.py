"""Borders that hold no area, widened so that what they stand for does not go unnoticed."""

from __future__ import annotations

from math import cos, radians

from shapely.geometry import MultiPoint, Polygon

METRES_PER_DEGREE = 111_320.0
"""Of latitude, on a sphere; good to half a per cent, which a widening does not notice."""
THINNEST = 0.01
"""Metres that a border is wide on average, at least, to hold an area."""

Corner = tuple[float, float]
"""Latitude and longitude in degrees."""


def widened(corners: tuple[Corner, ...], metres: float) -> tuple[Corner, ...] | None:
    """Return the border around corners that hold no area; None if they hold one.

    A point becomes a square, a line a strip with square ends.

    Args:
        corners: at least one.
        metres: how far from the corners the new border runs.
    """
    south, west = corners[0]
    scale = METRES_PER_DEGREE * (cos(radians(south)) or 1.0)
    flat = [((east - west) * scale, (north - south) * METRES_PER_DEGREE) for north, east in corners]
    hull = MultiPoint(flat).minimum_rotated_rectangle
    if len(set(flat)) > 2 and Polygon(flat).area > THINNEST * hull.length / 2:
        return None
    ring = hull.buffer(metres, cap_style="square", join_style="mitre").exterior.coords[:-1]
    return tuple((south + y / METRES_PER_DEGREE, west + x / scale) for x, y in ring)
