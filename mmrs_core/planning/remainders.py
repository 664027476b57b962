"""What is left of a task for one sort of robots when others have done a part of it.

Robots of different sorts have works of their own for one task: other swaths, heights, devices, gaps.
These are compared part by part (see `parts_of`). Over an area a part is done when others have covered
the ground that it covers; elsewhere when they have done the same stretch, see `Stroke.part`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mmrs_core.geometry.polygons import parts
from mmrs_core.geometry.stretches import merged
from mmrs_core.planning.footprints import GRID, footprint
from mmrs_core.planning.lines import Swath
from mmrs_core.planning.strokes import length_of, parts_of
from mmrs_core.scene import Coverage, Position, Stroke, Work

_ROUNDING = 1e-6
"""Share of a part's ground, and length of a stretch, that are rounding."""

_THIN = 1e-3
"""Metres of width of patches that count as covered: strips of two sorts that are laid alike but for a little,
since they keep away from areas by different distances, would be gone along twice for these."""

Shapes: TypeAlias = NDArray[np.object_]
_Part: TypeAlias = tuple[int, int]
"""A sort, and the index of a part of its work."""

_Stretch: TypeAlias = tuple[str | tuple[Position, ...], float, float]
"""Which part of the task, and from where to where of it."""


@dataclass(frozen=True, slots=True)
class Turn:
    """What robots of one sort do, of what those before them have left.

    Attributes:
        sort: index of it.
        left: indices of the parts of their work that those before have left.
        done: those that they do.
    """

    sort: int
    left: frozenset[int]
    done: frozenset[int]


def comparable(one: Work, other: Work) -> bool:
    """Return whether some of one work can be left out since robots with the other have done it."""
    if not (one.divisible and other.divisible):
        return False
    if one.coverage is not None and other.coverage is not None:
        return bool(one.coverage.target and other.coverage.target)
    return bool({line for line, _, _ in _stretches(one)} & {line for line, _, _ in _stretches(other)})


class Remainders:
    """The works of one task for sorts of robots that can share it.

    Attributes:
        parts: by sort: strokes of its work, split at all cuts.
    """

    def __init__(self, works: Sequence[Work]) -> None:
        """Prepare it for works, all of which are comparable with each other."""
        self.parts = [tuple(part for stroke in work.strokes for part in parts_of(stroke)) for work in works]
        self._over_ground = all(work.coverage is not None for work in works)
        self._works = works
        self._covered: dict[int, Shapes] = {}
        self._ground: dict[int, Shapes] = {}
        self._patches: dict[_Part, list[int]] = {}
        self._under: dict[tuple[int, int], list[list[int]]] = {}

    def left(self, sort: int, before: Sequence[Turn]) -> frozenset[int]:
        """Return the indices of the parts of a sort that others have not done as a whole."""
        if not before:
            return frozenset(range(len(self.parts[sort])))
        found = self._bare(sort, before) if self._over_ground else self._open(sort, before)
        return frozenset(found)

    def _bare(self, sort: int, before: Sequence[Turn]) -> Iterator[int]:
        """Yield the parts under which some ground is not covered by what others have done."""
        done = sum(self._bit(turn.sort, part) for turn in before for part in turn.done)
        for part in range(len(self.parts[sort])):
            if not all(done & by for by in self._patches_of(sort, part)):
                yield part

    def _bit(self, sort: int, part: int) -> int:
        """Return the bit of a part in sets of parts, which are numbers: very many are compared."""
        return 1 << sum(map(len, self.parts[:sort])) + part

    def _patches_of(self, sort: int, part: int) -> list[int]:
        """Return, for each patch of the ground under a part, the set of parts of other sorts that cover it.

        Patches that are covered wherever another one is are left out, and those that are rounding or thin.
        """
        if (sort, part) not in self._patches:
            own, alike = self._ground_of(sort)[part], dict[bytes, int]()
            for other in range(len(self.parts)):
                for each in self._under_of(sort, other)[part] if other != sort else ():
                    shape = shapely.to_wkb(self._covered_by(other)[each])
                    alike[shape] = alike.get(shape, 0) | self._bit(other, each)
            shapes = shapely.from_wkb(list(alike))
            inner = shapely.intersection(shapely.boundary(shapes), own)
            edges = shapely.union_all([shapely.boundary(own), *inner], grid_size=GRID)
            patches = shapely.get_parts(shapely.polygonize(shapely.get_parts(edges)))
            patches = patches[2.0 * shapely.area(patches) > _THIN * shapely.length(patches)]
            patches = patches[np.argsort(shapely.area(patches), kind="stable")]
            whole = np.cumsum(shapely.area(patches)) > _ROUNDING * (1.0 + own.area)
            inside = shapely.point_on_surface(patches[whole])
            inside = inside[shapely.covers(own, inside)]
            by = [0 for _ in inside]
            for others, shape in zip(alike.values(), shapes, strict=True):
                for index in np.flatnonzero(shapely.covers(shape, inside)).tolist():
                    by[index] |= others
            self._patches[sort, part] = _smallest(by)
        return self._patches[sort, part]

    def _ground_of(self, sort: int) -> Shapes:
        """Return what each part of a sort's work covers of its target."""
        if sort not in self._ground:
            coverage, shapes = self._works[sort].coverage, self._covered_by(sort).copy()
            assert coverage is not None
            target = shapely.union_all([shapely.Polygon(*rings) for rings in coverage.target], grid_size=GRID)
            shapely.prepare(target)
            inside = shapely.covers(target, shapes)
            cut = shapely.intersection(shapes[~inside], target, grid_size=GRID)
            shapes[~inside] = [shapely.MultiPolygon(parts(each)) for each in cut]
            self._ground[sort] = shapes
        return self._ground[sort]

    def _covered_by(self, sort: int) -> Shapes:
        """Return what each part of a sort's work covers, also beyond its target."""
        if sort not in self._covered:
            coverage = self._works[sort].coverage
            assert coverage is not None
            shapes = [_ground(part, coverage) for part in self.parts[sort]]
            self._covered[sort] = np.array(shapes, dtype=object)
        return self._covered[sort]

    def _under_of(self, sort: int, other: int) -> list[list[int]]:
        """Return, by part of a sort, the parts of another one that cover some of the same ground."""
        if (sort, other) not in self._under:
            found: list[list[int]] = [[] for _ in self.parts[sort]]
            near = shapely.STRtree(self._covered_by(other)).query(self._ground_of(sort), "intersects")
            for part, each in near.T.tolist():
                if self.parts[sort][part].part == self.parts[other][each].part:
                    found[part].append(each)
            self._under[sort, other] = found
        return self._under[sort, other]

    def _open(self, sort: int, before: Sequence[Turn]) -> Iterator[int]:
        """Yield the parts of which some stretch is not yet done."""
        done: dict[object, list[tuple[float, float]]] = {}
        waiting: dict[object, list[tuple[float, float]]] = {}
        for turn in before:
            for part, (line, begin, end) in enumerate(_stretches(self._works[turn.sort])):
                if part in turn.left:
                    known = done if part in turn.done else waiting
                    known.setdefault(line, []).append((begin, end))
        for part, (line, begin, end) in enumerate(_stretches(self._works[sort])):
            if not _holds(merged(done.get(line, ())), begin, end) or any(
                _overlap(each, (begin, end)) for each in waiting.get(line, ())
            ):
                yield part


def _smallest(sets: Iterable[int]) -> list[int]:
    """Return those sets of bits that hold no other one."""
    found: list[int] = []
    for each in sorted(set(sets), key=int.bit_count):
        if not any(other & each == other for other in found):
            found.append(each)
    return found


def _ground(part: Stroke, coverage: Coverage) -> BaseGeometry:
    points = np.array([point[:2] for point in part.points])
    spots = part.spots
    if coverage.length > 0.0 and not spots:
        return shapely.Polygon()
    return footprint([Swath(points, spots)], coverage.width, coverage.length)


def _stretches(work: Work) -> Iterator[_Stretch]:
    """Yield the stretch of each part of a work."""
    for stroke in work.strokes:
        begin, end = stroke.stretch
        step = (end - begin) / (length_of(stroke.points) or 1.0)
        stops = [begin, *(begin + cut * step for cut in stroke.cuts), end]
        yield from ((stroke.part or stroke.points, min(pair), max(pair)) for pair in pairwise(stops))


def _holds(stretches: Sequence[tuple[float, float]], begin: float, end: float) -> bool:
    return any(a <= begin + _ROUNDING and end - _ROUNDING <= b for a, b in stretches)


def _overlap(one: tuple[float, float], other: tuple[float, float]) -> bool:
    return min(one[1], other[1]) - max(one[0], other[0]) > _ROUNDING
