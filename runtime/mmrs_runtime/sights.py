"""Objects that simulated robots can see in photos, from the file that lists them."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from math import hypot, isfinite
from pathlib import Path

ASIDE = 0.5
"""How far to the side a photo reaches, as a part of the height that it is taken from."""

CLEAR = 8.0
"""Metres of clear water through which things are seen from above."""


@dataclass(frozen=True, slots=True)
class Sight:
    """Something to be seen.

    Attributes:
        north, east: metres from the origin of who looks.
        depth: metres below the surface of water; what stands on land has none.
    """

    name: str
    north: float
    east: float
    depth: float = 0.0


def sights_in(path: Path) -> tuple[Sight, ...]:
    """Return the ``things`` in a file of surroundings, as simulated underwater vehicles have one, too.

    Raises:
        OSError: it cannot be read.
        ValueError: it is no such file; says why.
    """
    try:
        things = json.loads(path.read_text(encoding="utf-8"))["things"]
        return tuple(_sight(thing) for thing in things)
    except (TypeError, KeyError, ValueError, RecursionError) as error:
        raise ValueError(f"{path}: no surroundings: {error!r}") from error


def seen(sights: Iterable[Sight], north: float, east: float, height: float) -> tuple[Sight, ...]:
    """Return what a photo shows that was taken straight down, from so many metres above the surface.

    >>> [each.name for each in seen([Sight("wreck", 0.0, 9.0, 1.0), Sight("reef", 0.0, 0.0, 9.0)], 0, 0, 20)]
    ['wreck']
    """
    return tuple(
        each
        for each in sights
        if each.depth <= CLEAR and hypot(each.north - north, each.east - east) <= ASIDE * height
    )


def _sight(thing: dict[str, object]) -> Sight:
    name = thing["name"]
    if not isinstance(name, str) or not name:
        raise ValueError(f"{name!r} is no name")
    north, east, depth = (float(str(thing[key])) for key in ("north", "east", "depth"))
    if not all(map(isfinite, (north, east, depth))):
        raise ValueError(f"'{name}' is nowhere")
    return Sight(name, north, east, depth)
