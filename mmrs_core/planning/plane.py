"""Shortest ways in the plane, at one height, among the grown areas that block there."""

from __future__ import annotations

from collections.abc import Iterator
from heapq import heappop, heappush
from math import hypot, inf

import numpy as np
from numpy.typing import NDArray

from mmrs_core.planning.obstacles import Flags, Obstacles
from mmrs_core.planning.sight import GOAL, START, Corner, Place, Sight


def shortest_way(
    obstacles: Obstacles, sight: Sight, start: Place, goal: Place, blocks: Flags, longest: float = inf
) -> list[Place] | None:
    """Return the shortest way around the areas that block; None if there is none within `longest`.

    Only areas that cross the best way found so far count, until a way among these crosses no other:
    as leaving areas out can only make ways shorter, that one is the shortest of all.

    Args:
        obstacles: of the robot.
        sight: over the same obstacles.
        start: where the way begins.
        goal: where it ends.
        blocks: (areas,) which areas block at the height.
        longest: metres beyond which a way is of no use.
    """
    active = sight.between(start, goal) & blocks
    while True:
        way = _around(obstacles, sight, start, goal, np.flatnonzero(active), longest)
        if way is None:
            return None
        legs = np.array([way[:-1], way[1:]]).swapaxes(0, 1)
        fresh = obstacles.crossed(legs).any(axis=0) & blocks & ~active
        if not fresh.any():
            return way
        active = active | fresh


def _around(
    obstacles: Obstacles,
    sight: Sight,
    start: Place,
    goal: Place,
    active: NDArray[np.intp],
    longest: float,
) -> list[Place] | None:
    """Return the shortest way around the active areas by A* over tangents."""
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
        for there, place, length in _onwards(obstacles, sight, here, places[here], goal, active):
            reached = best[here] + length
            if reached < best.get(there, inf) - 1e-12:
                best[there], came[there], places[there] = reached, here, place
                heappush(queue, (reached + hypot(goal[0] - place[0], goal[1] - place[1]), there))
    return None


def _onwards(
    obstacles: Obstacles,
    sight: Sight,
    here: Corner,
    place: Place,
    goal: Place,
    active: NDArray[np.intp],
) -> Iterator[tuple[Corner, Place, float]]:
    """Yield where one can go on to: (corner, its place, metres)."""
    if not sight.between(place, goal)[active].any():
        yield GOAL, goal, hypot(goal[0] - place[0], goal[1] - place[1])
    for area in active.tolist():
        found = sight.tangents(place, here, area)
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
