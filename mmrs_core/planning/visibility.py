"""What lies between places in the plane, and shortest paths around it; remembered from path to path."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any, TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray

from mmrs_core.geometry.clearance import EPSILON
from mmrs_core.geometry.compilation import can_compile, compiled
from mmrs_core.planning import sight
from mmrs_core.planning.obstacles import Flags, Floats, Obstacles, outlines_of
from mmrs_core.planning.sight import DIRECTIONS, FULL, NONE, START, UNKNOWN, Columns, Memory

Place: TypeAlias = tuple[float, float]

_MANY = 50
"""Areas from which on compiled loops are worth their import, where they are installed."""

_SETS = 32
"""Sets of areas at most for which is kept what was seen."""

_PLACES = 1000
"""Places at most where paths begin or end for which is kept what was seen from there."""


class Visibility:
    """Finds shortest paths among grown areas, of which those count that block at a height."""

    def __init__(self, obstacles: Obstacles) -> None:
        self._obstacles = obstacles
        self._compiled = len(obstacles) >= _MANY and can_compile()
        self._columns: Columns | None = None
        self._room: tuple[Any, ...] = ()
        self._memories: dict[bytes, Memory] = {}
        self._places: dict[bytes, dict[Place, int]] = {}
        self._rows: dict[tuple[Place, int], Flags] = {}
        self._pairs: dict[tuple[Place, Place], Flags] = {}

    def shortest_path(
        self, start: Place, goal: Place, blocks: Flags, longest: float = inf
    ) -> list[Place] | None:
        """Return the shortest path around the areas that block; None if there is none within `longest`.

        Args:
            start: where the path begins.
            goal: where it ends.
            blocks: (areas,) which areas block.
            longest: metres beyond which a path is of no use.
        """
        if self._columns is None:
            self._columns = columns_of(self._obstacles, self._column)
            self._room = _room_among(self._columns, self._column)
        columns, nodes, key = self._columns, 2 * len(self._columns.x), blocks.tobytes()
        memory = self._memory(blocks, nodes)
        ends = [nodes + self._places[key].setdefault(each, len(self._places[key])) for each in (start, goal)]
        search = compiled(sight, "search").search if self._compiled else sight.search
        metres = search(columns, memory, *start, *goal, longest, EPSILON / 2, *ends)
        while metres == FULL:
            memory = self._memories[key] = self._enlarged(memory)
            metres = search(columns, memory, *start, *goal, longest, EPSILON / 2, *ends)
        if metres == NONE:
            return None
        path, node = [goal], int(memory.came[nodes])
        while node != START:
            path.append((float(columns.x[node // 2]), float(columns.y[node // 2])))
            node = int(memory.came[node])
        return [start, *reversed(path)]

    def _memory(self, blocks: Flags, nodes: int) -> Memory:
        key = blocks.tobytes()
        memory = self._memories.pop(key, None)
        if memory is None or len(self._places[key]) > _PLACES - 2:
            if len(self._memories) == _SETS:
                oldest = next(iter(self._memories))
                del self._memories[oldest], self._places[oldest]
            self._places[key] = {}
            column = self._column
            memory = Memory(
                column(blocks),
                column(np.zeros(nodes + _PLACES, np.int64)),
                column(np.full(nodes + _PLACES, UNKNOWN)),
                column(np.zeros(nodes, np.int64)),
                column(np.zeros(nodes)),
                column(np.zeros(1, np.int64)),
                column(np.zeros(len(blocks) + 1, np.int64)),
                *self._room,
            )
        self._memories[key] = memory  # the last one used is the last to go
        return memory

    def _enlarged(self, memory: Memory) -> Memory:
        """Return the same memory with room for twice as much."""
        node, metres = np.asarray(memory.node), np.asarray(memory.metres)
        return memory._replace(
            node=self._column(np.concatenate([node, node])),
            metres=self._column(np.concatenate([metres, metres])),
        )

    def _column(self, values: NDArray[Any]) -> Any:
        """Return values as loops read and write them fastest: an array, or a list where not compiled."""
        return np.ascontiguousarray(values) if self._compiled else values.tolist()

    def to_corners(self, place: Place, area: int) -> Flags:
        """Return (corners of the area, areas): what lies between a place and each corner."""
        row = self._rows.get((place, area))
        if row is None:
            corners = self._obstacles.corners_of(area)
            lines = np.stack([np.broadcast_to(np.array(place), corners.shape), corners], axis=1)
            row = self._rows[place, area] = self._obstacles.crossed(lines)
        return row

    def between(self, one: Place, two: Place) -> Flags:
        """Return (areas,): what lies between two places, or over one place if they are the same."""
        flags = self._pairs.get((one, two))
        if flags is None:
            flags = self._pairs[one, two] = self._obstacles.crossed(np.array([[one, two]]))[0]
        return flags


def _room_among(columns: Columns, column: Callable[[NDArray[Any]], Any]) -> tuple[Any, ...]:
    """Return the last fields of `Memory`, from `blocked` on, which all searches share."""
    areas, nodes = len(columns.clearance), 2 * len(columns.x)
    looks = (np.zeros(DIRECTIONS), np.zeros(areas, np.int64), np.zeros(nodes, np.int64), np.zeros(nodes))
    return tuple(map(column, (*looks, np.zeros(nodes + 1), np.zeros(nodes + 1, np.int64))))


def columns_of(obstacles: Obstacles, column: Callable[[NDArray[Any]], Any]) -> Columns:
    """Return grown areas as columns, each made by `column`, and a grid of about as many cells over them."""
    count = len(obstacles)
    corners, before, after, of = obstacles.corners()
    edges, walls = outlines_of(obstacles.smaller), outlines_of(obstacles.drawn)
    bounds = shapely.bounds(obstacles.larger).reshape(-1, 4)
    low = bounds[:, :2].min(axis=0, initial=inf) if count else np.zeros(2)
    extent = bounds[:, 2:].max(axis=0, initial=-inf) - low if count else np.ones(2)
    each = (bounds[:, 2:] - bounds[:, :2]).mean() if count else 1.0
    cell = max(float(np.sqrt(extent.prod() / max(1, count))), float(each))
    columns, rows = (int(cells) for cells in extent // cell + 1)
    cells_from, in_cells = _in_cells((bounds.reshape(-1, 2, 2) - low) // cell, columns, rows)
    parts: list[Floats | NDArray[np.intp]] = [*corners.T, *(before - corners).T, *(after - corners).T]
    parts.append(_slices(of, count))
    for rings in (edges, walls):
        parts += [*rings.places.T, *rings.places[rings.after].T, _slices(rings.shape, count)]
    parts += [obstacles.clearance, *bounds.T, cells_from, in_cells]
    return Columns._make([*map(column, parts), *low.tolist(), cell, columns, rows])


def _slices(of: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """Return where each of `count` owners' items begin, and where the last one's end."""
    return np.searchsorted(of, np.arange(count + 1))


def _in_cells(spans: Floats, columns: int, rows: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return where each cell's areas begin, and the areas in all cells.

    Args:
        spans: (areas, 2, 2) first and last (column, row) of each area.
        columns: of the grid.
        rows: of the grid.
    """
    first, last = spans[:, 0].astype(np.intp), spans[:, 1].astype(np.intp)
    wide, high = (last - first + 1).T
    area = np.repeat(np.arange(len(spans)), wide * high)
    index = np.arange(len(area)) - np.repeat(np.cumsum(wide * high) - wide * high, wide * high)
    cell = (first[area, 1] + index // wide[area]) * columns + first[area, 0] + index % wide[area]
    order = np.argsort(cell, kind="stable")
    return _slices(cell[order], columns * rows), area[order]
