"""Fences of a simulated vehicle: polygons and circles to stay in or out of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import dist

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.items import FENCE

FENCE_SECONDS = 1.0
"""Time between two checks of the fence."""

Point = tuple[float, float]

INCLUSIONS = {
    int(mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION),
    int(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION),
}
CIRCLES = {
    int(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION),
    int(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION),
}


@dataclass(frozen=True, slots=True)
class Zone:
    """A polygon or, with one point, a circle; `inside`: whether to stay inside it."""

    points: tuple[Point, ...]
    radius: float
    inside: bool

    def allows(self, place: Point) -> bool:
        """Return whether a position is on the permitted side."""
        if len(self.points) == 1:
            return (dist(place, self.points[0]) <= self.radius) == self.inside
        edges = zip(self.points, (*self.points[1:], self.points[0]), strict=True)
        return (sum(_crosses(place, a, b) for a, b in edges) % 2 == 1) == self.inside


def inside_zones(pilot: SimulatedAutopilot) -> bool:
    """Return whether the zones of its fence permit a vehicle's position."""
    place = pilot.body.position[:2]
    return all(zone.allows(place) for zone in _zones(pilot))


def watch_fence(
    pilot: SimulatedAutopilot,
    switch: str,
    outside: Callable[[SimulatedAutopilot], bool],
    answer: Callable[[SimulatedAutopilot], None],
) -> None:
    """Check the fence at intervals, and answer a breach once.

    Args:
        pilot: of the vehicle.
        switch: parameter that enables the fence.
        outside: returns whether it is outside the fence.
        answer: reports a breach and takes the configured action.
    """
    if pilot.time < pilot.fence_due and not pilot.forced_breach:
        return
    pilot.fence_due = pilot.time + FENCE_SECONDS
    forced = pilot.forced_breach
    is_out = forced or (bool(pilot.parameters[switch]) and pilot.located and outside(pilot))
    if is_out and not pilot.breached and (pilot.armed or forced):
        pilot.breached = True
        pilot.breaches += 1
        answer(pilot)
    elif not is_out:
        pilot.breached = False


def _zones(pilot: SimulatedAutopilot) -> Sequence[Zone]:
    zones: list[Zone] = []
    corners: list[Point] = []
    for item in pilot.stores[FENCE]:
        inside = item.command in INCLUSIONS
        corners.append(pilot.place_of(item)[:2])
        if item.command in CIRCLES:
            zones.append(Zone((corners.pop(),), item.params[0], inside))
        elif len(corners) >= item.params[0]:
            zones.append(Zone(tuple(corners), 0.0, inside))
            corners = []
    return zones


def _crosses(place: Point, a: Point, b: Point) -> bool:
    """Return whether a ray to the east from a position crosses an edge."""
    if (a[0] > place[0]) == (b[0] > place[0]):
        return False
    return place[1] < a[1] + (place[0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
