"""Shortest paths in the plane, at one altitude, by lines of sight to corners of grown areas."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from heapq import heappop, heappush
from math import hypot, inf
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


class Visibility:
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
        offset = goals.corners - place
        lengths = np.hypot(offset[:, 0], offset[:, 1])
        useful = _same_side(offset, goals.before - goals.corners, goals.after - goals.corners)
        if corner[0] >= 0:
            own = self._obstacles.grown[corner[0]]
            here = own.corners[corner[1]]
            useful &= _same_side(offset, own.before[corner[1]] - here, own.after[corner[1]] - here)
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


def _same_side(offset: Floats, before: Floats, after: Floats) -> Flags:
    """Return whether both neighbours of a corner lie on one side of the line through it."""
    left = offset[..., 0] * before[..., 1] - offset[..., 1] * before[..., 0]
    right = offset[..., 0] * after[..., 1] - offset[..., 1] * after[..., 0]
    same: Flags = left * right >= -1e-9
    return same


def shortest_path(
    obstacles: Obstacles,
    visibility: Visibility,
    start: Place,
    goal: Place,
    blocks: Flags,
    longest: float = inf,
) -> list[Place] | None:
    """Return the shortest path around the areas that block; None if there is none within `longest`.

    Only areas that cross the best path found so far count, until a path among these crosses no other:
    as leaving areas out can only make paths shorter, that one is the shortest of all.

    Args:
        obstacles: of the robot.
        visibility: over the same obstacles.
        start: where the path begins.
        goal: where it ends.
        blocks: (areas,) which areas block at the height.
        longest: metres beyond which a path is of no use.
    """
    active = visibility.between(start, goal) & blocks
    while True:
        path = _around(obstacles, visibility, start, goal, np.flatnonzero(active), longest)
        if path is None:
            return None
        legs = np.array([path[:-1], path[1:]]).swapaxes(0, 1)
        fresh = obstacles.crossed(legs).any(axis=0) & blocks & ~active
        if not fresh.any():
            return path
        active = active | fresh


def _around(
    obstacles: Obstacles,
    visibility: Visibility,
    start: Place,
    goal: Place,
    active: NDArray[np.intp],
    longest: float,
) -> list[Place] | None:
    """Return the shortest path around the active areas by A* over tangents."""
    best: dict[Corner, float] = {START: 0.0}
    came: dict[Corner, Corner] = {}
    places: dict[Corner, Place] = {START: start, GOAL: goal}
    queue = [(hypot(goal[0] - start[0], goal[1] - start[1]), START)]
    done: set[Corner] = set()
    while queue:
        bound, here = heappop(queue)
        if bound > longest:
            return None
        if here == GOAL:
            return _back(came, places)
        if here in done:
            continue
        done.add(here)
        for there, place, length in _onwards(obstacles, visibility, here, places[here], goal, active):
            reached = best[here] + length
            if reached < best.get(there, inf) - 1e-12:
                best[there], came[there], places[there] = reached, here, place
                heappush(queue, (reached + hypot(goal[0] - place[0], goal[1] - place[1]), there))
    return None


def _onwards(
    obstacles: Obstacles,
    visibility: Visibility,
    here: Corner,
    place: Place,
    goal: Place,
    active: NDArray[np.intp],
) -> Iterator[tuple[Corner, Place, float]]:
    """Yield the corners that can be reached next: (corner, its place, metres)."""
    if not visibility.between(place, goal)[active].any():
        yield GOAL, goal, hypot(goal[0] - place[0], goal[1] - place[1])
    for area in active.tolist():
        found = visibility.tangents(place, here, area)
        free = np.flatnonzero(~found.crossed[:, active].any(axis=1))
        corners = obstacles.grown[area].corners[found.corners[free]].tolist()
        for corner, (east, north), length in zip(
            found.corners[free].tolist(), corners, found.lengths[free].tolist(), strict=True
        ):
            yield (area, corner), (east, north), length


def _back(came: dict[Corner, Corner], places: dict[Corner, Place]) -> list[Place]:
    corners = [GOAL]
    while corners[-1] in came:
        corners.append(came[corners[-1]])
    return [places[corner] for corner in reversed(corners)]
