"""Level legs over a row of cells: as few as stay where a robot may be and cover what is to be covered."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf

from mmrs_core.planning.slabs import TINY, Cell, Side

_STEPS = 12
"""How many level legs a thin slanted cell may be cut into before it gets one slanted leg."""

_ANY = (-inf, inf)
_ROUNDING = 1e-7
"""Metres by which the lowest height that will do may seem to lie above the highest."""


@dataclass(frozen=True, slots=True)
class LevelLeg:
    """A straight line over a run of cells.

    Attributes:
        begin, end: (x, y), from left to right.
        needs: stretches (from, to) along x that are to be covered, left to right, apart from each other.
        corners: of what is to be covered, (x, y).
    """

    begin: tuple[float, float]
    end: tuple[float, float]
    needs: tuple[tuple[float, float], ...]
    corners: tuple[tuple[float, float], ...]


def legs_over(chain: Sequence[Cell], width: float) -> list[LevelLeg]:
    """Return the legs over cells that follow each other, from left to right.

    A strip about each level leg, as wide as `width`, covers what the cells need. Where a cell is too
    thin and slanted for level legs, a slanted one may leave a little out.
    """
    legs: list[LevelLeg] = []
    run: list[Cell] = []
    window = _ANY
    for cell in (part for whole in chain for part in _level_parts(whole, width)):
        limits = _limits(cell, width)
        common = (max(window[0], limits[0]), min(window[1], limits[1]))
        if run and not _open(common):
            legs.append(_leg(run, window))
            run, common = [], limits
        run.append(cell)
        window = common
    return [*legs, _leg(run, window)] if run else legs


def _leg(run: Sequence[Cell], window: tuple[float, float]) -> LevelLeg:
    """Return the leg over cells at a height in a window, as near to the middle of their needs as can be."""
    corners = tuple(corner for cell in run for corner in _corners(cell))
    heights = [y for _, y in corners] or [y for cell in run for y in (*cell.room.low, *cell.room.high)]
    middle = (min(heights) + max(heights)) / 2
    if _open(window):
        begin = end = min(max(middle, min(window)), window[1])
    else:
        (cell,) = run
        ends = zip(cell.room.low, cell.room.high, strict=True)
        begin, end = (min(max(middle, low), high) for low, high in ends)
    return LevelLeg((run[0].left, begin), (run[-1].right, end), tuple(_needs(run)), corners)


def _corners(cell: Cell) -> Iterator[tuple[float, float]]:
    if cell.need is not None:
        for side in (cell.need.low, cell.need.high):
            yield cell.left, side[0]
            yield cell.right, side[1]


def _needs(run: Sequence[Cell]) -> Iterator[tuple[float, float]]:
    """Yield the stretches that are to be covered, neighbouring ones put together."""
    begin: float | None = None
    for cell in run:
        if cell.need is not None and begin is None:
            begin = cell.left
        if cell.need is None and begin is not None:
            yield begin, cell.left
            begin = None
    if begin is not None:
        yield begin, run[-1].right


def _lower_limits(cell: Cell, width: float) -> list[Side]:
    """Return the lines above which a leg must stay: the room's lower side, and reach of the need's upper."""
    if cell.need is None:
        return [cell.room.low]
    left, right = cell.need.high
    return [cell.room.low, (left - width / 2, right - width / 2)]


def _upper_limits(cell: Cell, width: float) -> list[Side]:
    """Return the lines below which a leg must stay."""
    if cell.need is None:
        return [cell.room.high]
    left, right = cell.need.low
    return [cell.room.high, (left + width / 2, right + width / 2)]


def _limits(cell: Cell, width: float) -> tuple[float, float]:
    """Return the lowest and the highest level leg that stays inside a cell's room and covers its need."""
    return (
        max(max(side) for side in _lower_limits(cell, width)),
        min(min(side) for side in _upper_limits(cell, width)),
    )


def _open(window: tuple[float, float]) -> bool:
    return window[0] <= window[1] + _ROUNDING


def _level_parts(cell: Cell, width: float) -> list[Cell]:
    """Return the cell, cut upright into parts for a level leg each, left to right, each as long as can be."""
    parts: list[Cell] = []
    rest = cell
    while len(parts) < _STEPS and not _open(_limits(rest, width)):
        x = _level_until(rest, width)
        if not rest.left + TINY < x < rest.right - TINY:
            break
        part, rest = rest.cut(x)
        parts.append(part)
    return [*parts, rest]


def _level_until(cell: Cell, width: float) -> float:
    """Return how far right one level leg that begins at the cell's left side will do."""
    lower, upper = _lower_limits(cell, width), _upper_limits(cell, width)
    floor, ceiling = max(side[0] for side in lower), min(side[0] for side in upper)
    shares = [
        *((ceiling - side[0]) / (side[1] - side[0]) for side in lower if side[1] > max(side[0], ceiling)),
        *((floor - side[0]) / (side[1] - side[0]) for side in upper if side[1] < min(side[0], floor)),
        *_meetings(lower, upper),
    ]
    return cell.left + min(shares, default=1.0) * (cell.right - cell.left)


def _meetings(lower: Sequence[Side], upper: Sequence[Side]) -> Iterator[float]:
    """Yield the shares of the way by which rising lower limits are where falling upper ones are."""
    for below in lower:
        for above in upper:
            rise, fall = below[1] - below[0], above[0] - above[1]
            if rise > 0.0 and fall > 0.0 and below[1] > above[1]:
                yield (above[0] - below[0]) / (rise + fall)
