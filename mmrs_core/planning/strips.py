"""Cuts polygons into strips and finds, in each strip, the swaths whose footprint covers it exactly.

The strip is cut, not its centre line. A swath follows the middle of what there is in its strip, even
outside of the polygons, and steps aside only where the robot may not be. Swaths run along x; polygons
to be swept at an angle are turned beforehand. Strips are cut into cells at corners (Choset and Pignon, 1998).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import ceil

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.planning.levels import legs_over
from mmrs_core.planning.lines import Place, Swath, swath_over
from mmrs_core.planning.slabs import Cell, cells, edges_of

_GAP = 1.5
"""Widths of a gap that a swath crosses: over a wider one, two swaths and their turns are shorter."""

_ROUNDING = 1e-6
"""Strips by which polygons may reach beyond whole ones, as turned and overlaid rings are rounded."""

SHAVED = 5e-4
"""Metres that what is closed is shrunk by before it is asked whether a line is clear of it: less than
clearances are rounded up by, and enough for lines along its edge."""


def swaths_along_x(
    pieces: Iterable[BaseGeometry],
    width: float,
    *,
    length: float = 0.0,
    closed: BaseGeometry | None = None,
    shift: float | None = None,
    facing: bool = False,
) -> list[Swath]:
    """Return swaths along x such that what they cover includes the pieces.

    Each swath consists of level lines and, where it changes its height within a strip, of upright
    ones. Level strips about the level lines alone, as long as the lines, or about each of their spots,
    `length` long, cover the pieces, except at thin slanted places between closed areas, where a slanted
    line may leave a little out.

    Args:
        pieces: sound polygons that do not overlap each other or what is closed.
        width: of a strip, metres, positive.
        length: of what an action covers along the swath, metres; 0: the swath itself covers.
        closed: where swaths may not go, its edge excepted; None: nowhere.
        shift: None: strips share the excess width evenly; a number: all are as wide as they can be, and
            the lowest begins this share (0 to 1) of the excess below the pieces.
        facing: see `swath_over`.
    """
    blocked = Polygon() if closed is None else closed
    core = shapely.buffer(blocked, -SHAVED)
    shapely.prepare(core)

    def clear(one: Place, two: Place) -> bool:
        return not shapely.intersects(core, shapely.LineString([one, two]))

    swaths = (
        swath_over(legs_over(chain, width), width, length, clear, facing=facing)
        for group in _groups([piece for piece in pieces if piece.area > 0.0], _GAP * width)
        for chain in _chains_of(group, width, blocked, shift)
    )
    return [swath for swath in swaths if swath is not None]


def _groups(pieces: Sequence[BaseGeometry], gap: float) -> Iterator[BaseGeometry]:
    """Yield pieces that are near to each other together, so that swaths may run over several."""
    tree = shapely.STRtree(pieces)
    waiting = dict.fromkeys(range(len(pieces)))
    while waiting:
        group = [next(iter(waiting))]
        del waiting[group[0]]
        for member in group:
            near = tree.query(pieces[member], predicate="dwithin", distance=gap).tolist()
            for other in sorted(near):
                if other in waiting:
                    del waiting[other]
                    group.append(other)
        yield shapely.union_all([pieces[i] for i in group]) if len(group) > 1 else pieces[group[0]]


def _chains_of(
    target: BaseGeometry, width: float, blocked: BaseGeometry, shift: float | None
) -> Iterator[list[Cell]]:
    left, bottom, right, top = shapely.bounds(target).tolist()
    levels = _levels(bottom, top, width, shift)
    strips = shapely.box(left - 1.0, levels[:-1], right + 1.0, levels[1:])
    wanted = edges_of(shapely.intersection(target, strips))
    for slabs in map(cells, wanted, edges_of(shapely.difference(strips, blocked))):
        for row in _rows(slabs):
            yield from _chains(row, _GAP * width)


def _levels(bottom: float, top: float, width: float, shift: float | None) -> NDArray[np.float64]:
    """Return the heights between which strips are: of one height, not over `width`, as few as can be."""
    count = max(1, ceil((top - bottom) / width - _ROUNDING))
    if shift is not None:
        bottom -= shift * (count * width - (top - bottom))
        top = bottom + count * width
    return np.linspace(bottom, top, count + 1)


def _rows(slabs: Sequence[list[Cell]]) -> list[list[Cell]]:
    """Join cells of neighbouring slabs that share a part of a side, each with the one it shares most with."""
    rows: list[list[Cell]] = []
    growing: list[list[Cell]] = []
    for slab in slabs:
        shared = [
            (_overlap(row[-1], cell), i, j) for i, row in enumerate(growing) for j, cell in enumerate(slab)
        ]
        joined: dict[int, int] = {}
        for overlap, i, j in sorted(shared, key=lambda each: -each[0]):
            if overlap > 1e-6 and j not in joined and i not in joined.values():
                joined[j] = i
        following = [growing[joined[j]] if j in joined else [] for j in range(len(slab))]
        rows += [row for j, row in enumerate(following) if j not in joined]
        for row, cell in zip(following, slab, strict=True):
            row.append(cell)
        growing = following
    return rows


def _overlap(before: Cell, after: Cell) -> float:
    high = min(before.room.high[1], after.room.high[0])
    return high - max(before.room.low[1], after.room.low[0])


def _chains(row: Sequence[Cell], gap: float) -> Iterator[list[Cell]]:
    """Yield the parts of a row that begin and end with something to be covered and have no wide gaps."""
    chain: list[Cell] = []
    crossed: list[Cell] = []
    for cell in row:
        if cell.need is None:
            crossed.append(cell)
            continue
        if chain and crossed and crossed[-1].right - crossed[0].left > gap:
            yield chain
            chain = []
        chain += [*crossed, cell] if chain else [cell]
        crossed = []
    if chain:
        yield chain
