"""Routes for robots that steer like cars: legs around corners are as long as their turning circle is wide.

A grown area has round corners of many short sides. A robot that turns on the spot follows them side by
side. One that needs room to turn would have to shunt at each of them, and its autopilot cannot get to the end
of a leg that begins beside it and is shorter than its turning circle is wide. So two neighbouring
corners that turn the same way are replaced by the one where their outer legs meet, which lies outside.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import atan2, dist, pi

from mmrs_core.scene import Position

SHARPEST = pi / 2
"""Turn of a corner, radians, beyond which two are left as they are: the route would go far around."""

SMALL = 1e-9


def with_fewer_corners(
    route: Sequence[Position], least: float, is_clear: Callable[[Sequence[Position]], bool]
) -> tuple[Position, ...]:
    """Return a route in which legs between two corners are as long as can be had without a sharper corner.

    Args:
        route: two positions or more.
        least: metres that a leg between two corners should have.
        is_clear: whether a polyline keeps clear of everything.
    """
    found = tuple(route)
    while (next_one := _with_one_fewer(found, least, is_clear)) is not None:
        found = next_one
    return found


def _with_one_fewer(
    route: tuple[Position, ...], least: float, is_clear: Callable[[Sequence[Position]], bool]
) -> tuple[Position, ...] | None:
    """Return the route without the shortest leg that is too short and can be left out; None: none can."""
    lengths = [dist(a, b) for a, b in pairwise(route)]
    short = [index for index in range(1, len(lengths) - 1) if lengths[index] < least]
    for index in sorted(short, key=lambda each: lengths[each]):
        before, one, two, after = route[index - 1 : index + 3]
        corner = _meeting(before, one, two, after)
        if corner is not None and is_clear((before, corner, after)):
            return (*route[:index], corner, *route[index + 2 :])
    return None


def _meeting(before: Position, one: Position, two: Position, after: Position) -> Position | None:
    """Return where the legs to and from a short leg meet beyond it, on one level; None: they do not."""
    if not before[2] == one[2] == two[2] == after[2]:
        return None
    first, second = _turn(before, one, two), _turn(one, two, after)
    if first * second < 0.0 or abs(first + second) > SHARPEST + SMALL:
        return None
    (east, north), (east_on, north_on) = _heading(before, one), _heading(two, after)
    across = east * north_on - north * east_on
    if abs(across) < SMALL:
        return None
    ahead = ((two[0] - one[0]) * north_on - (two[1] - one[1]) * east_on) / across
    return (one[0] + ahead * east, one[1] + ahead * north, one[2]) if ahead >= 0.0 else None


def _heading(start: Position, end: Position) -> tuple[float, float]:
    return end[0] - start[0], end[1] - start[1]


def _turn(start: Position, corner: Position, end: Position) -> float:
    """Return by how many radians the route turns at a corner, to the left."""
    (a, b), (c, d) = _heading(start, corner), _heading(corner, end)
    return atan2(a * d - b * c, a * c + b * d)
