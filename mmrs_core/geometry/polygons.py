"""Rings and polygons in the plane: what is wrong with a ring, its area, what lies in it.

A ring is a sequence of (east, north) vertices in metres, not closed: its last vertex is joined to
its first.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.geometry import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

Vertex = tuple[float, float]

_SAME = 1e-9
"""Metres within which two vertices are one."""


def ring_faults(ring: Sequence[Vertex]) -> tuple[str, ...]:
    """Return what keeps a ring from bounding an area, in words; empty for a sound one."""
    corners = np.asarray(ring, dtype=np.float64).reshape(-1, 2)
    if not np.isfinite(corners).all():
        return ("has a vertex that is not a finite number",)
    faults = []
    steps = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    repeated = np.flatnonzero(steps <= _SAME)
    if len(corners) > 1 and repeated.size:
        faults.append(f"repeats point {_next(int(repeated[0]), len(corners))}")
    distinct = len({(round(x / _SAME), round(y / _SAME)) for x, y in corners.tolist()})
    if distinct < 3:
        return (*faults, f"has {distinct} distinct points, at least 3 are needed")
    sound = corners[steps > _SAME]
    if _collinear(sound):
        return (*faults, "has no area")
    if not shapely.LinearRing(sound).is_simple:
        faults.append("crosses or touches itself")
    return tuple(faults)


def _collinear(corners: NDArray[np.float64]) -> bool:
    """Return whether all vertices lie on one line (a ring that crosses itself may have area zero too)."""
    hull = shapely.MultiPoint(corners).convex_hull
    return bool(hull.area <= _SAME * hull.length)


def _next(index: int, count: int) -> int:
    return (index + 1) % count


def contains(ring: ArrayLike, points: ArrayLike) -> NDArray[np.bool_]:
    """Return which of the (n, 2) points lie inside a ring; on its edge they may count either way.

    Even-odd rule by crossing number; O(n · vertices).
    """
    corners = np.asarray(ring, dtype=np.float64).reshape(-1, 2)
    queries = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    ax, ay = corners.T
    bx, by = np.roll(corners, -1, axis=0).T
    x, y = queries[:, :1], queries[:, 1:]
    straddles = (ay > y) != (by > y)
    rise = np.where(by == ay, 1.0, by - ay)
    crossing = ax + (y - ay) * (bx - ax) / rise
    inside: NDArray[np.bool_] = np.count_nonzero(straddles & (x < crossing), axis=1) % 2 == 1
    return inside


def polygon(shell: Sequence[Vertex]) -> Polygon:
    """Return the shapely polygon of a ring.

    Raises:
        ValueError: the ring is unsound (see `ring_faults`).
    """
    faults = ring_faults(shell)
    if faults:
        raise ValueError(f"ring {faults[0]}")
    return Polygon(shell)


def less(shell: Sequence[Vertex], taken: Iterable[BaseGeometry]) -> tuple[Polygon, ...]:
    """Return the parts of a shell that are left when geometries are taken away, largest first."""
    return parts(shapely.difference(polygon(shell), shapely.union_all(list(taken))))


def parts(geometry: BaseGeometry, smallest: float = 0.0) -> tuple[Polygon, ...]:
    """Return the polygons of a geometry that are larger than `smallest` square metres, largest first."""
    pieces = shapely.get_parts(geometry) if not isinstance(geometry, Polygon) else [geometry]
    flat = [
        piece
        for part in pieces
        for piece in (part.geoms if isinstance(part, MultiPolygon) else [part])
        if isinstance(piece, Polygon) and piece.area > smallest
    ]
    return tuple(sorted(flat, key=lambda piece: (-piece.area, piece.bounds)))


def rings(piece: Polygon) -> tuple[tuple[Vertex, ...], tuple[tuple[Vertex, ...], ...]]:
    """Return a polygon's shell and holes as rings."""
    return _ring(piece.exterior), tuple(_ring(hole) for hole in piece.interiors)


def _ring(closed: BaseGeometry) -> tuple[Vertex, ...]:
    return tuple((float(x), float(y)) for x, y in shapely.get_coordinates(closed)[:-1])


def band(line: Sequence[Vertex], width: float) -> tuple[tuple[tuple[Vertex, ...], ...], ...]:
    """Return the rings of each part of what lies between two parallels of a line, at its ends cut off.

    >>> band([(0.0, 0.0), (10.0, 0.0)], 4.0)
    ((((10.0, 2.0), (10.0, -2.0), (0.0, -2.0), (0.0, 2.0)),),)
    """
    between = shapely.LineString(line).buffer(width / 2.0, cap_style="flat", join_style="mitre")
    return tuple((rings(piece)[0], *rings(piece)[1]) for piece in parts(between))
