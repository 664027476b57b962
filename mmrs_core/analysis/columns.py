"""The columns over the homes of robots, in which neighbours at home are not kept away from.

Homes may be nearer to each other than robots must keep in flight. Robots that stand at such homes are
excused, and so is one that rises or descends straight over its own while the other stands at its own,
as long as they are no nearer to each other than their homes are.
Nothing else is: neither two that rise side by side, nor one that comes to another's home, nor any two
whose homes are at one place.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import dist, hypot, inf

from mmrs_core.scene import Position

HOME_SPOT = 0.1
"""Metres from its home within which a robot stands there, from the axis of its column within which it is
in it, and from each other within which two homes are one place."""


@dataclass(frozen=True, slots=True)
class Column:
    """What is straight over a robot's home, up to the transit height.

    Attributes:
        home: the foot.
        ceiling: the lowest height at which the robot enters or leaves the column sideways; inf if it
            never does.
    """

    home: Position
    ceiling: float

    def at_foot(self, place: Position) -> bool:
        """Return whether a robot that stands there stands at its home."""
        return dist(place, self.home) <= HOME_SPOT

    def contains(self, points: Iterable[Position]) -> bool:
        """Return whether a path is straight over the home, at whatever height."""
        return all(self._aside(point) <= HOME_SPOT for point in points)

    def above_ceiling(self, points: tuple[Position, ...]) -> tuple[Position, ...]:
        """Return the part above the ceiling of a path in the column; empty if there is none.

        At the transit height itself a path is still below.
        """
        highest = max(point[2] for point in points)
        if highest <= self.ceiling:
            return ()
        lowest = max(self.ceiling, min(point[2] for point in points))
        return tuple((points[0][0], points[0][1], height) for height in (lowest, highest))

    def _aside(self, point: Position) -> float:
        return hypot(point[0] - self.home[0], point[1] - self.home[1])


def column_over(home: Position, paths: Iterable[tuple[Position, ...]]) -> Column:
    """Return the column over a home, up to the lowest height at which one of the paths crosses its side."""
    column = Column(home, inf)
    crossings = (
        _lowest_near_axis(home, a, b)
        for path in paths
        for a, b in pairwise(path)
        if not column.contains((a, b))
    )
    return Column(home, min(crossings, default=inf))


def _lowest_near_axis(home: Position, a: Position, b: Position) -> float:
    """Return the least height of a leg within the column; inf if it does not come into it."""
    east, north = a[0] - home[0], a[1] - home[1]
    along = (b[0] - a[0], b[1] - a[1])
    square = along[0] ** 2 + along[1] ** 2
    if square == 0.0:
        return min(a[2], b[2]) if hypot(east, north) <= HOME_SPOT else inf
    middle = -(east * along[0] + north * along[1]) / square
    aside = HOME_SPOT**2 - (east + middle * along[0]) ** 2 - (north + middle * along[1]) ** 2
    if aside < 0.0:
        return inf
    half = (aside / square) ** 0.5
    first, last = max(0.0, middle - half), min(1.0, middle + half)
    return min(a[2] + part * (b[2] - a[2]) for part in (first, last)) if first <= last else inf
