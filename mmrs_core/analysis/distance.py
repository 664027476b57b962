"""Exact distances between straight legs and vertical prisms, for the verifier alone.

The distance of a leg to a prism is the smallest of: the distances to the edges of its lid and floor;
in plan, that of the part of the leg between floor and lid to the sides; and, where the leg is above or
below the polygon, the heights at its ends and where it enters and leaves the slab between floor and
lid. Between these places the vertical distance is linear, so nothing is missed.
"""

from __future__ import annotations

from math import sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.scene import Position, Ring

Floats: TypeAlias = NDArray[np.float64]
Flags: TypeAlias = NDArray[np.bool_]

_PAIRS = 100_000
"""MovePath-edge pairs that are looked at in one go; bounds the memory, not the result."""


def prism_distances(begins: Floats, ends: Floats, shell: Ring, low: float, high: float) -> Floats:
    """Return the distance of each of n legs to a prism, metres; 0 where they touch or enter it.

    Args:
        begins: (n, 3) east, north, up.
        ends: (n, 3).
        shell: simple polygon, not closed, either way round.
        low: lower side of the prism; may be -inf.
        high: upper side; may be inf.
    """
    corners = np.asarray(shell, dtype=np.float64)
    step = max(1, _PAIRS // len(corners))
    parts = [
        _prism_distances(begins[i : i + step], ends[i : i + step], corners, low, high)
        for i in range(0, len(begins), step)
    ]
    return np.concatenate(parts) if parts else np.empty(0)


def _prism_distances(begins: Floats, ends: Floats, corners: Floats, low: float, high: float) -> Floats:
    enter, leave = _inside_slab(begins[:, 2], ends[:, 2], low, high)
    best = _side_distances(begins, ends, enter, leave, corners)
    for height in (low, high):
        if np.isfinite(height):
            best = np.minimum(best, _rim_distances(begins, ends, corners, height))
    for part in (np.zeros(len(begins)), np.ones(len(begins)), enter, leave):
        points = _along(begins, ends, np.clip(part, 0.0, 1.0))
        heights = np.maximum(np.maximum(low - points[:, 2], points[:, 2] - high), 0.0)
        over = contains(corners, points[:, :2])
        best = np.where(over, np.minimum(best, heights), best)
    return best


def _inside_slab(begin: Floats, end: Floats, low: float, high: float) -> tuple[Floats, Floats]:
    """Return between which parts of each leg it is in [low, high]; the first exceeds the second if never."""
    rise = end - begin
    level = rise == 0.0
    slope = np.where(level, 1.0, rise)
    first, second = (low - begin) / slope, (high - begin) / slope
    enter = np.maximum(np.minimum(first, second), 0.0)
    leave = np.minimum(np.maximum(first, second), 1.0)
    inside = (begin >= low) & (begin <= high)
    enter = np.where(level, np.where(inside, 0.0, 1.0), enter)
    leave = np.where(level, np.where(inside, 1.0, 0.0), leave)
    return enter, leave


def _side_distances(begins: Floats, ends: Floats, enter: Floats, leave: Floats, corners: Floats) -> Floats:
    """Return, in plan, the distance to the sides of what is between floor and lid; inf if nothing is."""
    never = enter > leave
    first = _along(begins, ends, np.where(never, 0.0, enter))
    last = _along(begins, ends, np.where(never, 0.0, leave))
    first[:, 2] = last[:, 2] = 0.0
    return np.where(never, np.inf, _rim_distances(first, last, corners, 0.0))


def _rim_distances(begins: Floats, ends: Floats, corners: Floats, height: float) -> Floats:
    """Return the distance of each leg to the border of the polygon drawn at one height."""
    rim = np.column_stack([corners, np.full(len(corners), height)])
    nearest: Floats = segment_distances(begins, ends, rim, np.roll(rim, -1, axis=0)).min(axis=1)
    return nearest


def segment_distances(p: Floats, q: Floats, c: Floats, d: Floats) -> Floats:
    """Return the (n, m) distances between the segments p-q, each (n, 3), and c-d, each (m, 3)."""
    return paired_distances(p[:, None, :], q[:, None, :], c[None, :, :], d[None, :, :])


def paired_distances(p: Floats, q: Floats, c: Floats, d: Floats) -> Floats:
    """Return the distances between the segments p-q and c-d, pair by pair; arrays of (..., 3).

    The smallest of the distances of the four ends to the other segment and of the two lines, where
    these come nearest within both; so only crossings need the system of two equations solved.
    """
    u, v, w = q - p, d - c, p - c
    uu, uv, vv, uw, vw = np.broadcast_arrays(_dot(u, u), _dot(u, v), _dot(v, v), _dot(u, w), _dot(v, w))
    determinant = uu * vv - uv * uv
    zero, one = np.zeros_like(uu), np.ones_like(uu)
    candidates = (
        (_part(uv * vw - vv * uw, determinant), _part(uu * vw - uv * uw, determinant)),
        (zero, _part(vw, vv)),
        (one, _part(vw + uv, vv)),
        (_part(-uw, uu), zero),
        (_part(uv - uw, uu), one),
    )
    squares = [_square(w + s[..., None] * u - t[..., None] * v) for s, t in candidates]
    nearest: Floats = np.sqrt(np.minimum.reduce(squares))
    return nearest


def segment_distance(p: Position, q: Position, c: Position, d: Position) -> float:
    """Return the distance between two segments as `paired_distances` does, without its cost for one pair."""
    u, v, w = _minus(q, p), _minus(d, c), _minus(p, c)
    uu, uv, vv, uw, vw = _inner(u, u), _inner(u, v), _inner(v, v), _inner(u, w), _inner(v, w)
    determinant = uu * vv - uv * uv
    candidates = (
        (_ratio(uv * vw - vv * uw, determinant), _ratio(uu * vw - uv * uw, determinant)),
        (0.0, _ratio(vw, vv)),
        (1.0, _ratio(vw + uv, vv)),
        (_ratio(-uw, uu), 0.0),
        (_ratio(uv - uw, uu), 1.0),
    )
    return sqrt(
        min(
            (w[0] + s * u[0] - t * v[0]) ** 2
            + (w[1] + s * u[1] - t * v[1]) ** 2
            + (w[2] + s * u[2] - t * v[2]) ** 2
            for s, t in candidates
        )
    )


def _minus(a: Position, b: Position) -> Position:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _inner(a: Position, b: Position) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _ratio(a: float, b: float) -> float:
    return min(1.0, max(0.0, a / b)) if b > 0.0 else 0.0


def contains(corners: Floats, points: Floats) -> Flags:
    """Return for each of n points (east, north) whether it is inside a polygon; either on the border."""
    x, y = points[:, 0][:, None], points[:, 1][:, None]
    ax, ay = corners[:, 0], corners[:, 1]
    bx, by = np.roll(ax, -1), np.roll(ay, -1)
    straddles = (ay > y) != (by > y)
    crossing = ax + (y - ay) * (bx - ax) / np.where(by == ay, 1.0, by - ay)
    inside: Flags = (np.count_nonzero(straddles & (x < crossing), axis=1) % 2).astype(bool)
    return inside


def _along(begins: Floats, ends: Floats, part: Floats) -> Floats:
    points: Floats = begins + part[:, None] * (ends - begins)
    return points


def _dot(a: Floats, b: Floats) -> Floats:
    product: Floats = np.sum(a * b, axis=-1)
    return product


def _square(a: Floats) -> Floats:
    return _dot(a, a)


def _part(a: Floats, b: Floats) -> Floats:
    """Return a / b within 0 and 1, and 0 where b is not positive: no length, or parallel segments."""
    quotient = np.divide(a, b, out=np.zeros_like(a), where=b > 0.0)
    part: Floats = np.clip(quotient, 0.0, 1.0)
    return part
