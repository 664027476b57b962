"""What a robot must keep out of: areas grown by its clearance, and which of them a leg is too near to.

Sideways an area grows by a polygon about the true circle, up and down by the clearance itself. Two
sizes are kept: the smaller one blocks, the larger one lends its corners to routes, so that a leg from
corner to corner along an area's side is clear of it whatever the rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon
from shapely.geometry.polygon import orient

from mmrs_core.geometry.clearance import EPSILON, grow
from mmrs_core.scene import Area

Floats: TypeAlias = NDArray[np.float64]
Flags: TypeAlias = NDArray[np.bool_]

HEIGHT_MARGIN = 1e-9
"""Metres of rounding: so much within a band of heights, or a distance, still counts as at its edge."""


@dataclass(frozen=True, slots=True)
class Grown:
    """An area grown by a robot's clearance.

    Attributes:
        area: as drawn.
        clearance: metres to keep, safety distance included.
        low, high: heights strictly between which it blocks.
        corners: (n, 2) corners that routes may turn at, those of inner courts included.
        before, after: (n, 2) each corner's neighbours along its ring.
    """

    area: Area
    clearance: float
    low: float
    high: float
    corners: Floats
    before: Floats
    after: Floats


class Obstacles:
    """All grown areas of one robot, with an index by place."""

    def __init__(self, areas: Sequence[Area], clearance: float) -> None:
        """Grow the areas.

        Args:
            areas: to keep away from.
            clearance: of the robot, metres; each area's safety distance comes on top.
        """
        self.grown = tuple(_grown(area, area.safety_distance + clearance) for area in areas)
        self.low = np.array([each.low for each in self.grown])
        self.high = np.array([each.high for each in self.grown])
        self._clearance = np.array([each.clearance for each in self.grown])
        self._drawn = np.array([Polygon(each.area.shell) for each in self.grown], dtype=np.object_)
        smaller = [grow(each.area.shell, each.clearance, margin=EPSILON / 2) for each in self.grown]
        self._blocked = np.array(smaller, dtype=np.object_)
        shapely.prepare(self._blocked)
        self._tree = shapely.STRtree(self._blocked)

    def __len__(self) -> int:
        return len(self.grown)

    def blocking(self, legs: Floats, *, spare: float = EPSILON / 2) -> Flags:
        """Return (n, areas): which areas each of n straight legs (n, 2, 3) is too near to.

        A leg is too near where its part between an area's heights meets the grown shape, unless the
        exact distance sideways is enough after all: growing gives a little away.

        Args:
            legs: (n, 2, 3).
            spare: metres to keep on top of clearances, for what is lost when coordinates are rounded.
        """
        found = np.zeros((len(legs), len(self)), dtype=np.bool_)
        leg, area = self._meetings(legs[:, :, :2])
        if not len(leg):
            return found
        first, last = self._between_heights(legs[leg], area)
        inside = first < last - 1e-12
        leg, area, first, last = leg[inside], area[inside], first[inside], last[inside]
        start, offset = legs[leg, 0], legs[leg, 1] - legs[leg, 0]
        parts = np.stack([start + first[:, None] * offset, start + last[:, None] * offset], axis=1)[:, :, :2]
        shorter = (first > 0.0) | (last < 1.0)
        hit = np.ones(len(leg), dtype=np.bool_)
        hit[shorter] = shapely.intersects(self._blocked[area[shorter]], shapely.linestrings(parts[shorter]))
        hit[hit] = self._too_near(parts[hit], area[hit], spare)
        found[leg[hit], area[hit]] = True
        return found

    def blocks_at(self, height: float) -> Flags:
        """Return (areas,): which areas block at a height."""
        blocks: Flags = (self.low + HEIGHT_MARGIN < height) & (height < self.high - HEIGHT_MARGIN)
        return blocks

    def crossed(self, lines: Floats) -> Flags:
        """Return (n, areas): which areas each of n lines (n, 2, 2) in the plane is too near to.

        Exact distances count only for lines that begin or end in a shape's rim; others that just touch
        one count as crossing it.
        """
        found = np.zeros((len(lines), len(self)), dtype=np.bool_)
        line, area = self._meetings(lines)
        hit = np.ones(len(line), dtype=np.bool_)
        rim = self._in_rim(lines[line], area)
        hit[rim] = self._too_near(lines[line[rim]], area[rim], EPSILON / 2)
        found[line[hit], area[hit]] = True
        return found

    def _meetings(self, lines: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Return pairs (line, area) that meet in the plane."""
        if not len(self) or not len(lines):
            nothing = np.empty(0, dtype=np.intp)
            return nothing, nothing
        pairs = self._tree.query(shapely.linestrings(lines), predicate="intersects")
        return pairs[0], pairs[1]

    def _in_rim(self, lines: Floats, area: NDArray[np.intp]) -> Flags:
        """Return, for pairs that meet, whether the line has an end within the grown shape."""
        shapes = self._blocked[area]
        rim: Flags = shapely.intersects_xy(shapes, lines[:, 0, 0], lines[:, 0, 1])
        rim |= shapely.intersects_xy(shapes, lines[:, 1, 0], lines[:, 1, 1])
        return rim

    def _too_near(self, lines: Floats, area: NDArray[np.intp], spare: float) -> Flags:
        """Return, for pairs that meet, whether the exact distance sideways is too small.

        A line may not come nearer than the clearance and a spare distance; one that has an end nearer
        than that, no nearer than its end.
        """
        drawn, clearance = self._drawn[area], self._clearance[area]
        at_ends = np.minimum(
            shapely.distance(shapely.points(lines[:, 0]), drawn),
            shapely.distance(shapely.points(lines[:, 1]), drawn),
        )
        needed = np.clip(at_ends, clearance, clearance + spare)
        near: Flags = shapely.distance(shapely.linestrings(lines), drawn) < needed - HEIGHT_MARGIN
        return near

    def _between_heights(self, legs: Floats, area: NDArray[np.intp]) -> tuple[Floats, Floats]:
        """Return the share of each leg (from, to) in which it is between its area's heights."""
        low, high = self.low[area] + HEIGHT_MARGIN, self.high[area] - HEIGHT_MARGIN
        start, rise = legs[:, 0, 2], legs[:, 1, 2] - legs[:, 0, 2]
        level = np.abs(rise) < HEIGHT_MARGIN
        slope = np.where(level, 1.0, rise)
        one, two = (low - start) / slope, (high - start) / slope
        first = np.clip(np.minimum(one, two), 0.0, 1.0)
        last = np.clip(np.maximum(one, two), 0.0, 1.0)
        between = (start > low) & (start < high)
        return np.where(level, 0.0, first), np.where(level, np.where(between, 1.0, 0.0), last)

    def names(self, areas: Flags) -> str:
        """Return the names of flagged areas, quoted, in alphabetical order."""
        return ", ".join(sorted(f"'{self.grown[i].area.name}'" for i in np.flatnonzero(areas).tolist()))


def _grown(area: Area, clearance: float) -> Grown:
    larger = grow(area.shell, clearance, margin=EPSILON)
    corners, before, after = _corners(larger)
    return Grown(area, clearance, area.low - clearance, area.high + clearance, corners, before, after)


def _corners(shape: Polygon) -> tuple[Floats, Floats, Floats]:
    """Return the corners at which a short offset around a shape may turn, and their neighbours.

    These are the ones that stick out; with the shape to the left, its rings turn left there.
    """
    turned = orient(shape)
    found = []
    for ring in (turned.exterior, *turned.interiors):
        at = shapely.get_coordinates(ring)[:-1]
        before, after = np.roll(at, 1, axis=0), np.roll(at, -1, axis=0)
        come, go = at - before, after - at
        out = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0] > 0.0
        found.append((at[out], before[out], after[out]))
    corners, befores, afters = zip(*found, strict=True)
    return np.concatenate(corners), np.concatenate(befores), np.concatenate(afters)
