"""Finds the ground that a stroke of work covers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import dist, hypot

from mmrs_core.scene import Coverage, Point, Position, Ring, Stroke

_NORTH = (0.0, 1.0)


def footprints(stroke: Stroke, coverage: Coverage) -> Iterator[Ring]:
    """Yield rectangles that a stroke covers, all turning the same way.

    Where one action covers a length of ground, these are the footprints of the actions; elsewhere
    they are strips along the legs.
    """
    if coverage.length > 0 and stroke.actions:
        for action in stroke.actions:
            at, heading = along(stroke.points, action.at)
            yield _rectangle(at, heading, coverage.length / 2, coverage.width / 2)
        return
    for start, end in pairwise(stroke.points):
        half = dist(start[:2], end[:2]) / 2
        if half > 0:
            middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2, start[2])
            yield _rectangle(middle, _direction(start, end), half, coverage.width / 2)


def along(points: Sequence[Position], at: float) -> tuple[Position, Point]:
    """Return the position at an arc length and the direction of travel there, as a unit vector.

    Beyond the ends, these are the ends'; a way that only climbs is taken to head north.

    >>> along([(0, 0, 0), (10, 0, 0)], 4.0)
    ((4.0, 0.0, 0.0), (1.0, 0.0))
    """
    left, heading = max(at, 0.0), _NORTH
    for start, end in pairwise(points):
        leg = dist(start, end)
        heading = _direction(start, end) if dist(start[:2], end[:2]) > 0 else heading
        if left <= leg and leg > 0:
            part = left / leg
            east, north, up = (a + part * (b - a) for a, b in zip(start, end, strict=True))
            return (east, north, up), heading
        left -= leg
    return points[-1], heading


def _direction(start: Position, end: Position) -> Point:
    east, north = end[0] - start[0], end[1] - start[1]
    length = hypot(east, north)
    return east / length, north / length


def _rectangle(middle: Position, heading: Point, ahead: float, aside: float) -> Ring:
    (x, y), (east, north) = middle[:2], heading
    corners = ((ahead, aside), (-ahead, aside), (-ahead, -aside), (ahead, -aside))
    return tuple((x + a * east - b * north, y + a * north + b * east) for a, b in corners)
