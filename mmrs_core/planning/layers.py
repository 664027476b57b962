"""The quickest path among some grown areas: level legs at a few heights, upright ones between them.

A node of the search is a place (start, goal, a corner of an area, or where a path turns from one radio's
range into another's) at a height (that of start or goal, just above or below an area, or where two ranges
meet). A* (Hart, Nilsson and Raphael, 1968) with the exact time of a free path as its bound.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from heapq import heappop, heappush
from math import hypot, isfinite

import numpy as np
from numpy.typing import NDArray

from mmrs_core.planning.obstacles import HEIGHT_MARGIN, Flags, Floats, Obstacles
from mmrs_core.planning.reach import Reach
from mmrs_core.planning.visibility import Visibility
from mmrs_core.scene import Position
from mmrs_core.scene.timing import Rates

_ABOVE = 1e-3
"""Metres that a height is above or below what an area blocks."""


class Layers:
    """One search among the active areas, all others left out of account."""

    def __init__(
        self,
        obstacles: Obstacles,
        visibility: Visibility,
        active: Sequence[int],
        ends: tuple[Position, Position],
        band: tuple[float, float],
        rates: Rates,
        reach: Reach | None = None,
    ) -> None:
        """Lay out places and heights.

        Args:
            obstacles: of the robot.
            visibility: over the same obstacles.
            active: indices of the areas that count.
            ends: start and goal.
            band: heights (lowest, highest) at which the robot may travel.
            rates: of the robot.
            reach: where the robot is in range of its radio; None: everywhere.
        """
        self._visibility, self._active, self._rates = visibility, list(active), rates
        self._obstacles, self._ends, self._reach = obstacles, ends, reach
        corners = [obstacles.corners_of(area) for area in self._active]
        self._gates = [] if reach is None else reach.gates(ends)
        self._low, self._high = obstacles.low[self._active], obstacles.high[self._active]
        self._heights = self._levels(band)
        turns = [np.empty((0, 2)) if reach is None else reach.turns(each) for each in self._heights]
        beside = [ends[0][:2], ends[1][:2], *(each[:2] for each in self._gates)]
        self._places: Floats = np.concatenate([beside, *corners, *turns])
        self._turns: list[int] = np.cumsum(
            [len(self._places) - sum(map(len, turns)), *map(len, turns)]
        ).tolist()
        self._blocks = [obstacles.blocks_at(height)[self._active] for height in self._heights]
        self._rows: dict[int, Flags] = {}
        self._rows_of_turns: dict[tuple[int, int], Flags] = {}
        self._columns: dict[int, list[bool]] = {}

    def _levels(self, band: tuple[float, float]) -> list[float]:
        around = [*(self._high + _ABOVE).tolist(), *(self._low - _ABOVE).tolist()]
        around += [up for *_, up in self._gates]
        inside = [height for height in around if band[0] <= height <= band[1] and isfinite(height)]
        return sorted({self._ends[0][2], self._ends[1][2], *inside})

    def path(self) -> list[Position] | None:
        """Return the quickest path between start and goal; None if there is none."""
        count = len(self._heights)
        goal = count + self._heights.index(self._ends[1][2])
        start = self._heights.index(self._ends[0][2])
        best = {start: 0.0}
        came: dict[int, int] = {}
        queue = [(self._bound(start), start)]
        done = set()
        while queue:
            _, node = heappop(queue)
            if node == goal:
                return self._back(came, goal)
            if node in done:
                continue
            done.add(node)
            for other, seconds in self._neighbours(node):
                reached = best[node] + seconds
                if reached < best.get(other, float("inf")) - 1e-12:
                    best[other], came[other] = reached, node
                    heappush(queue, (reached + self._bound(other), other))
        return None

    def _back(self, came: dict[int, int], node: int) -> list[Position]:
        nodes = [node]
        while nodes[-1] in came:
            nodes.append(came[nodes[-1]])
        return [self._position(each) for each in reversed(nodes)]

    def _position(self, node: int) -> Position:
        place, level = divmod(node, len(self._heights))
        east, north = self._places[place].tolist()
        return (east, north, self._heights[level])

    def _bound(self, node: int) -> float:
        east, north, up = self._position(node)
        goal = self._ends[1]
        level = hypot(goal[0] - east, goal[1] - north) / self._rates.cruise
        return level + self._rates.upright(goal[2] - up)

    def _neighbours(self, node: int) -> Iterator[tuple[int, float]]:
        count = len(self._heights)
        place, level = divmod(node, count)
        for other in (level - 1, level + 1):
            if 0 <= other < count and self._open(place)[min(level, other)] and self._in_range(node, other):
                rise = self._heights[other] - self._heights[level]
                yield node - level + other, self._rates.upright(rise)
        blocks, first, last = self._blocks[level], self._turns[level], self._turns[level + 1]
        beside = np.flatnonzero(~(self._row(place) & blocks).any(axis=1))
        turns = first + np.flatnonzero(~(self._row_of_turns(place, level) & blocks).any(axis=1))
        free = np.concatenate([beside, turns]) if last > first else beside
        free = free[self._covered(node, free)]
        offset = self._places[free] - self._places[place]
        seconds = np.hypot(offset[:, 0], offset[:, 1]) / self._rates.cruise
        for other, each in zip(free.tolist(), seconds.tolist(), strict=True):
            if other != place:
                yield other * count + level, each

    def _row(self, place: int) -> Flags:
        """Return (places, active areas): what lies between a place and each end or corner."""
        row = self._rows.get(place)
        if row is None:
            here = self._place(place)
            ends = [self._visibility.between(here, self._place(i)) for i in range(2 + len(self._gates))]
            corners = [self._visibility.to_corners(here, area) for area in self._active]
            row = self._rows[place] = np.concatenate([ends, *corners])[:, self._active]
        return row

    def _row_of_turns(self, place: int, level: int) -> Flags:
        """Return (turns, active areas): what lies between a place and each turn from range to range."""
        row = self._rows_of_turns.get((place, level))
        if row is None:
            there = self._places[self._turns[level] : self._turns[level + 1]]
            here = np.broadcast_to(self._places[place], there.shape)
            found = self._obstacles.crossed(np.stack([here, there], axis=1))
            row = self._rows_of_turns[place, level] = found[:, self._active]
        return row

    def _covered(self, node: int, places: NDArray[np.intp]) -> Flags:
        """Return (places,): whether the robot stays in range of its radio on level legs from a node."""
        if self._reach is None:
            return np.ones(len(places), np.bool_)
        here = np.array(self._position(node))
        legs = np.broadcast_to(here, (len(places), 2, 3)).copy()
        legs[:, 1, :2] = self._places[places]
        return self._reach.covers(legs)

    def _in_range(self, node: int, level: int) -> bool:
        """Return whether it does on the upright leg from a node to another level."""
        east, north, up = self._position(node)
        leg = (east, north, up), (east, north, self._heights[level])
        return self._reach is None or self._reach.contains(leg)

    def _place(self, index: int) -> tuple[float, float]:
        east, north = self._places[index].tolist()
        return east, north

    def _open(self, place: int) -> list[bool]:
        """Return, by gap between neighbouring heights, whether a vertical leg there is clear."""
        column = self._columns.get(place)
        if column is None:
            here = self._place(place)
            over = self._visibility.between(here, here)[self._active]
            column = self._columns[place] = [
                not bool(
                    (over & (self._low + HEIGHT_MARGIN < high) & (low < self._high - HEIGHT_MARGIN)).any()
                )
                for low, high in zip(self._heights[:-1], self._heights[1:], strict=True)
            ]
        return column
