"""Which parameters a vehicle must have to go as planned: programs set them, and plans ask for them."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import NamedTuple

from .profiles import VehicleProfile
from .program import Travel

NEARER = 0.9
"""Share of the distance at which a place counts as reached within which one stops that stops early: it might
otherwise stand a bit too far away."""


class Limit(NamedTuple):
    """A parameter, and what it must be.

    Attributes:
        name: of the parameter.
        value: in its own unit.
        why: what the vehicle does then, in words.
        sort: ``at most`` or ``at least`` the value, or the value ``instead of 0``.
    """

    name: str
    value: float
    why: str
    sort: str = "at most"

    def holds(self, value: float) -> bool:
        """Return whether a vehicle with another value goes as planned."""
        if self.sort == "instead of 0":
            return value != 0.0
        return value >= self.value if self.sort == "at least" else value <= self.value


def limits_of(profile: VehicleProfile, travel: Travel, acceptance: float = inf) -> Iterator[Limit]:
    """Yield what a vehicle must be set to for a way of travelling.

    Args:
        profile: of the vehicle.
        travel: how carefully it is to go.
        acceptance: metres from a place at which it counts as reached.
    """
    mode = f"it travels {travel.mode}"
    radius = min(travel.radius, NEARER * acceptance) if profile.stops_early else travel.radius
    yield from (Limit(name, radius * unit, mode) for name, unit in profile.radii.items())
    for units, rate, how in (
        (profile.climbs, travel.climb, "climbs at {:g} m/s"),
        (profile.descents, travel.descent, "descends at {:g} m/s"),
        (profile.yaw_rates, travel.turn_rate, "turns at {:g}°/s"),
    ):
        if rate is not None:
            why = f"it {how.format(rate)}, as its type states"
            yield from (Limit(name, rate * unit, why) for name, unit in units.items())
    yield from (Limit(name, travel.margin, mode, "at least") for name in profile.autopilot.margins)
    for name, angle in profile.pivots.items():
        turns = f"it turns on the spot where it turns by over {angle:g}°"
        yield Limit(name, angle, turns, "instead of 0")
