"""Cuts a strip of a polygon into upright slabs: what is to be covered there, and where a robot may be."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from operator import itemgetter
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray

Shapes: TypeAlias = NDArray[np.object_]
Side: TypeAlias = tuple[float, float]
"""Heights of a slanted line at the left and at the right side of a slab."""

Edge: TypeAlias = Sequence[float]
"""Ends x1, y1, x2, y2 of an edge, with x1 < x2."""

TINY = 1e-9


@dataclass(frozen=True, slots=True)
class Band:
    """What lies between two lines in a slab."""

    low: Side
    high: Side

    def between(self, begin: float, end: float) -> Band:
        """Return the band between two shares (0 to 1) of its width."""
        return Band(_part(self.low, begin, end), _part(self.high, begin, end))

    def around(self, other: Band) -> Band:
        """Return the band from the lower band's lower line to the upper band's upper line."""
        below, above = (self, other) if sum(self.low) <= sum(other.low) else (other, self)
        return Band(below.low, above.high)


@dataclass(frozen=True, slots=True)
class Cell:
    """A trapezoid between x = left and right in which a robot may be, and what is to be covered in it."""

    left: float
    right: float
    room: Band
    need: Band | None

    def cut(self, x: float) -> tuple[Cell, Cell]:
        """Return the parts of the cell left and right of x."""
        share = (x - self.left) / (self.right - self.left)
        need = self.need
        return (
            Cell(self.left, x, self.room.between(0.0, share), need and need.between(0.0, share)),
            Cell(x, self.right, self.room.between(share, 1.0), need and need.between(share, 1.0)),
        )


def cells(wanted: Sequence[Edge], open_space: Sequence[Edge]) -> list[list[Cell]]:
    """Return the cells of a strip, by slab from left to right, from the target's one end to its other.

    A cell is as high as the free space. Whatever of the target is not inside of it (by rounding) makes a
    cell of its own. Slabs without any target are among those returned.

    Args:
        wanted: edges of what is to be covered of the strip.
        open_space: edges of where a robot may be; that includes what is to be covered.
    """
    if not wanted:
        return []
    begin, end = min(edge[0] for edge in wanted), max(edge[2] for edge in wanted)
    ends = sorted({x for edges in (wanted, open_space) for edge in edges for x in (edge[0], edge[2])})
    ends = [x for x in ends if begin <= x <= end]
    sides = [ends[0], *(x for before, x in pairwise(ends) if x - before > TINY)]
    return [
        _slab(left, right, rooms, needs)
        for (left, right), rooms, needs in zip(
            pairwise(sides), _bands(open_space, sides), _bands(wanted, sides), strict=True
        )
    ]


def _slab(left: float, right: float, rooms: list[Band], needs: list[Band]) -> list[Cell]:
    found: list[Band | None] = [None] * len(rooms)
    alone: list[Cell] = []
    for need in needs:
        middle = sum(need.low + need.high) / 4
        place = next((i for i, room in enumerate(rooms) if _holds(room, middle)), None)
        if place is None:
            alone.append(Cell(left, right, need, need))
        else:
            before = found[place]
            found[place] = need if before is None else before.around(need)
    inside = [Cell(left, right, room, need) for room, need in zip(rooms, found, strict=True)]
    return sorted([*inside, *alone], key=lambda cell: sum(cell.room.low))


def _holds(room: Band, height: float) -> bool:
    return sum(room.low) / 2 <= height <= sum(room.high) / 2


def _bands(edges: Sequence[Edge], sides: Sequence[float]) -> list[list[Band]]:
    """Return what lies between the edges in each slab, upwards."""
    centres = [(left + right) / 2 for left, right in pairwise(sides)]
    across: list[list[tuple[float, Side]]] = [[] for _ in centres]
    for x, y, end, top in edges:
        slope = (top - y) / (end - x)
        for i in range(bisect_right(centres, x), bisect_left(centres, end)):
            ends = y + (sides[i] - x) * slope, y + (sides[i + 1] - x) * slope
            across[i].append((y + (centres[i] - x) * slope, ends))
    for slab in across:
        slab.sort(key=itemgetter(0))
    return [
        [Band(low, high) for (_, low), (_, high) in zip(slab[::2], slab[1::2], strict=False)]
        for slab in across
    ]


def edges_of(shapes: Shapes) -> list[list[Edge]]:
    """Return the edges of all rings of each shape; none that is upright."""
    pieces, shape_of = shapely.get_parts(shapes, return_index=True)
    rings, piece_of = shapely.get_rings(pieces, return_index=True)
    points, ring_of = shapely.get_coordinates(rings, return_index=True)
    edges = np.hstack([points[:-1], points[1:]])
    backwards = edges[:, 0] > edges[:, 2]
    edges[backwards] = edges[backwards][:, [2, 3, 0, 1]]
    kept = (ring_of[:-1] == ring_of[1:]) & (edges[:, 2] - edges[:, 0] > TINY)
    owners = shape_of[piece_of[ring_of[:-1][kept]]]
    by_shape = np.split(edges[kept], np.searchsorted(owners, np.arange(1, len(shapes))))
    return [part.tolist() for part in by_shape]


def _part(side: Side, begin: float, end: float) -> Side:
    rise = side[1] - side[0]
    return side[0] + begin * rise, side[0] + end * rise
