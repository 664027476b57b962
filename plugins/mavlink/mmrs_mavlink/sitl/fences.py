"""Fences as the vehicle keeps them: polygons and circles to stay in or out of."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING, Protocol

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import FENCE

if TYPE_CHECKING:
    from mmrs_mavlink.sitl.autopilot import Autopilot

FENCE_SECONDS = 1.0
"""How long it is from one look at the fence to the next."""

Point = tuple[float, float]

POLYGONS = {
    int(mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION): True,
    int(mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION): False,
}
CIRCLES = {
    int(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION): True,
    int(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION): False,
}


class Vertex(Protocol):
    """An item of a fence, with where it is in metres north and east."""

    @property
    def command(self) -> int:
        """Return its MAV_CMD."""
        ...

    @property
    def params(self) -> tuple[float, float, float, float]:
        """Return how many corners the polygon has, or the radius of the circle, first."""
        ...


@dataclass(frozen=True, slots=True)
class Zone:
    """A polygon, or, with one point, a circle; `inside`: where one must be."""

    points: tuple[Point, ...]
    radius: float
    inside: bool

    def allows(self, place: Point) -> bool:
        """Return whether a place is on the right side."""
        return self._holds(place) == self.inside

    def _holds(self, place: Point) -> bool:
        if len(self.points) == 1:
            return hypot(place[0] - self.points[0][0], place[1] - self.points[0][1]) <= self.radius
        crossings = sum(_crosses(place, a, b) for a, b in _edges(self.points))
        return crossings % 2 == 1


def fence_of(pilot: Autopilot) -> tuple[Zone, ...]:
    """Return the zones of the fence that a vehicle has."""
    return zones_of([(item, pilot.place_of(item)[:2]) for item in pilot.stores[FENCE]])


def watch_fence(
    pilot: Autopilot, switch: str, outside: Callable[[Autopilot], bool], breach: Callable[[Autopilot], None]
) -> None:
    """Look from time to time whether a vehicle is out of its fence, and let it be so once if it is armed.

    Args:
        pilot: of the vehicle.
        switch: parameter without which there is no fence.
        outside: says whether it is out of it.
        breach: makes it be out of it.
    """
    if pilot.time < pilot.fence_due:
        return
    pilot.fence_due = pilot.time + FENCE_SECONDS
    is_out = bool(pilot.parameters[switch]) and pilot.located and outside(pilot)
    if is_out and not pilot.breached and pilot.armed:
        breach(pilot)
    elif not is_out and not pilot.told_out:
        pilot.breached = False


def zones_of(items: Sequence[tuple[Vertex, Point]]) -> tuple[Zone, ...]:
    """Return the zones of a fence, from its items and where they are."""
    zones: list[Zone] = []
    corners: list[Point] = []
    for item, point in items:
        if item.command in CIRCLES:
            zones.append(Zone((point,), item.params[0], CIRCLES[item.command]))
        elif item.command in POLYGONS:
            corners.append(point)
            if len(corners) >= item.params[0]:
                zones.append(Zone(tuple(corners), 0.0, POLYGONS[item.command]))
                corners = []
    return tuple(zones)


def _edges(points: Sequence[Point]) -> Iterator[tuple[Point, Point]]:
    return zip(points, (*points[1:], points[0]), strict=True)


def _crosses(place: Point, a: Point, b: Point) -> bool:
    """Return whether a ray to the east from a place crosses an edge."""
    if (a[0] > place[0]) == (b[0] > place[0]):
        return False
    return place[1] < a[1] + (place[0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
