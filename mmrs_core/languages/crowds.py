"""Missions and places that hold more than any command can work through."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.diagnostics import Diagnostic, Severity
from mmrs_core.languages.element import Element, Unknown, descendants, held, metaclass_of, place_of

MOST_PARTS = 10_000
"""Of one kind in one element: tasks of a mission, vertices of a border, robots of a team.

So many tasks of one robot take half a minute to plan, so many vertices of a grid 12 s and of an obstacle 7 s
(measured on a busy machine); ten times as many take more than a hundred times as long.
"""


def crowds(root: Element) -> Iterator[Diagnostic]:
    """Yield a fault for whatever holds more parts of one kind than can be worked through."""
    for element in (root, *descendants(root)):
        if isinstance(element, Unknown):
            continue
        for feature in metaclass_of(element).features:
            if feature.containment and feature.many and (count := len(held(element, feature))) > MOST_PARTS:
                message = (
                    f"{metaclass_of(element).name}: holds {count} {feature.name}, more than {MOST_PARTS}"
                )
                hint = f"divide it, or simplify it until it has at most {MOST_PARTS} {feature.name}"
                yield Diagnostic("FIL006", Severity.ERROR, message, place_of(element), hint)
