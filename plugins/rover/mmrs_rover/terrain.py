"""Which ground a type of rover cannot pass."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TypeAlias

from mmrs_core.scene import Area, AreaUse, Part, RobotType
from mmrs_core.scene.attributes import number, ring, text
from mmrs_rover.names import TERRAIN

Figure: TypeAlias = "Callable[[str], float | None]"
"""Gives a number that an element states by the name of its feature; None where it states none."""

LIMITS = (
    ("slope", "maxSlope", "°"),
    ("waterDepth", "wadingDepth", " m"),
    ("stepHeight", "groundClearance", " m"),
)
"""What terrain states, what bounds it in a type of rover, and the unit of both."""


def barrier(robot_type: RobotType, element: Part) -> Area | None:
    """Return the area that rovers of a type keep out of because of an element of the context.

    None for all but terrain, and for terrain that they can pass. It bars them at every height, since they
    stay on the ground.
    """
    if not element.is_a(TERRAIN):
        return None
    if not any(hindrances(partial(number, robot_type.part), partial(number, element))):
        return None
    return Area(
        name=text(element, "name") or "terrain",
        use=AreaUse.OBSTACLE,
        shell=ring(element, "shell"),
        safety_distance=number(element, "safetyDistance") or 0.0,
        part=element,
    )


def hindrances(rover: Figure, terrain: Figure) -> Iterator[str]:
    """Yield what of a terrain is too much for a type of rover; a limit that it does not state is zero."""
    for feature, limit, unit in LIMITS:
        found, allowed = terrain(feature) or 0.0, rover(limit) or 0.0
        if found > allowed:
            yield f"its {feature} is {found:g}{unit}, the rover's {limit} {allowed:g}{unit}"
