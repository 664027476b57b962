"""Cuts a polygon into strips and finds, in each strip, the lines whose footprint covers it exactly.

The strip is cut, not its centre line: a line is drawn wherever the polygon has an inside, on the
centre line where that is inside, else as near to it as the inside allows. Lines run along x; a
polygon to be swept at an angle is turned beforehand.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

Floats: TypeAlias = NDArray[np.float64]

_TINY = 1e-9
_STEPS = 12
"""How many level lines a thin slanted piece may be cut into before it gets one slanted line."""


@dataclass(frozen=True, slots=True)
class _Cell:
    """A trapezoid with upright sides at x = left and right; (low, high) at each side."""

    left: float
    right: float
    low: tuple[float, float]
    high: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Swath:
    """A polyline to be followed.

    Attributes:
        points: (n, 2), at least two.
        covers: by leg, whether its footprint is needed; the others only join legs that cover.
    """

    points: Floats
    covers: NDArray[np.bool_]

    def reversed(self) -> Swath:
        """Return the same swath, followed from its end."""
        return Swath(self.points[::-1], self.covers[::-1])

    @property
    def length(self) -> float:
        """Metres along all legs."""
        return float(np.hypot(*np.diff(self.points, axis=0).T).sum())


@dataclass(slots=True)
class _Chain:
    """Cells that follow each other from left to right, with an overlap at each shared side."""

    cells: list[_Cell] = field(default_factory=list)


def swaths_along_x(pieces: Iterable[Polygon], width: float) -> list[Swath]:
    """Return swaths inside the pieces such that level strips about them cover the pieces.

    Each swath consists of level lines and, where it changes its height within a strip, of upright
    ones. The strips of the level lines alone, as wide as `width` and as long as the lines, cover the
    pieces, except at thin slanted ends, where a slanted line may leave a little out.

    Args:
        pieces: sound polygons that do not overlap.
        width: of a strip, metres, positive.
    """
    whole = [piece for piece in pieces if piece.area > 0.0]
    if not whole:
        return []
    bounds = shapely.bounds(np.array(whole, dtype=object))
    swaths: list[Swath] = []
    for piece, (left, bottom, right, top) in zip(whole, bounds, strict=True):
        for low, high in _levels(float(bottom), float(top), width):
            strip = shapely.box(left - 1.0, low, right + 1.0, high)
            inside = piece if (low <= bottom and high >= top) else shapely.intersection(piece, strip)
            for chain in _chains(_cells(inside, (low + high) / 2)):
                swaths.append(_swath(chain, (low + high) / 2, width))
    return swaths


def _levels(bottom: float, top: float, width: float) -> Iterator[tuple[float, float]]:
    """Yield the strips' (low, high): all of one height, not over `width`, as few as can be."""
    count = max(1, ceil((top - bottom) / width - _TINY))
    edges = np.linspace(bottom, top, count + 1).tolist()
    yield from pairwise(edges)


def _cells(inside: shapely.Geometry, middle: float) -> list[list[_Cell]]:
    """Return the trapezoids of a strip's inside, by upright slab from left to right."""
    edges = _edges(inside)
    if not len(edges):
        return []
    xs = _slab_sides(edges, middle)
    left, right = xs[:-1, None], xs[1:, None]
    centre = (left + right) / 2
    spans = (edges[:, 0] < centre) & (edges[:, 2] > centre)
    slope = (edges[:, 3] - edges[:, 1]) / (edges[:, 2] - edges[:, 0])
    at = np.stack([edges[:, 1] + (x - edges[:, 0]) * slope for x in (left, centre, right)])
    slabs = []
    for i in range(len(xs) - 1):
        across = np.flatnonzero(spans[i])
        across = across[np.argsort(at[1, i, across], kind="stable")]
        first, last = at[0, i, across].tolist(), at[2, i, across].tolist()
        slabs.append(
            [
                _Cell(float(xs[i]), float(xs[i + 1]), (first[k], last[k]), (first[k + 1], last[k + 1]))
                for k in range(0, len(across) - 1, 2)
            ]
        )
    return slabs


def _edges(inside: shapely.Geometry) -> Floats:
    """Return (n, 4) edges (x1, y1, x2, y2) of all rings with x1 < x2; upright edges are left out."""
    rings = [
        shapely.get_coordinates(ring)
        for piece in shapely.get_parts(inside)
        if isinstance(piece, Polygon)
        for ring in (piece.exterior, *piece.interiors)
    ]
    if not rings:
        return np.empty((0, 4))
    edges = np.concatenate([np.hstack([ring[:-1], ring[1:]]) for ring in rings])
    backwards = edges[:, 0] > edges[:, 2]
    edges[backwards] = edges[backwards][:, [2, 3, 0, 1]]
    slanted: Floats = edges[edges[:, 2] - edges[:, 0] > _TINY]
    return slanted


def _slab_sides(edges: Floats, middle: float) -> Floats:
    """Return the sorted x of all vertices and of all crossings of the strip's middle."""
    crossing = edges[(edges[:, 1] - middle) * (edges[:, 3] - middle) < 0.0]
    share = (middle - crossing[:, 1]) / (crossing[:, 3] - crossing[:, 1])
    xs = np.unique(
        np.concatenate([edges[:, 0], edges[:, 2], crossing[:, 0] + share * (crossing[:, 2] - crossing[:, 0])])
    )
    keep = np.concatenate([[True], np.diff(xs) > _TINY])
    sides: Floats = xs[keep]
    return sides


def _chains(slabs: list[list[_Cell]]) -> list[_Chain]:
    """Join cells of neighbouring slabs that share a part of a side, each with one at most."""
    done: list[_Chain] = []
    growing: list[_Chain] = []
    for slab in slabs:
        left_over = growing
        growing = []
        for cell in slab:
            found = next((chain for chain in left_over if _overlap(chain.cells[-1], cell) > 1e-6), None)
            if found is None:
                found = _Chain()
                done.append(found)
            else:
                left_over = [chain for chain in left_over if chain is not found]
            found.cells.append(cell)
            growing.append(found)
    return done


def _overlap(before: _Cell, after: _Cell) -> float:
    return min(before.high[1], after.high[0]) - max(before.low[1], after.low[0])


def _swath(chain: _Chain, middle: float, width: float) -> Swath:
    """Return the swath of a chain: as few level lines as cover all of its cells."""
    points: list[tuple[float, float]] = []
    covers: list[bool] = []
    run: list[_Cell] = []
    for cell in [*(part for whole in chain.cells for part in _level_parts(whole, width)), None]:
        if run and (cell is None or _window([*run, cell], width) is None):
            begin, end = _ends(run, middle, width)
            if points and begin != points[-1]:
                covers.append(False)
            points += [begin, end] if not points or begin != points[-1] else [end]
            covers.append(True)
            run = []
        if cell is not None:
            run.append(cell)
    return Swath(np.array(points), np.array(covers))


def _window(run: list[_Cell], width: float) -> tuple[float, float] | None:
    """Return the heights at which one level line stays inside all cells and covers them; None: none."""
    low = max(max(max(cell.low), max(cell.high) - width / 2) for cell in run)
    high = min(min(min(cell.high), min(cell.low) + width / 2) for cell in run)
    if low > high + 1e-7:
        return None
    return min(low, high), high


def _ends(run: list[_Cell], middle: float, width: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the two ends of the line over a run of cells."""
    window = _window(run, width)
    if window is None:
        cell = run[0]
        ys = [min(max(middle, low), high) for low, high in zip(cell.low, cell.high, strict=True)]
        return (cell.left, ys[0]), (cell.right, ys[1])
    y = min(max(middle, window[0]), window[1])
    return (run[0].left, y), (run[-1].right, y)


def _level_parts(cell: _Cell, width: float) -> list[_Cell]:
    """Return the cell, cut upright into parts that a level line can cover, left to right.

    A thin slanted cell is cut where the lower side has risen (or the upper one fallen) past the
    height at which the part began.
    """
    parts: list[_Cell] = []
    rest = cell
    while len(parts) < _STEPS and _window([rest], width) is None:
        rises = rest.low[1] > rest.high[0]
        falls = rest.high[1] < rest.low[0]
        side, limit = (rest.low, rest.high[0]) if rises else (rest.high, rest.low[0])
        if not (rises or falls):
            x = (rest.left + rest.right) / 2
        else:
            x = rest.left + (limit - side[0]) / (side[1] - side[0]) * (rest.right - rest.left)
        if not rest.left + _TINY < x < rest.right - _TINY:
            break
        first, rest = _cut(rest, x)
        parts.append(first)
    return [*parts, rest]


def _cut(cell: _Cell, x: float) -> tuple[_Cell, _Cell]:
    share = (x - cell.left) / (cell.right - cell.left)
    low = cell.low[0] + share * (cell.low[1] - cell.low[0])
    high = cell.high[0] + share * (cell.high[1] - cell.high[0])
    return (
        _Cell(cell.left, x, (cell.low[0], low), (cell.high[0], high)),
        _Cell(x, cell.right, (low, cell.low[1]), (high, cell.high[1])),
    )
