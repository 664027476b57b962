"""Growing and shrinking areas by a clearance: Minkowski sums that never fall short.

A circle made of straight pieces is drawn *around* the true one, so that a point outside a grown
area really keeps its distance. Exact distances (`segments`) therefore always agree with "clear",
while up to half a per cent of the clearance may be given away at a corner.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi

import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

Vertex = tuple[float, float]

QUARTER = 8
"""Straight pieces in a quarter of a circle."""

EPSILON = 1e-3
"""Metres added to every clearance, so that rounding can never undercut it."""


def circumscribed(distance: float, quarter: int = QUARTER) -> float:
    """Return the radius whose circle in straight pieces still holds the circle of radius `distance`."""
    return distance / cos(pi / (4 * quarter))


def grow(ring: Sequence[Vertex], distance: float, quarter: int = QUARTER) -> Polygon:
    """Return everything within `distance` metres of a ring's inside, and a little more.

    Holes that close up inside a bent ring are kept: a robot may be there if it can get there.

    Raises:
        ValueError: the distance is negative.
    """
    if distance < 0:
        raise ValueError(f"distance {distance} is negative, areas cannot be grown by it")
    radius = circumscribed(distance * (1 + 1e-9) + EPSILON, quarter)
    grown = shapely.buffer(_valid(ring), radius, quad_segs=quarter)
    return grown if isinstance(grown, Polygon) else shapely.convex_hull(grown)


def shrink(ring: Sequence[Vertex], distance: float, quarter: int = QUARTER) -> BaseGeometry:
    """Return what is inside a ring and at least `distance` metres from its edge; may be empty or many.

    Raises:
        ValueError: the distance is negative.
    """
    if distance < 0:
        raise ValueError(f"distance {distance} is negative, areas cannot be shrunk by it")
    radius = circumscribed(distance * (1 + 1e-9) + EPSILON, quarter)
    return shapely.buffer(_valid(ring), -radius, quad_segs=quarter)


def _valid(ring: Sequence[Vertex]) -> BaseGeometry:
    drawn = Polygon(ring)
    return drawn if drawn.is_valid else shapely.make_valid(drawn)
