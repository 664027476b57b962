"""Points in an emergency area: one for each robot, since all may have to come down at once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mmrs_core.geometry.clearance import Vertex, grow, shrink

Kept = tuple[tuple[Vertex, ...], float]
"""A ring, and the metres that robots keep from it on the outside, too."""

_PER_SIDE = 48
"""Candidates along each side of the box about an area, at most."""

_FINENESS = 4.0
"""Candidates along the least distance between two points."""


def refuge_points(
    ring: Sequence[Vertex], keep: float, apart: float, count: int, barred: Sequence[Kept] = ()
) -> tuple[Vertex, ...]:
    """Return points inside a ring, as far apart as there is room; fewer than `count` where it has none.

    Args:
        ring: of the area.
        keep: metres from the edge to every point, at least.
        apart: metres between two points, at least.
        count: how many are wanted; the first one does not depend on it.
        barred: what no point may be in, nor nearer to.
    """
    return _points(tuple(ring), keep, apart, count, tuple(barred))


@lru_cache(maxsize=64)
def _points(
    ring: tuple[Vertex, ...], keep: float, apart: float, count: int, barred: tuple[Kept, ...]
) -> tuple[Vertex, ...]:
    """Return them, once for all robots of a fleet."""
    free = shrink(ring, keep).difference(shapely.union_all([grow(*each) for each in barred]))
    parts = [part for part in _parts(free) if part.area > 0]
    if not parts or count < 1:
        return ()
    inside = max(parts, key=lambda part: float(part.area))
    first = inside.representative_point()
    found = [(float(first.x), float(first.y))]
    places = _candidates(inside, apart) if count > 1 else np.empty((0, 2))
    away = _distances(places, found[0])
    while len(found) < count and away.size and away.max() >= apart:
        east, north = places[int(away.argmax())].tolist()
        found.append((east, north))
        away = np.minimum(away, _distances(places, found[-1]))
    return tuple(found)


def _parts(shape: BaseGeometry) -> list[BaseGeometry]:
    return list(getattr(shape, "geoms", [shape]))


def _candidates(inside: BaseGeometry, apart: float) -> NDArray[np.float64]:
    """Return (n, 2) corners of the shape and points of a grid over it that lie in it."""
    west, south, east, north = inside.bounds
    step = max(apart / _FINENESS, max(east - west, north - south) / _PER_SIDE, 1e-3)
    grid = np.meshgrid(np.arange(west, east + step, step), np.arange(south, north + step, step))
    points = np.column_stack([each.ravel() for each in grid])
    within = points[shapely.contains_xy(inside, points[:, 0], points[:, 1])]
    return np.concatenate([shapely.get_coordinates(inside), within])


def _distances(places: NDArray[np.float64], point: Vertex) -> NDArray[np.float64]:
    found: NDArray[np.float64] = np.hypot(places[:, 0] - point[0], places[:, 1] - point[1])
    return found
