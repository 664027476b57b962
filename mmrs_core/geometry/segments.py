"""Exact distances: straight legs to vertical prisms, and points that move at the same time.

Plain geometry on the shapes as they are drawn. Nothing is grown, buffered or approximated here, so
that a check made with it can disagree with a planner that grows shapes.

A leg is a pair of points (east, north, up) in metres. A prism is a ring times [low, high], where
low may be -inf and high inf.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mmrs_core.geometry.polygons import contains

Floats: TypeAlias = NDArray[np.float64]

_CHUNK = 50_000
"""Pairs of leg and edge that are looked at together: bounds the memory."""


def legs_of(points: ArrayLike) -> Floats:
    """Return the (n - 1, 2, 3) legs of a polyline of n points; a single point is one leg of no length."""
    line = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    if len(line) == 1:
        line = np.repeat(line, 2, axis=0)
    return np.stack([line[:-1], line[1:]], axis=1)


def prism_distance(legs: ArrayLike, ring: ArrayLike, low: float, high: float) -> Floats:
    """Return the distance from each of n legs to a prism, metres; zero where they touch or enter it.

    Exact but for rounding: the square of the distance to one wall of the prism is convex and once
    differentiable along a leg, with a piecewise linear derivative, whose root is found in closed form.

    Args:
        legs: (n, 2, 3).
        ring: (m, 2) vertices, not closed.
        low: height of the lower side.
        high: height of the upper side, not under `low`.
    """
    return nearest_to_prism(legs, ring, low, high)[0]


def nearest_to_prism(legs: ArrayLike, ring: ArrayLike, low: float, high: float) -> tuple[Floats, Floats]:
    """Return the distance of each leg to a prism, and the (n, 3) point of the leg that is nearest."""
    ends = np.asarray(legs, dtype=np.float64).reshape(-1, 2, 3)
    corners = np.asarray(ring, dtype=np.float64).reshape(-1, 2)
    size = max(1, _CHUNK // len(corners))
    halves = [_nearest(ends[i : i + size], corners, low, high) for i in range(0, len(ends), size)]
    if not halves:
        return np.empty(0), np.empty((0, 3))
    return np.concatenate([half[0] for half in halves]), np.concatenate([half[1] for half in halves])


def _nearest(ends: Floats, corners: Floats, low: float, high: float) -> tuple[Floats, Floats]:
    """Compare the walls' distances with that of the lid and the floor over the inside of the ring."""
    begin, way = ends[:, 0], ends[:, 1] - ends[:, 0]
    wall_distance, wall_at = _to_walls(begin, way, corners, low, high)
    lid_distance, lid_at = _to_lids(begin, way, corners, low, high)
    on_lid = lid_distance < wall_distance
    at = np.where(on_lid, lid_at, wall_at)
    return np.where(on_lid, lid_distance, wall_distance), begin + at[:, None] * way


def _to_walls(begin: Floats, way: Floats, corners: Floats, low: float, high: float) -> tuple[Floats, Floats]:
    """Return the least distance to any vertical wall, and where along the leg (0 to 1) it is."""
    wall = np.roll(corners, -1, axis=0) - corners
    length2 = np.maximum((wall**2).sum(axis=1), 1e-300)
    from_corner = begin[:, None, :2] - corners
    along0 = (from_corner * wall).sum(axis=2) / length2
    along1 = (way[:, None, :2] * wall).sum(axis=2) / length2
    height0, height1 = begin[:, 2:], way[:, 2:]
    bends = [_when(along0, along1, 0.0), _when(along0, along1, 1.0)]
    bends += [np.broadcast_to(_when(height0, height1, limit), along0.shape) for limit in (low, high)]
    stops = np.sort(np.stack([np.zeros_like(along0), *bends, np.ones_like(along0)]), axis=0)
    gap = _gap(stops, begin, way, corners, wall, along0, along1, low, high)
    slope = (gap * way[None, :, None, :]).sum(axis=3)
    at = _root(stops, slope)
    gap = _gap(at[None], begin, way, corners, wall, along0, along1, low, high)[0]
    distance = np.sqrt((gap**2).sum(axis=2))
    best = np.argmin(distance, axis=1)
    rows = np.arange(len(begin))
    return distance[rows, best], at[rows, best]


def _when(start: Floats, change: Floats, value: float) -> Floats:
    """Return where in 0..1 a linear function reaches a value; 0 where it never does."""
    with np.errstate(divide="ignore", invalid="ignore"):
        at = (value - start) / change
    return np.clip(np.nan_to_num(at, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0)


def _gap(
    at: Floats,
    begin: Floats,
    way: Floats,
    corners: Floats,
    wall: Floats,
    along0: Floats,
    along1: Floats,
    low: float,
    high: float,
) -> Floats:
    """Return the vector (…, 3) from the nearest point of each wall to the leg's point at `at`."""
    foot = np.clip(along0 + at * along1, 0.0, 1.0)
    place = begin[:, None, :] + at[..., None] * way[:, None, :]
    gap = np.empty_like(place)
    gap[..., :2] = place[..., :2] - corners - foot[..., None] * wall
    gap[..., 2] = place[..., 2] - np.clip(place[..., 2], low, high)
    return gap


def _root(stops: Floats, slope: Floats) -> Floats:
    """Return where a rising, piecewise linear slope given at sorted stops is zero, clipped to 0..1."""
    at = np.where(slope[-1] <= 0.0, 1.0, 0.0)
    for i in range(len(stops) - 1):
        rising = (slope[i] < 0.0) & (slope[i + 1] > 0.0)
        share = -slope[i] / np.where(rising, slope[i + 1] - slope[i], 1.0)
        at = np.where(rising, stops[i] + share * (stops[i + 1] - stops[i]), at)
        at = np.where((slope[i] < 0.0) & (slope[i + 1] == 0.0), stops[i + 1], at)
    return at


def _to_lids(begin: Floats, way: Floats, corners: Floats, low: float, high: float) -> tuple[Floats, Floats]:
    """Return the least vertical distance over the inside of the ring; inf where a leg never is inside.

    Only a leg's ends, and where it passes a lid's height, can be nearest to the inside of a lid: all
    else is nearest at a wall.
    """
    ones = np.ones(len(begin))
    stops = [0.0 * ones, ones, _when(begin[:, 2], way[:, 2], low), _when(begin[:, 2], way[:, 2], high)]
    best, best_at = np.full(len(begin), np.inf), np.zeros(len(begin))
    for at in stops:
        place = begin + at[:, None] * way
        gap = np.abs(place[:, 2] - np.clip(place[:, 2], low, high))
        better = contains(corners, place[:, :2]) & (gap < best)
        best, best_at = np.where(better, gap, best), np.where(better, at, best_at)
    return best, best_at
