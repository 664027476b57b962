"""Whether a path follows a line from its one end to the other, never farther from it than it may be.

Some part of the path must do so, forwards along the line throughout. That is the decision problem of the
Fréchet distance, for a part of one of the two curves: H. Alt, M. Godau, "Computing the Fréchet distance
between two polygonal curves", International Journal of Computational Geometry & Applications 5 (1995),
sections 2 and 3. Where a piece of the path and one of the line are within reach of each other is convex; so
it is enough to know, along the edges of each such cell, from where to where a robot and its place on the line
can have come. Linear in the pieces of the path times those of the line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, inf, sqrt
from typing import TypeAlias

from mmrs_core.scene import Point, Position

_ROUNDING = 1e-9
"""Metres that are added to distances, so that a path on its very limit is within it."""

Reach: TypeAlias = "tuple[float, float] | None"
"""From where to where, as shares of a piece; None: nowhere."""


@dataclass(frozen=True, slots=True)
class Piece:
    """A straight piece of a path.

    Attributes:
        begin, end: of it.
        move: that it belongs to.
        spread: metres by which the robot may be off it.
    """

    begin: Position
    end: Position
    move: int
    spread: float = 0.0


@dataclass(frozen=True, slots=True)
class Tube:
    """Where a path may be about a line.

    Attributes:
        line: (east, north), two places or more.
        aside: metres to either side of the line.
        low, high: heights, metres above the origin.
    """

    line: tuple[Point, ...]
    aside: float
    low: float = -inf
    high: float = inf

    @property
    def widest(self) -> float:
        """Return the largest spare that any path in it can have, metres."""
        return min(self.aside, (self.high - self.low) / 2.0)

    def follows(self, path: Sequence[Piece], spare: float = 0.0) -> tuple[bool, int]:
        """Return whether a path follows the line at a distance to spare; and the piece that it gets to.

        Args:
            path: pieces, each beginning where the one before ends.
            spare: metres that are left to either side, below and above; negative: that it may be outside.
        """
        entered: list[Reach] = [None] * (len(self.line) - 1)
        farthest, row = 0, -1
        for i, piece in enumerate(path):
            allowed, heights = self._allowed(piece, spare)
            after = self._allowed(path[i + 1], spare) if i + 1 < len(path) else (allowed, (0.0, 1.0))
            below = self._beside(piece, self.line[0], allowed, heights)
            passes = _reaches(heights, 1.0) and _reaches(after[1], 0.0)
            for j in range(len(entered)):
                left = entered[j]
                above = self._beside(piece, self.line[j + 1], allowed, heights)
                if left is not None or below is not None:
                    farthest, row = (i, j) if j >= row else (farthest, row)
                right = self._opposite(piece.end, j, min(allowed, after[0])) if passes else None
                entered[j] = _onwards(right, below, left)
                below = _onwards(above, left, below)
            if below is not None:
                return True, i
        return False, farthest

    def _allowed(self, piece: Piece, spare: float) -> tuple[float, Reach]:
        """Return how far the robot may be from the line on a piece, and where on it the height is right."""
        less = piece.spread + spare
        low, high = self.low + less - _ROUNDING, self.high - less + _ROUNDING
        start, rise = piece.begin[2], piece.end[2] - piece.begin[2]
        if abs(rise) <= _ROUNDING:
            return self.aside - less + _ROUNDING, (0.0, 1.0) if low <= start <= high else None
        ends = sorted(((low - start) / rise, (high - start) / rise))
        first, last = max(0.0, ends[0]), min(1.0, ends[1])
        return self.aside - less + _ROUNDING, (first, last) if first <= last else None

    def _beside(self, piece: Piece, place: Point, allowed: float, heights: Reach) -> Reach:
        """Return where on a piece the robot is near enough to a place of the line."""
        near = _within(piece.begin[:2], piece.end[:2], place, allowed)
        if near is None or heights is None:
            return None
        first, last = max(near[0], heights[0]), min(near[1], heights[1])
        return (first, last) if first <= last else None

    def _opposite(self, place: Position, number: int, allowed: float) -> Reach:
        """Return where on a piece of the line a position is near enough."""
        return _within(self.line[number], self.line[number + 1], place[:2], allowed)


def _reaches(reach: Reach, share: float) -> bool:
    return reach is not None and reach[0] <= share <= reach[1]


def _onwards(free: Reach, across: Reach, along: Reach) -> Reach:
    """Return where one can get on an edge of a cell that is free from where to where.

    Args:
        across: on the edge that meets it where it begins: from there, all of it can be reached.
        along: on the edge opposite: only forwards.
    """
    if free is None or (across is None and along is None):
        return None
    if across is not None or along is None:
        return free
    first = max(free[0], along[0])
    return (first, free[1]) if first <= free[1] else None


def _within(begin: Point, end: Point, centre: Point, radius: float) -> Reach:
    """Return where a straight piece is within a circle."""
    if radius < 0.0:
        return None
    east, north = end[0] - begin[0], end[1] - begin[1]
    off = begin[0] - centre[0], begin[1] - centre[1]
    length = hypot(east, north)
    if length <= _ROUNDING:
        return (0.0, 1.0) if hypot(*off) <= radius else None
    middle = -(off[0] * east + off[1] * north) / length
    aside = abs(off[0] * north - off[1] * east) / length
    if aside > radius:
        return None
    half = sqrt(radius * radius - aside * aside)
    first, last = max(0.0, (middle - half) / length), min(1.0, (middle + half) / length)
    return (first, last) if first <= last else None
