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

from mmrs_core.geometry.clearance import EPSILON, grow_all
from mmrs_core.scene import Area

Floats: TypeAlias = NDArray[np.float64]
Flags: TypeAlias = NDArray[np.bool_]

HEIGHT_MARGIN = 1e-9
"""Metres of rounding: so much within a band of heights, or a distance, still counts as at its edge."""

_SIDES, _PARTS = 4.0, 256
"""Pieces of long lines are so many times as long as areas are wide, but no more than so many."""


@dataclass(frozen=True, slots=True)
class Outlines:
    """The rings of many shapes, each shape to the left, as places one after the other.

    Attributes:
        places: (n, 2) corners, no ring's first one repeated at its end.
        before, after: (n,) which place is the neighbour along the ring.
        shape: (n,) which shape the ring is of; ascends.
    """

    places: Floats
    before: NDArray[np.intp]
    after: NDArray[np.intp]
    shape: NDArray[np.intp]


def outlines_of(shapes: NDArray[np.object_]) -> Outlines:
    """Return the rings of polygons, outer and inner."""
    rings, shape = shapely.get_rings(shapes, return_index=True)
    inner = np.concatenate([[False], shape[1:] == shape[:-1]]) if len(shape) else np.empty(0, np.bool_)
    turned = shapely.is_ccw(rings) == inner
    rings[turned] = shapely.reverse(rings[turned])
    places, ring = shapely.get_coordinates(rings, return_index=True)
    closing = np.concatenate([ring[1:] != ring[:-1], [True]]) if len(ring) else np.empty(0, np.bool_)
    places, ring = places[~closing], ring[~closing]
    here = np.arange(len(ring))
    first = np.flatnonzero(np.diff(ring, prepend=-1))
    last = np.append(first[1:], len(ring))[: len(first)] - 1
    before, after = here - 1, here + 1
    before[first], after[last] = last, first
    return Outlines(places, before, after, shape[ring])


class Obstacles:
    """All areas that one robot keeps away from, grown by its clearance, with an index by place.

    Attributes:
        areas: as drawn.
        clearance: metres to keep from each, safety distance included.
        low, high: heights strictly between which each blocks.
        larger, smaller: shapes that lend their corners to routes, and that block.
        drawn: shapes as drawn.
    """

    def __init__(self, areas: Sequence[Area], clearance: float) -> None:
        """Grow the areas.

        Args:
            areas: to keep away from.
            clearance: of the robot, metres; each area's safety distance comes on top.
        """
        self.areas = tuple(areas)
        self.clearance = np.array([area.safety_distance + clearance for area in areas], dtype=np.float64)
        self.low = np.array([area.low for area in areas], dtype=np.float64) - self.clearance
        self.high = np.array([area.high for area in areas], dtype=np.float64) + self.clearance
        shells, distances = [area.shell for area in areas], self.clearance.tolist()
        self.larger = grow_all(shells, distances)
        self.smaller = grow_all(shells, distances, margin=EPSILON / 2)
        self.drawn = np.array([Polygon(shell) for shell in shells], dtype=np.object_)
        shapely.prepare(self.smaller)
        self._corners: list[Floats] | None = None
        boxes = shapely.bounds(self.smaller).reshape(-1, 2, 2)
        self._boxes = (np.column_stack([boxes[:, 0], self.low]), np.column_stack([boxes[:, 1], self.high]))
        sides = np.diff(boxes, axis=1)
        self._piece = _SIDES * float(sides.mean()) if len(areas) else 1.0
        self._tree = shapely.STRtree(self.smaller)

    def __len__(self) -> int:
        return len(self.areas)

    def corners(self) -> tuple[Floats, Floats, Floats, NDArray[np.intp]]:
        """Return where routes may turn: corners that stick out, the ones before and after, whose they are.

        With the shape to the left, its rings turn left there.
        """
        rings = outlines_of(self.larger)
        before, after = rings.places[rings.before], rings.places[rings.after]
        come, go = rings.places - before, after - rings.places
        out = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0] > 0.0
        return rings.places[out], before[out], after[out], rings.shape[out]

    def corners_of(self, area: int) -> Floats:
        """Return (n, 2): where routes may turn around an area."""
        if self._corners is None:
            corners, _, _, of = self.corners()
            self._corners = np.split(corners, np.searchsorted(of, np.arange(1, len(self))))
        return self._corners[area]

    def blocking(self, legs: Floats, *, spare: float = EPSILON / 2) -> Flags:
        """Return (n, areas): which areas each of n straight legs (n, 2, 3) is too near to.

        A leg is too near where its part between an area's heights meets the grown shape, unless the
        exact distance sideways is enough after all: growing gives a little away.

        Args:
            legs: (n, 2, 3).
            spare: metres to keep on top of clearances, for what is lost when coordinates are rounded.
        """
        found = np.zeros((len(legs), len(self)), dtype=np.bool_)
        if len(legs) == 1 and self._is_far(legs[0]):
            return found
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
        hit[shorter] = shapely.intersects(self.smaller[area[shorter]], shapely.linestrings(parts[shorter]))
        hit[hit] = self._too_near(parts[hit], area[hit], spare)
        found[leg[hit], area[hit]] = True
        return found

    def _is_far(self, leg: Floats) -> bool:
        """Return whether the box about a leg, heights included, meets that of no grown shape."""
        low, high = np.minimum(leg[0], leg[1]), np.maximum(leg[0], leg[1])
        return not ((self._boxes[0] <= high) & (self._boxes[1] >= low)).all(axis=1).any()

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
        """Return pairs (line, area) that meet in the plane.

        The tree knows boxes only, which are large about long lines: these are looked up in pieces.
        """
        if not len(self) or not len(lines):
            nothing = np.empty(0, dtype=np.intp)
            return nothing, nothing
        parts = np.ceil(np.abs(lines[:, 1] - lines[:, 0]).max(axis=1) / self._piece)
        parts = np.clip(parts, 1, _PARTS).astype(np.intp)
        line = np.repeat(np.arange(len(lines)), parts)
        share = (np.arange(len(line)) - (np.cumsum(parts) - parts)[line])[:, None] / parts[line, None]
        start, offset = lines[line, 0], lines[line, 1] - lines[line, 0]
        pieces = np.stack(
            [start + share * offset, start + (share + 1.0 / parts[line, None]) * offset], axis=1
        )
        piece, area = self._tree.query(shapely.linestrings(pieces), predicate="intersects")
        met = np.unique(line[piece] * len(self) + area)
        return met // len(self), met % len(self)

    def _in_rim(self, lines: Floats, area: NDArray[np.intp]) -> Flags:
        """Return, for pairs that meet, whether the line has an end within the grown shape."""
        shapes = self.smaller[area]
        rim: Flags = shapely.intersects_xy(shapes, lines[:, 0, 0], lines[:, 0, 1])
        rim |= shapely.intersects_xy(shapes, lines[:, 1, 0], lines[:, 1, 1])
        return rim

    def _too_near(self, lines: Floats, area: NDArray[np.intp], spare: float) -> Flags:
        """Return, for pairs that meet, whether the exact distance sideways is too small.

        A line may not come nearer than the clearance and a spare distance; one that has an end nearer
        than that, no nearer than its end.
        """
        drawn, clearance = self.drawn[area], self.clearance[area]
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
        return ", ".join(sorted(f"'{self.areas[i].name}'" for i in np.flatnonzero(areas).tolist()))
