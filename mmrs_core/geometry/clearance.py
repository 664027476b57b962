"""Growing and shrinking areas by a clearance: Minkowski sums that never fall short.

The circle is replaced by a regular polygon drawn *around* it, so that a point outside a grown area
really keeps its distance. Exact distances (`segments`) therefore always agree with "clear", while up
to half a per cent of the clearance is given away. A buffer made of arcs would not do: its arcs have
their points on the true circle, and may be cut into pieces longer than asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPoint, Polygon
from shapely.geometry.base import BaseGeometry

Vertex = tuple[float, float]

SIDES = 32
"""Sides of the polygon about the circle."""

EPSILON = 1e-3
"""Metres added to every clearance, so that rounding can never undercut it."""


def circle_about(distance: float) -> NDArray[np.float64]:
    """Return the (SIDES, 2) corners of a regular polygon about the circle of radius `distance`."""
    turns = np.arange(SIDES) * (2 * pi / SIDES)
    return np.column_stack([np.cos(turns), np.sin(turns)]) * (distance / cos(pi / SIDES))


def grow(ring: Sequence[Vertex], distance: float, *, margin: float = EPSILON) -> Polygon:
    """Return everything within `distance` metres of a ring's inside, `margin` metres and a little more.

    Holes that close up inside a bent ring are kept: a robot may be there if it can get there.

    Raises:
        ValueError: the distance is negative, or the ring bounds no area.
    """
    if distance < 0:
        raise ValueError(f"distance {distance} is negative, areas cannot be grown by it")
    grown = shapely.union_all([_valid(ring), *_rim(ring, distance, margin)])
    whole = grown if isinstance(grown, Polygon) else grown.convex_hull
    if not isinstance(whole, Polygon):
        raise ValueError("ring bounds no area, nothing can be grown from it")
    return whole


def shrink(ring: Sequence[Vertex], distance: float) -> BaseGeometry:
    """Return what is inside a ring and at least `distance` metres from its edge; may be empty or many.

    Raises:
        ValueError: the distance is negative.
    """
    if distance < 0:
        raise ValueError(f"distance {distance} is negative, areas cannot be shrunk by it")
    return shapely.difference(_valid(ring), shapely.union_all(_rim(ring, distance, EPSILON)))


def _rim(ring: Sequence[Vertex], distance: float, margin: float) -> list[BaseGeometry]:
    """Return what the circle sweeps along each edge of the ring."""
    corners = np.asarray(ring, dtype=np.float64).reshape(-1, 1, 2)
    swept = corners + circle_about(distance * (1 + 1e-9) + margin)
    return [MultiPoint(np.concatenate([swept[i - 1], swept[i]])).convex_hull for i in range(len(corners))]


def _valid(ring: Sequence[Vertex]) -> BaseGeometry:
    drawn = Polygon(ring)
    return drawn if drawn.is_valid else shapely.make_valid(drawn)
