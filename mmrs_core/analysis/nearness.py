"""On which occupations two robots may be too near to each other at one time: exact, for all of them at once.

The path of an occupation is a row of straight legs. On one that takes p seconds at least, a robot comes to a
share s no earlier than s·p after it may begin, and no later than it must to arrive in time. So two robots
may be at shares s and r of legs that take p and q at one time where s·p − r·q lies between two bounds: a
strip that is cut out of the square of all shares. What they are apart is linear in s and r. So they are
nearest on an edge of the strip, or where the lines of the legs are, if that is inside. Which legs are worth
that test is found with boxes in space and time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray

from mmrs_core.analysis import near_boxes
from mmrs_core.analysis.distance import Floats
from mmrs_core.analysis.occupations import Occupation
from mmrs_core.analysis.verdicts import TOLERANCE
from mmrs_core.geometry.compilation import can_compile, compiled

Indices: TypeAlias = NDArray[np.intp]

_MANY = 20_000
"""Legs from which on compiled loops are worth their import, where they are installed."""

_A_SLICE = 2000
"""Legs that begin in one slice of time, about, where nothing is compiled."""

_INSTANT = 1e-9
"""Seconds that every leg counts as taking at least."""


@dataclass(frozen=True, slots=True)
class Legs:
    """The straight legs of occupations, in the order in which they may begin.

    Attributes:
        of: (n,) number of the occupation.
        robots: (n,) number of the robot.
        ends: (n, 2, 3) of each leg, equal for a stand.
        times: (n, 2) seconds between which the robot may be on it.
        least: (n,) seconds that it takes at least.
        radii: (n,) metres from it within which the robot may be.
    """

    of: Indices
    robots: Indices
    ends: Floats
    times: Floats
    least: Floats
    radii: Floats


def legs_of(occupations: Sequence[Occupation]) -> Legs:
    """Return the legs of occupations."""
    numbers: dict[str, int] = {}
    rows = []
    for of, each in enumerate(occupations):
        robot = numbers.setdefault(each.robot, len(numbers))
        points = each.points if len(each.points) > 1 else each.points * 2
        begin, end = each.begin, each.end - sum(each.least)
        for (a, b), least in zip(pairwise(points), each.least or (0.0,), strict=True):
            end += least
            rows.append((begin, end, least, each.radius, *a, *b, of, robot))
            begin += least
    table = np.array(rows, np.float64).reshape(-1, 12)
    table = table[np.argsort(table[:, 0], kind="stable")]
    of, robots = table[:, 10:].T.astype(np.intp)
    return Legs(of, robots, table[:, 4:10].reshape(-1, 2, 3), table[:, :2], table[:, 2], table[:, 3])


def near_pairs(legs: Legs, needed: float) -> Indices:
    """Return (n, 2), in order: occupations of two robots on which they may be too near at one time.

    Args:
        legs: of the occupations.
        needed: metres that robots must be apart.
    """
    i, j = _overlapping(legs, needed / 2.0)
    near = nearest_at_once(legs, i, j) < needed + legs.radii[i] + legs.radii[j] - TOLERANCE
    one, other = legs.of[i[near]], legs.of[j[near]]
    count = int(legs.of.max(initial=0)) + 1
    codes = np.unique(np.minimum(one, other) * count + np.maximum(one, other))
    return np.column_stack(np.divmod(codes, count))


def nearest_at_once(legs: Legs, i: Indices, j: Indices) -> Floats:
    """Return (n,): metres that the paths of two robots are apart at least where both are at one time.

    Args:
        legs: of all robots.
        i, j: (n,) which, on which two robots may be at one time.
    """
    p, q = np.maximum(legs.least[i], _INSTANT), np.maximum(legs.least[j], _INSTANT)
    low = np.maximum(legs.times[j, 0] - legs.times[i, 1] + p, -q)
    high = np.minimum(legs.times[j, 1] - legs.times[i, 0] - q, p)
    (a, b), (c, d) = (np.ascontiguousarray(legs.ends[each].T).swapaxes(0, 1) for each in (i, j))
    u, v, w = b - a, d - c, a - c

    def apart(s: Floats, r: Floats) -> Floats:
        gap: Floats = w + s * u - r * v
        return gap

    def below(bound: Floats) -> Floats:
        """Return what they are apart where the side of the strip meets that of the square at s or r = 0."""
        return apart(np.maximum(bound, 0.0) / p, np.maximum(-bound, 0.0) / q)

    def above(bound: Floats) -> Floats:
        """Return the same on the side at s or r = 1."""
        return apart(np.minimum((bound + q) / p, 1.0), np.minimum((p - bound) / q, 1.0))

    first, second = np.clip(0.0, low, high), np.clip(p - q, low, high)
    corners = [below(low), below(first), below(high), above(high), above(second), above(low)]
    squares = [_nearest(*edge) for edge in pairwise([*corners, corners[0]])]
    uu, uv, vv, uw, vw = (_dot(*each) for each in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    across = uu * vv - uv * uv
    crossing = across > 0.0
    across[~crossing] = 1.0
    s, r = (uv * vw - vv * uw) / across, (uu * vw - uv * uw) / across
    inside = crossing & (s >= 0.0) & (s <= 1.0) & (r >= 0.0) & (r <= 1.0)
    inside &= (s * p - r * q >= low) & (s * p - r * q <= high)
    squares.append(np.where(inside, _square(apart(s, r)), np.inf))
    nearest: Floats = np.sqrt(np.minimum.reduce(squares))
    return nearest


def _nearest(begin: Floats, end: Floats) -> Floats:
    """Return (n,): the square of the distance of the origin to straight pieces with ends (3, n)."""
    along = end - begin
    length = _square(along)
    share = np.clip(-_dot(begin, along) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
    return _square(begin + share * along)


def _square(a: Floats) -> Floats:
    return _dot(a, a)


def _dot(a: Floats, b: Floats) -> Floats:
    product: Floats = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


def _overlapping(legs: Legs, reach: float) -> tuple[Indices, Indices]:
    """Return pairs of legs, of two robots, whose boxes overlap in space and time, grown by a reach."""
    more = (legs.radii + reach)[:, None]
    low = np.minimum(legs.ends[:, 0], legs.ends[:, 1]) - more
    high = np.maximum(legs.ends[:, 0], legs.ends[:, 1]) + more
    if len(low) < _MANY or not can_compile():
        slices = _slices(legs.robots, low, high, legs.times)
        i, j = np.concatenate([np.empty((2, 0), np.intp), *slices], axis=1)
        return i, j
    cell = 2.0 * max(float(np.sqrt(((high - low)[:, :2] ** 2).sum(axis=1).mean())), TOLERANCE)
    loops = compiled(near_boxes, "overlapping_boxes")
    i, j = loops.overlapping_boxes(legs.robots, low, high, legs.times, cell).T
    return i, j


def _slices(robots: Indices, low: Floats, high: Floats, times: Floats) -> Iterator[Indices]:
    """Yield (2, n) such pairs, slice of time by slice, in that in which the later one of a pair begins.

    An index over all the time would find robots that pass the same place one long after the other.
    """
    for begun in np.array_split(np.arange(len(low)), max(1, len(low) // _A_SLICE)) if len(low) else ():
        present = np.flatnonzero(times[: begun[-1] + 1, 1] > times[begun[0], 0])
        index = shapely.STRtree(np.asarray(shapely.box(*low[present, :2].T, *high[present, :2].T)))
        i, j = index.query(shapely.box(*low[begun, :2].T, *high[begun, :2].T))
        i, j = begun[i], present[j]
        near = (i > j) & (robots[i] != robots[j]) & (times[i, 0] < np.minimum(times[i, 1], times[j, 1]))
        near &= (low[i, 2] < high[j, 2]) & (low[j, 2] < high[i, 2])
        yield np.stack([i[near], j[near]])
