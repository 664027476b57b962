"""The ways by which simulated robots respond to faults."""

from __future__ import annotations

from math import dist

from shapely.geometry import Polygon

from mmrs_core.contributions.execution import BackendInput
from mmrs_core.scene import AreaUse, Position


def escape_path(response: str, here: Position, home: Position, given: BackendInput) -> tuple[Position, ...]:
    """Return the straight way that a response takes; `here` alone where the robot stays.

    Ways home and to emergency areas are level first, then down to the height of home; obstacles are
    not gone around. Where there is no emergency area the robot comes down where it is.
    """
    if response == "LAND":
        return _down((here,), home)
    if response == "SURFACE":
        return (here, (here[0], here[1], given.program.frame.surface))
    if response == "RETURN":
        return _down((here, (home[0], home[1], here[2])), home)
    if response == "EMERGENCY_AREA":
        refuge = _refuge(here, given)
        return _down((here,) if refuge is None else (here, refuge), home)
    return (here,)


def _down(path: tuple[Position, ...], home: Position) -> tuple[Position, ...]:
    east, north, up = path[-1]
    return path if up == home[2] else (*path, (east, north, home[2]))


def _refuge(here: Position, given: BackendInput) -> Position | None:
    """Return a point inside the nearest emergency area, at the robot's height."""
    inside = (
        Polygon(area.shell).representative_point() for area in given.areas if area.use is AreaUse.EMERGENCY
    )
    places = [(point.x, point.y, here[2]) for point in inside]
    return min(places, key=lambda place: dist(place, here), default=None)
