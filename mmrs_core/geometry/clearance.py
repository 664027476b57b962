"""Growing and shrinking areas by a clearance: Minkowski sums that never fall short.

The circle is replaced by a regular polygon drawn *around* it, so that a point outside a grown area
really keeps its distance. Exact distances (`segments`) therefore always agree with "clear", while up
to half a per cent of the clearance is given away. A buffer made of arcs would not do: its arcs have
their points on the true circle, and may be cut into pieces longer than asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPoint, Polygon
from shapely.geometry.base import BaseGeometry

Vertex = tuple[float, float]
Floats: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.intp]
Flags: TypeAlias = NDArray[np.bool_]

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


def grow_all(
    rings: Sequence[Sequence[Vertex]], distances: Sequence[float], *, margin: float = EPSILON
) -> NDArray[np.object_]:
    """Return what `grow` returns for each of many rings, most at once.

    Each edge is moved by the circle's corner that is furthest out. Where the ring turns left, corners of
    the circle come in between; where it turns right, moved edges end where they meet: the trimmed
    convolution of Guibas, Ramshaw and Stolfi (1983). It is the outline of the sum wherever it turns once,
    each edge keeps its direction and none crosses another; other rings are grown one by one.
    """
    found = np.full(len(rings), None, dtype=np.object_)
    fit = np.array([len(r) > 2 and d >= 0.0 for r, d in zip(rings, distances, strict=True)], dtype=np.bool_)
    if fit.any():
        chosen = np.flatnonzero(fit)
        reach = np.asarray(distances, dtype=np.float64)[chosen] * (1 + 1e-9) + margin
        found[chosen] = _outlines([np.asarray(rings[i], dtype=np.float64) for i in chosen.tolist()], reach)
    for i, shape in enumerate(found):
        if shape is None:
            found[i] = grow(rings[i], distances[i], margin=margin)
    return found


def _outlines(rings: Sequence[Floats], reach: Floats) -> NDArray[np.object_]:
    """Return the trimmed convolution of each ring with its circle; None where it can't be relied on."""
    corners, ring, before, after = _leftward(rings)
    edge = corners[after] - corners
    outward = np.rint(np.arctan2(-edge[:, 0], edge[:, 1]) * (SIDES / (2 * pi))).astype(np.intp)
    come = edge[before]
    across = come[:, 0] * edge[:, 1] - come[:, 1] * edge[:, 0]
    right = across < 0.0
    turn = (outward - outward[before]) % SIDES
    steps = np.where(right, 0, turn)
    at = np.repeat(np.arange(len(corners)), steps + 1)
    first = np.cumsum(steps + 1) - steps - 1
    step = np.arange(len(at)) - first[at]
    circle = circle_about(1.0)
    moved = corners[at] + circle[(outward[before][at] + step) % SIDES] * reach[ring[at], None]
    met = np.flatnonzero(right & (turn != 0))
    aside = (circle[outward[met] % SIDES] - circle[outward[before][met] % SIDES]) * reach[ring[met], None]
    along = (aside[:, 0] * edge[met, 1] - aside[:, 1] * edge[met, 0]) / across[met]
    moved[first[met]] += along[:, None] * come[met]
    kept = ((moved[first[after]] - moved[first + steps]) * edge).sum(axis=1) > 0.0
    signed = np.where(right, -((-turn) % SIDES), turn)
    count = len(rings)
    sound = (np.bincount(ring, ~kept, count) == 0) & (np.bincount(ring, signed, count) == SIDES)
    sound &= np.bincount(ring, np.abs(signed) > SIDES // 2, count) == 0
    shapes: NDArray[np.object_] = shapely.polygons(shapely.linearrings(moved, indices=ring[at]))
    bent = np.flatnonzero(sound & (np.bincount(ring, right, count) > 0)).tolist()
    sound[bent] = [Polygon(rings[i]).is_valid and shapely.is_valid(shapes[i]) for i in bent]
    shapes[~sound] = None
    return shapes


def _leftward(rings: Sequence[Floats]) -> tuple[Floats, Indices, Indices, Indices]:
    """Return the corners of rings that turn left, each one's ring, and the corners before and after it."""
    counts = np.array([len(ring) for ring in rings])
    ring = np.repeat(np.arange(len(rings)), counts)
    first = np.cumsum(counts) - counts
    here = np.arange(len(ring))
    after = here + 1
    after[first + counts - 1] = first
    before = np.empty_like(after)
    before[after] = here
    corners = np.concatenate(rings)
    x, y = corners.T
    left = np.bincount(ring, x * y[after] - x[after] * y) >= 0.0
    backwards = (2 * first + counts - 1)[ring] - here
    return corners[np.where(left[ring], here, backwards)], ring, before, after


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
