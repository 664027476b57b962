"""Routes of straight legs around, over and under what a robot must keep away from."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from copy import copy
from itertools import pairwise
from math import dist, inf
from typing import Any

import numpy as np

from mmrs_core.errors import UnreachableError
from mmrs_core.geometry.clearance import EPSILON
from mmrs_core.geometry.segments import legs_of
from mmrs_core.planning.curves import with_fewer_corners
from mmrs_core.planning.layers import Layers
from mmrs_core.planning.obstacles import Flags, Floats, Obstacles
from mmrs_core.planning.reach import Reach
from mmrs_core.planning.visibility import Visibility
from mmrs_core.scene import Area, Position
from mmrs_core.scene.timing import Rates

_ABOVE = 1e-3
"""Metres that a height is above or below what an area blocks."""

_HEIGHTS = 5
"""Heights at most that are tried beside those of start and goal."""


class Space:
    """The space of one robot, made once and asked often; it remembers what it found out.

    A straight leg is the answer where it is clear. Else the robot goes up or down to one height, on
    the shortest path around all that blocks there, and up or down to the goal; the quickest of several
    heights is taken. Where no single height will do, a search over several heights follows. At last,
    corners are cut by sloped legs where these are clear and quicker.

    Attributes:
        reach: where the robot is in range of its radio; None: everywhere.
        anywhere: the same space of a robot whose radio need not be in range.
        remembered: what robots that are alike have found out together.
    """

    def __init__(
        self,
        areas: Iterable[Area],
        clearance: float,
        floor: float = -inf,
        ceiling: float = inf,
        *,
        rates: Rates | None = None,
        turning_radius: float = 0.0,
    ) -> None:
        """Grow the areas.

        Args:
            areas: to keep away from, as drawn.
            clearance: of the robot, metres; each area's safety distance comes on top.
            floor: lowest height at which the robot travels, metres.
            ceiling: highest height, metres.
            rates: of travel, which decide between going around and going over; None: 1 m/s each.
            turning_radius: of the robot's narrowest curve, metres; 0: it turns on the spot.
        """
        self.floor, self.ceiling = floor, ceiling
        self.rates = rates or Rates(1.0, 1.0, 1.0)
        self._least = 2.0 * turning_radius
        kept_from = tuple(areas)
        self.reach: Reach | None = None
        self.anywhere = self
        self._obstacles = Obstacles(kept_from, clearance)
        self._visibility = Visibility(self._obstacles)
        self._routes: dict[tuple[Position, Position], tuple[Position, ...] | str] = {}
        self.remembered: dict[Hashable, tuple[dict[Any, Any], dict[Any, Any]]] = {}
        self._columns: dict[tuple[Position, Position], str] = {}

    def within(self, reach: Reach) -> Space:
        """Return the same space of a robot that stays in range of its radio."""
        other = copy(self)
        other.reach, other._routes, other.remembered = reach, {}, {}
        return other

    @property
    def empty(self) -> bool:
        """Return whether nothing is in the way anywhere."""
        return not self._obstacles and self.reach is None

    def in_range(self, polyline: Sequence[Position]) -> bool:
        """Return whether the robot is in range of its radio all along a polyline."""
        return self.reach is None or self.reach.contains(polyline)

    def is_clear(self, polyline: Sequence[Position]) -> bool:
        """Return whether a polyline (one point or more) keeps its distance; touching counts as clear."""
        return not self._blockers(polyline, spare=0.0).any()

    def blockers(self, polyline: Sequence[Position]) -> str:
        """Return the names of the areas that a polyline is too near to, quoted; empty if it is clear."""
        return self._obstacles.names(self._blockers(polyline, spare=0.0))

    def column_blockers(self, place: Position, height: float) -> str:
        """Return the names of the areas that an upright leg is too near to; empty if it is clear.

        Routes begin and end at few places: it is remembered.

        Args:
            place: one of its ends.
            height: of the other.
        """
        key = place, (place[0], place[1], height)
        if key not in self._columns:
            self._columns[key] = self.blockers(key)
        return self._columns[key]

    def _blockers(self, polyline: Sequence[Position], *, spare: float = EPSILON / 2) -> Flags:
        if not self._obstacles:
            return np.zeros(0, np.bool_)
        found = self._obstacles.blocking(legs_of(polyline), spare=spare)
        flags: Flags = np.logical_or.reduce(found, axis=0)
        return flags

    def _covered(self, legs: Floats) -> Flags:
        return np.ones(len(legs), np.bool_) if self.reach is None else self.reach.covers(legs)

    def seconds(self, route: Sequence[Position]) -> float:
        """Return how long a route takes at the robot's rates."""
        return sum(self.rates.from_stop_to_stop(one, two) for one, two in pairwise(route))

    def route(self, start: Position, goal: Position) -> tuple[Position, ...]:
        """Return the positions of a quick path from start to goal, both included, at least two.

        Floor and ceiling bind the heights in between; start and goal may be anywhere.

        Raises:
            UnreachableError: there is no path; the message names the areas that block it.
        """
        found = self._routes.get((start, goal))
        back = self._routes.get((goal, start)) if start[2] == goal[2] else None
        if found is None and isinstance(back, tuple):  # on the way back it goes up where it went down
            found = self._routes[start, goal] = back[::-1]
        if found is None:
            found = self._routes[start, goal] = self._drivable(self._search(start, goal))
        if isinstance(found, str):
            raise UnreachableError(found)
        return found

    def _drivable(self, found: tuple[Position, ...] | str) -> tuple[Position, ...] | str:
        if isinstance(found, str) or not self._least:
            return found
        return with_fewer_corners(
            found, self._least, lambda path: not self._blockers(path).any() and self.in_range(path)
        )

    def _search(self, start: Position, goal: Position) -> tuple[Position, ...] | str:
        for end, name in ((start, "start"), (goal, "goal")):
            inside = self.column_blockers(end, end[2])
            if inside:
                return f"{name} {_words(end)} is within the clearance of {inside}"
            if self.reach is not None and not self.reach.contains((end,)):
                return f"{name} {_words(end)} is out of range: {self.reach.beyond((end,))}"
        blockers = self._blockers((start, goal))
        if not blockers.any() and self.rates.even(start, goal) < inf and self.in_range((start, goal)):
            return (start, goal)
        path = self._at_one_height(start, goal)
        if path and self.in_range(path):
            return self._cut_short(path)
        return self._at_several_heights(start, goal, blockers)

    def _at_one_height(self, start: Position, goal: Position) -> list[Position] | None:
        """Return the quickest path of the sort up or down, level, up or down; None if there is none."""
        level = dist(start[:2], goal[:2]) / self.rates.cruise
        best: list[Position] | None = None
        quickest = inf
        heights = [each for each in self._heights(start, goal) if each[0] < inf]
        clear = self._columns_clear(start, goal, [height for _, height in heights])
        for (upright, height), free in zip(heights, clear, strict=True):
            if upright + level >= quickest or not free:
                continue
            longest = (quickest - upright) * self.rates.cruise
            blocks = self._obstacles.blocks_at(height)
            flat = self._visibility.shortest_path(start[:2], goal[:2], blocks, longest)
            if flat is not None:
                path = [start, *((*place, height) for place in flat), goal]
                path = [here for i, here in enumerate(path) if i == 0 or here != path[i - 1]]
                if self.seconds(path) < quickest:
                    best, quickest = path, self.seconds(path)
        return best

    def _heights(self, start: Position, goal: Position) -> list[tuple[float, float]]:
        """Return (seconds up and down, height) for heights worth a try, quickest first."""
        over = self._visibility.between(start[:2], goal[:2])
        around = [
            *(self._obstacles.high[over] + _ABOVE).tolist(),
            *(self._obstacles.low[over] - _ABOVE).tolist(),
        ]
        inside = {height for height in around if self.floor <= height <= self.ceiling}
        costs = sorted((self._upright(start, goal, height), height) for height in inside)
        ends = sorted((self._upright(start, goal, height), height) for height in {start[2], goal[2]})
        topmost = costs[_HEIGHTS:] and [max(costs, key=lambda each: each[1])]
        return sorted({*ends, *costs[:_HEIGHTS], *topmost})

    def _upright(self, start: Position, goal: Position, height: float) -> float:
        return self.rates.upright(height - start[2]) + self.rates.upright(goal[2] - height)

    def _columns_clear(self, start: Position, goal: Position, heights: Sequence[float]) -> list[bool]:
        """Return, by height, whether it can be reached straight up or down from start and goal."""
        columns = [
            column
            for height in heights
            for column in ([start, (*start[:2], height)], [(*goal[:2], height), goal])
        ]
        found = self._obstacles.blocking(np.array(columns).reshape(-1, 2, 3))
        blocked = np.logical_or.reduce(found, axis=1).tolist()
        return [not (up or down) for up, down in zip(blocked[::2], blocked[1::2], strict=True)]

    def _at_several_heights(
        self, start: Position, goal: Position, active: Flags
    ) -> tuple[Position, ...] | str:
        """Return the quickest path that may change its height at corners, or why there is none."""
        band = (self.floor, self.ceiling)
        while True:
            chosen = np.flatnonzero(active).tolist()
            path = Layers(
                self._obstacles, self._visibility, chosen, (start, goal), band, self.rates, self.reach
            ).path()
            if path is None:
                return self._no_way(start, goal, active)
            blockers = self._blockers(path)
            if not (blockers & ~active).any():
                return self._cut_short(path)
            active = active | blockers

    def _no_way(self, start: Position, goal: Position, active: Flags) -> str:
        names = self._obstacles.names(active)
        between = f"from {_words(start)} to {_words(goal)} between {self.floor:g} m and {self.ceiling:g} m"
        clear = f"keeps clear of {names}" if names else ""
        if self.reach is not None:
            return f"no path {between} {clear}{' and ' if names else ''}stays in range of its radio"
        return f"no path {between} {clear or 'up or down'}"

    def _cut_short(self, path: Sequence[Position]) -> tuple[Position, ...]:
        """Return the quickest path through some of the positions, in order, by clear straight legs."""
        count = len(path)
        level = [path[i][2] == path[i + 1][2] for i in range(count - 1)]
        pairs = [
            (i, j) for i in range(count) for j in range(i + 2, count) if j == i + 2 or not all(level[i:j])
        ]
        if not pairs:
            return tuple(path)
        legs = np.array([[path[i], path[j]] for i, j in pairs])
        clear = ~np.logical_or.reduce(self._obstacles.blocking(legs), axis=1) & self._covered(legs)
        steps = {(i, i + 1) for i in range(count - 1)}
        steps |= {pair for pair, free in zip(pairs, clear.tolist(), strict=True) if free}
        best, came = [0.0, *[inf] * (count - 1)], [0] * count
        for i, j in sorted(steps):
            reached = best[i] + self.rates.even(path[i], path[j])
            if reached < best[j] - 1e-9:
                best[j], came[j] = reached, i
        picks = [count - 1]
        while picks[-1]:
            picks.append(came[picks[-1]])
        return tuple(path[i] for i in reversed(picks))


def _words(position: Position) -> str:
    east, north, up = position
    return f"({east:.1f}, {north:.1f}, {up:.1f})"
