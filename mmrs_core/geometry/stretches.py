"""Stretches of a polyline: which of it is too near to a prism, and the points of a part of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import accumulate, pairwise
from math import dist, inf, isclose

import numpy as np
import shapely
from shapely.geometry import LineString
from shapely.geometry.base import BaseGeometry

from mmrs_core.geometry.segments import legs_of, prism_distance

Place = tuple[float, float, float]
Vertex = tuple[float, float]
Stretch = tuple[float, float]

LEAST = 1.0
"""Metres that a part of an interrupted line has at least: for less, no robot goes around an obstacle."""

_EXACT = 1e-6
"""Metres by which a distance may fall short because numbers are rounded."""


def blocked_stretches(
    line: Sequence[Place],
    ring: Sequence[Vertex],
    low: float,
    high: float,
    keep: float,
    grow: Callable[[Sequence[Vertex], float], BaseGeometry],
) -> list[Stretch]:
    """Return from where to where along a polyline it comes nearer to a prism than `keep` metres.

    Legs that keep their distance exactly are not cut. Others are cut at what `grow` makes of the prism,
    which should reach a little further than `keep` where a robot is to follow what is left.

    Args:
        line: at least one point.
        ring: of the prism. low, high: its heights.
        keep: metres.
        grow: returns all that is within a distance of a ring's inside.

    Returns:
        (begin, end) in metres from the first point, ascending, merged.
    """
    near = np.flatnonzero(prism_distance(legs_of(line), ring, low, high) < keep - _EXACT)
    if not len(near):
        return []
    if len(line) == 1:
        return [(0.0, 0.0)]
    arcs, grown = _arcs(line), grow(ring, keep)
    found = (
        (arcs[leg] + begin * (arcs[leg + 1] - arcs[leg]), arcs[leg] + end * (arcs[leg + 1] - arcs[leg]))
        for leg in near.tolist()
        for begin, end in _shares(line[leg], line[leg + 1], grown, low - keep, high + keep)
    )
    return merged(found)


def merged(stretches: Iterable[Stretch]) -> list[Stretch]:
    """Return stretches in order, with those that touch made one.

    >>> merged([(3.0, 5.0), (0.0, 1.0), (4.0, 6.0)])
    [(0.0, 1.0), (3.0, 6.0)]
    """
    found: list[Stretch] = []
    for begin, end in sorted(stretches):
        if found and begin <= found[-1][1] + _EXACT:
            found[-1] = (found[-1][0], max(found[-1][1], end))
        else:
            found.append((begin, end))
    return found


def open_stretches(
    blocked: Iterable[Iterable[Stretch]], length: float, least: float = LEAST
) -> list[Stretch]:
    """Return what blocked stretches leave of a line; parts shorter than `least` only of a line without any.

    >>> open_stretches([[(0.5, 3.0)], [(2.0, 6.0)]], 10.0)
    [(6.0, 10.0)]
    """
    closed = merged(each for stretches in blocked for each in stretches)
    if not closed:
        return [(0.0, length)]
    return [(begin, end) for begin, end in between(closed, length) if end - begin >= least]


def between(stretches: Sequence[Stretch], length: float) -> list[Stretch]:
    """Return what merged stretches leave of a length.

    >>> between([(0.0, 1.0), (3.0, 6.0)], 10.0)
    [(1.0, 3.0), (6.0, 10.0)]
    """
    ends = [0.0, *(each for stretch in stretches for each in stretch), length]
    pairs = zip(ends[::2], ends[1::2], strict=True)
    return [(begin, end) for begin, end in pairs if end > begin + _EXACT]


def part_of(line: Sequence[Place], begin: float, end: float) -> tuple[Place, ...]:
    """Return the points of a polyline from one arc length to another.

    >>> part_of(((0.0, 0.0, 1.0), (10.0, 0.0, 1.0), (10.0, 10.0, 1.0)), 5.0, 15.0)
    ((5.0, 0.0, 1.0), (10.0, 0.0, 1.0), (10.0, 5.0, 1.0))
    """
    arcs = _arcs(line)
    inside = (point for point, arc in zip(line, arcs, strict=True) if begin + _EXACT < arc < end - _EXACT)
    return (point_at(line, begin), *inside, point_at(line, end))


def point_at(line: Sequence[Place], arc: float) -> Place:
    """Return the point of a polyline `arc` metres after its first point."""
    arcs = _arcs(line)
    east, north, up = (float(np.interp(arc, arcs, axis)) for axis in zip(*line, strict=True))
    return (east, north, up)


def _arcs(line: Sequence[Place]) -> list[float]:
    return [0.0, *accumulate(dist(a, b) for a, b in pairwise(line))]


def _shares(begin: Place, end: Place, grown: BaseGeometry, low: float, high: float) -> Iterator[Stretch]:
    """Yield from which to which share of a leg, 0 to 1, it is inside a grown prism."""
    first, last = _between_heights(begin[2], end[2], low, high)
    if first >= last:
        return
    from_, to = (
        (begin[0] + share * (end[0] - begin[0]), begin[1] + share * (end[1] - begin[1]))
        for share in (first, last)
    )
    if dist(from_, to) <= _EXACT:
        if grown.covers(shapely.Point(from_)):
            yield first, last
        return
    leg = LineString([from_, to])
    for part in shapely.get_parts(shapely.intersection(leg, grown)):
        if part.length > 0.0:
            at = sorted(shapely.line_locate_point(leg, shapely.points(part.coords)).tolist())
            yield tuple(first + each / leg.length * (last - first) for each in (at[0], at[-1]))


def _between_heights(begin: float, end: float, low: float, high: float) -> Stretch:
    """Return from which to which share of a leg its height is between two others."""
    if isclose(begin, end, abs_tol=_EXACT):
        return (0.0, 1.0) if low < begin < high else (0.0, 0.0)
    shares = sorted(
        (limit - begin) / (end - begin)
        if abs(limit) < inf
        else inf * (1 if (limit > 0) == (end > begin) else -1)
        for limit in (low, high)
    )
    return max(0.0, shares[0]), min(1.0, shares[1])
