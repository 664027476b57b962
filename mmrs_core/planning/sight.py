"""What lies in the way between places and the corners of grown areas; remembered between queries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.planning.obstacles import Flags, Floats, Obstacles

Place: TypeAlias = tuple[float, float]

START, GOAL = (-1, 0), (-1, 1)
Corner: TypeAlias = tuple[int, int]
"""(area, index of the corner); START and GOAL stand for the ends of a route."""


@dataclass(frozen=True, slots=True)
class Tangents:
    """Lines from a place that touch an area's corners and do not run into the area there.

    Attributes:
        corners: (k,) indices of the corners.
        lengths: (k,) metres.
        crossed: (k, areas) what lies between.
    """

    corners: NDArray[np.intp]
    lengths: Floats
    crossed: Flags


class Sight:
    """Answers which grown areas lie across straight lines in the plane, heights aside."""

    def __init__(self, obstacles: Obstacles) -> None:
        self._obstacles = obstacles
        self._tangents: dict[tuple[Place, int], Tangents] = {}
        self._rows: dict[tuple[Place, int], Flags] = {}
        self._pairs: dict[tuple[Place, Place], Flags] = {}

    def tangents(self, place: Place, corner: Corner, area: int) -> Tangents:
        """Return the tangents from a place to an area.

        Args:
            place: where they begin.
            corner: which corner that is; where it is one, they must touch its own area likewise.
            area: whose corners they end at.
        """
        known = self._tangents.get((place, area))
        if known is None:
            known = self._tangents[place, area] = self._find_tangents(np.array(place), corner, area)
        return known

    def _find_tangents(self, place: Floats, corner: Corner, area: int) -> Tangents:
        goals = self._obstacles.grown[area]
        way = goals.corners - place
        lengths = np.hypot(way[:, 0], way[:, 1])
        useful = _same_side(way, goals.before - goals.corners, goals.after - goals.corners)
        if corner[0] >= 0:
            own = self._obstacles.grown[corner[0]]
            here = own.corners[corner[1]]
            useful &= _same_side(way, own.before[corner[1]] - here, own.after[corner[1]] - here)
        picks = np.flatnonzero(useful & (lengths > 1e-9))
        lines = np.stack([np.broadcast_to(place, (len(picks), 2)), goals.corners[picks]], axis=1)
        return Tangents(picks, lengths[picks], self._obstacles.crossed(lines))

    def to_corners(self, place: Place, area: int) -> Flags:
        """Return (corners of the area, areas): what lies between a place and each corner."""
        row = self._rows.get((place, area))
        if row is None:
            corners = self._obstacles.grown[area].corners
            lines = np.stack([np.broadcast_to(np.array(place), corners.shape), corners], axis=1)
            row = self._rows[place, area] = self._obstacles.crossed(lines)
        return row

    def between(self, one: Place, two: Place) -> Flags:
        """Return (areas,): what lies between two places, or over one place if they are the same."""
        flags = self._pairs.get((one, two))
        if flags is None:
            flags = self._pairs[one, two] = self._obstacles.crossed(np.array([[one, two]]))[0]
        return flags


def _same_side(way: Floats, before: Floats, after: Floats) -> Flags:
    """Return whether both neighbours of a corner lie on one side of the line through it."""
    left = way[..., 0] * before[..., 1] - way[..., 1] * before[..., 0]
    right = way[..., 0] * after[..., 1] - way[..., 1] * after[..., 0]
    same: Flags = left * right >= -1e-9
    return same
