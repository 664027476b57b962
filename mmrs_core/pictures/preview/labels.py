"""Places words on a picture so that they do not cover each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import dist, hypot, inf

import numpy as np
from numpy.typing import NDArray
from shapely import STRtree, box
from shapely.geometry import Point as ShapelyPoint
from shapely.geometry import Polygon

from mmrs_core.scene import Point

FONT = 12.0
_WIDTH_OF_A_LETTER = 0.58
_LONGEST = 34
_STEP = FONT * 1.25
_GAP = 7.0
_SAMPLE = 10.0
_FARTHEST = 4
_SHARES = (0.0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9)
_COVERING = 100.0
_MISLEADING = 25.0
_CROSSING = 1.5
_OUTSIDE = 30.0
_FARTHER = 3.0
_APART = 14.0
"""Distance in pixels between words and what they name beyond which a line joins them."""


def shortened(words: str, longest: int = _LONGEST) -> str:
    """Return the words, cut with an ellipsis where they are too long."""
    return words if len(words) <= longest else words[: longest - 1] + "…"


def width_of(words: str, size: float = FONT) -> float:
    """Return about how many pixels wide words are."""
    return len(words) * size * _WIDTH_OF_A_LETTER


Box = tuple[float, float, float, float]
"""Left, top, right, bottom in pixels."""


@dataclass(frozen=True, slots=True)
class Label:
    """Words and what they name.

    Attributes:
        words: shortened when they are placed.
        around: what they name.
        kind: class in the style sheet.
        colour: name in the palette; empty: the style sheet's.
        tip: for the pointer; may be empty.
        icon: what stands before them, and its colour.
        at: where they are placed: the middle of their base line.
        leader: a line that joins them to what they name, if they are placed far from it.
        note: what follows the words; never shortened.
    """

    words: str
    around: Box
    kind: str
    colour: str = ""
    tip: str = ""
    icon: tuple[str, str] = ("", "")
    at: Point = (0.0, 0.0)
    leader: tuple[Point, Point] | None = None
    note: str = ""


@dataclass(slots=True)
class Labels:
    """Words placed so far, within a picture of that size in pixels."""

    width: float
    height: float = inf
    _taken: list[Box] = field(default_factory=list)
    _lines: list[NDArray[np.float64]] = field(default_factory=list)
    _areas: list[Polygon] = field(default_factory=list)
    _tree: STRtree | None = None
    placed: list[Label] = field(default_factory=list)

    def keep_off(self, box: Box) -> None:
        """Keep later words off a box."""
        self._taken.append(box)

    def avoid(self, line: Iterable[Point]) -> None:
        """Place later words where they cover little of a line."""
        for (x1, y1), (x2, y2) in pairwise(line):
            count = int(hypot(x2 - x1, y2 - y1) / _SAMPLE) + 1
            share = np.arange(count) / count
            self._lines.append(np.stack((x1 + (x2 - x1) * share, y1 + (y2 - y1) * share), axis=1))

    def lay_out(self, outline: Sequence[Point]) -> None:
        """Keep later words off an area, except those that name something inside of it."""
        area = Polygon(outline) if len(outline) > 2 else Polygon()
        if area.is_valid and not area.is_empty:
            self._areas.append(area)
            self._tree = None

    def put(self, label: Label) -> None:
        """Place words on what they name if it is large enough, else next to it: where they cover least."""
        shown = shortened(label.words) + label.note
        half = width_of(f"{label.icon[0]} {shown}" if label.icon[0] else shown) / 2
        places = [(rank, self._inside(place, half)) for rank, place in _places(label.around, half)]
        costs = self._costs([_box(place, half) for _, place in places], label.around)
        _, at = min((cost + rank, place) for cost, (rank, place) in zip(costs, places, strict=True))
        self._taken.append(_box(at, half + _GAP))
        leader = _leader(label.around, _box(at, half))
        self.placed.append(replace(label, words=shown, at=at, leader=leader))

    def _inside(self, place: Point, half: float) -> Point:
        x = min(max(place[0], half + 4), max(self.width - half - 4, half + 4))
        return x, min(max(place[1], FONT + 2), max(self.height - 5, FONT + 2))

    def _costs(self, boxes: Sequence[Box], around: Box) -> list[float]:
        """Return what is lost where words cover each of the boxes, and name what is around."""
        left, top, right, bottom = np.array(boxes).T[:, :, None]
        taken = np.array(self._taken).reshape(-1, 4).T
        covered = (left <= taken[2]) & (right >= taken[0]) & (top <= taken[3]) & (bottom >= taken[1])
        x, y = self._points().T
        crossed = (left < x) & (x < right) & (top < y) & (y < bottom)
        misleading = self._misleading(boxes, around)
        costs = _COVERING * covered.sum(1) + _MISLEADING * misleading + _CROSSING * crossed.sum(1)
        return [float(cost) for cost in costs]

    def _points(self) -> NDArray[np.float64]:
        """Return points on all lines, east and down in pixels, shape (n, 2)."""
        if len(self._lines) != 1:
            self._lines = [np.concatenate([np.empty((0, 2)), *self._lines])]
        return self._lines[0]

    def _misleading(self, boxes: Sequence[Box], around: Box) -> NDArray[np.int64]:
        """Return how many areas each box meets that do not contain the middle of what is to be named."""
        if self._tree is None:
            self._tree = STRtree(self._areas)
        middle = ShapelyPoint((around[0] + around[2]) / 2, (around[1] + around[3]) / 2)
        box_indices, areas = self._tree.query(box(*np.array(boxes).T), predicate="intersects")
        others = ~np.isin(areas, self._tree.query(middle, predicate="covered_by"))
        return np.bincount(box_indices[others], minlength=len(boxes))


def _leader(named: Box, words: Box) -> tuple[Point, Point] | None:
    """Return a line from words to what they name; None where they are close to it."""
    x, y = (named[0] + named[2]) / 2, (named[1] + named[3]) / 2
    start = min(max(x, words[0]), words[2]), min(max(y, words[1]), words[3])
    end = min(max(start[0], named[0]), named[2]), min(max(start[1], named[1]), named[3])
    return (start, end) if dist(start, end) > _APART else None


def _box(place: Point, half: float) -> Box:
    return place[0] - half, place[1] - FONT, place[0] + half, place[1] + 3


def around(at: Point, reach: float, above: float = 0.0) -> Box:
    """Return the box that reaches so far from a point to all sides, and farther above."""
    return at[0] - reach, at[1] - reach - above, at[0] + reach, at[1] + reach


def _places(around: Box, half: float) -> Iterator[tuple[float, Point]]:
    """Yield (rank, place) for words: on what they name, then next to it, farther and farther away."""
    left, top, right, bottom = around
    x, y = (left + right) / 2, (top + bottom) / 2
    room = right - left > 2 * half and bottom - top > 2 * FONT
    if room:
        aside, rows = (right - left) / 2 - half, (bottom - top) / 2 - FONT
        for i, share in enumerate(_SHARES):
            up = y + 4 + share * rows
            yield from ((i / 2 + j / 2, (x + part * aside, up)) for j, part in enumerate(_SHARES))
    rank = _OUTSIDE if room else 0.0
    for ring in range(_FARTHEST):
        out = ring * _STEP
        rank += _FARTHER
        yield rank, (x, top - 5 - out)
        yield rank, (x, bottom + FONT + 3 + out)
        for beside in (right + half + 5 + out, left - half - 5 - out):
            yield rank + 0.5, (beside, y + 4)
            yield rank + 0.7, (beside, top - 5)
            yield rank + 0.7, (beside, bottom + FONT)
