"""At which heights tasks are done."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.grounding.coordinates import Ground
from mmrs_core.grounding.values import child, children, number
from mmrs_core.languages.element import Element

_PLACES = ("points", "shell")


def heights_of_task(task: Element, ground: Ground) -> tuple[float, ...]:
    """Return at which heights a task is done, metres above the origin; empty where that is not known.

    Its altitude or depth goes before the heights of its places.
    """
    altitude, depth = number(task, "altitude"), number(task, "depth")
    if altitude is not None:
        return (altitude,)
    if depth is not None:
        return (ground.frame.surface - depth,)
    return tuple(ground.positions[each][2] for each in _places(task) if each in ground.positions)


def _places(task: Element) -> Iterator[Element]:
    point = child(task, "point")
    yield from (point,) if point is not None else ()
    yield from (each for name in _PLACES for each in children(task, name))
