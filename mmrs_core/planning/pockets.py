"""Pockets: places that areas close in at all altitudes, unreachable from outside."""

from __future__ import annotations

from functools import lru_cache

import shapely
from shapely.geometry import Point, Polygon

from mmrs_core.geometry.clearance import grow
from mmrs_core.geometry.polygons import parts
from mmrs_core.scene import Position, Ring, Robot, Scene

_TOUCHING = 1e-3
"""Metres up to which an area is beside a pocket."""

_REMEMBERED = 32
"""Robots at most whose pockets are kept for their next line."""


def pockets_of(robot: Robot, scene: Scene) -> tuple[tuple[Polygon, tuple[str, ...]], ...]:
    """Return what a robot cannot get into from home, and the names of the areas around it.

    There is none where its home lies in a pocket, or where nothing is known of its heights.
    """
    if robot.kinematics is None:
        return ()
    floor, ceiling = robot.kinematics.floor, robot.kinematics.ceiling
    clearance = robot.clearance
    walls = tuple(
        (area.name, tuple(area.shell), area.safety_distance + clearance)
        for area in scene.kept_from(robot)
        if area.low - area.safety_distance - clearance < floor
        and area.high + area.safety_distance + clearance > ceiling
    )
    return _pockets(walls, robot.home)


@lru_cache(maxsize=_REMEMBERED)
def _pockets(
    walls: tuple[tuple[str, Ring, float], ...], home: Position
) -> tuple[tuple[Polygon, tuple[str, ...]], ...]:
    grown = {name: grow(shell, distance) for name, shell, distance in walls}
    whole = parts(shapely.union_all(list(grown.values())))
    found = [Polygon(hole) for part in whole for hole in part.interiors]
    if any(pocket.covers(Point(home[:2])) for pocket in found):
        return ()
    return tuple(
        (pocket, tuple(name for name, shape in grown.items() if shape.distance(pocket) < _TOUCHING))
        for pocket in found
    )
