"""Objects that simulated vehicles can detect in photos."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import hypot

ASIDE = 0.5
"""Half the width of what a photo shows, as a multiple of the height that it is taken from."""

CLEAR = 8.0
"""Depth of water, metres, down to which objects are visible from above."""


@dataclass(frozen=True, slots=True)
class Sight:
    """An object that can be seen.

    Attributes:
        north, east: metres from the origin of the observer.
        depth: metres below the water surface; 0 on land.
    """

    name: str
    north: float
    east: float
    depth: float = 0.0


def seen(sights: Iterable[Sight], north: float, east: float, height: float) -> tuple[Sight, ...]:
    """Return the objects in a photo taken straight down, from a height in metres above the surface.

    >>> [each.name for each in seen([Sight("wreck", 0.0, 9.0, 1.0), Sight("reef", 0.0, 0.0, 9.0)], 0, 0, 20)]
    ['wreck']
    """
    return tuple(
        each
        for each in sights
        if each.depth <= CLEAR and hypot(each.north - north, each.east - east) <= ASIDE * height
    )
