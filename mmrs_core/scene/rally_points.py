"""Rally points: where each robot lands or surfaces in an emergency, apart from all others if possible."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mmrs_core.geometry.clearance import Vertex, grow, shrink
from mmrs_core.scene.missions import Area, AreaUse
from mmrs_core.scene.primitives import Point


@dataclass(frozen=True, slots=True)
class RallyPoints:
    """The rally points of one robot.

    Attributes:
        points: (east, north) of one in each emergency area that is large enough, metres.
        shared: warning that other robots use the same points; empty where all are the robot's own.
    """

    points: tuple[Point, ...] = ()
    shared: str = ""


def rally_points(
    number: int,
    clearances: Sequence[float],
    areas: Iterable[Area],
    *,
    separation: float | None,
    heights: Iterable[float],
) -> RallyPoints:
    """Return the rally points of one robot of a team, which differ from those of all others.

    Any two points are at least the mission's minimum separation apart, and far enough for no two robots
    to touch. They keep clear of obstacles above and below, and of forbidden areas.

    Args:
        number: of the robot.
        clearances: of every robot: half its diagonal and the position error, metres.
        areas: that concern the robot, as drawn: emergency areas, and areas to keep clear of.
        separation: least distance of two robots, metres.
        heights: that the team's paths lead to, metres above the origin.
    """
    widest, count = max(clearances), len(clearances)
    apart = max(2.0 * widest, separation or 0.0)
    levels = [0.0, *heights]
    low, high = min(levels), max(levels)
    known = list(areas)
    own = [area for area in known if area.use is AreaUse.EMERGENCY]
    others = [a for a in known if a.use is not AreaUse.EMERGENCY and a.low <= high and a.high >= low]

    def found_in(area: Area, keep: float, count: int) -> tuple[Point, ...]:
        barred = tuple((area.shell, area.safety_distance + keep) for area in others)
        return points_in_area(area.shell, area.safety_distance + keep, apart, count, barred)

    found = [found_in(area, widest, count) for area in own]
    if points := tuple(places[number] for places in found if number < len(places)):
        return RallyPoints(points)
    alone = {area.name: found_in(area, clearances[number], 1) for area in own}
    names = ", ".join(f"'{name}'" for name, places in alone.items() if places)
    words = f"in an emergency it may land where others do: there is no room for all robots in {names}"
    shared = words if names and count > 1 else ""
    return RallyPoints(tuple(places[0] for places in alone.values() if places), shared)


Kept = tuple[tuple[Vertex, ...], float]
"""A ring, and the metres that robots keep from it on the outside, too."""

_PER_SIDE = 48
"""Candidates along each side of the box about an area, at most."""

_FINENESS = 4.0
"""Candidates along the least distance between two points."""


@lru_cache(maxsize=64)
def points_in_area(
    ring: tuple[Vertex, ...], keep: float, apart: float, count: int, barred: tuple[Kept, ...] = ()
) -> tuple[Vertex, ...]:
    """Return points inside a ring, as far apart as there is room; fewer than `count` where it has none.

    Args:
        ring: of the area.
        keep: metres from the edge to every point, at least.
        apart: metres between two points, at least.
        count: how many are wanted; the first one does not depend on it.
        barred: what no point may be in, nor nearer to.
    """
    free = shrink(ring, keep).difference(shapely.union_all([grow(*each) for each in barred]))
    parts = [part for part in _parts(free) if part.area > 0]
    if not parts or count < 1:
        return ()
    inside = max(parts, key=lambda part: float(part.area))
    first = inside.representative_point()
    found = [(float(first.x), float(first.y))]
    places = _candidates(inside, apart) if count > 1 else np.empty((0, 2))
    away = _distances(places, found[0])
    while len(found) < count and away.size and away.max() >= apart:
        east, north = places[int(away.argmax())].tolist()
        found.append((east, north))
        away = np.minimum(away, _distances(places, found[-1]))
    return tuple(found)


def _parts(shape: BaseGeometry) -> list[BaseGeometry]:
    return list(getattr(shape, "geoms", [shape]))


def _candidates(inside: BaseGeometry, apart: float) -> NDArray[np.float64]:
    """Return (n, 2) corners of the shape and points of a grid over it that lie in it."""
    west, south, east, north = inside.bounds
    step = max(apart / _FINENESS, max(east - west, north - south) / _PER_SIDE, 1e-3)
    grid = np.meshgrid(np.arange(west, east + step, step), np.arange(south, north + step, step))
    points = np.column_stack([each.ravel() for each in grid])
    within = points[shapely.contains_xy(inside, points[:, 0], points[:, 1])]
    return np.concatenate([shapely.get_coordinates(inside), within])


def _distances(places: NDArray[np.float64], point: Vertex) -> NDArray[np.float64]:
    found: NDArray[np.float64] = np.hypot(places[:, 0] - point[0], places[:, 1] - point[1])
    return found
