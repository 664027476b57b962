"""Attributes of grounded tasks by the type that rules expect.

Valid models hold what is asked for; where one does not, the task is refused, never guessed.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from typing import TypeGuard

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene.primitives import Part, Position, Ring, Value


def number(part: Part, name: str) -> float | None:
    """Return a number; None where it is absent."""
    value = part.attributes.get(name)
    return float(value) if isinstance(value, (int, float)) else None


def finite(text: str) -> float | None:
    """Return the finite number that a text is, as of a device's property; None: it is none."""
    try:
        found = float(text)
    except ValueError:
        return None
    return found if isfinite(found) else None


def text(part: Part, name: str) -> str:
    """Return a text; empty where it is absent."""
    value = part.attributes.get(name)
    return value if isinstance(value, str) else ""


def flag(part: Part, name: str) -> bool:
    """Return a truth value; false where it is absent."""
    return part.attributes.get(name) is True


def position(part: Part, name: str) -> Position:
    """Return a position (east, north, up), metres.

    Raises:
        InfeasibleError: it is absent.
    """
    value = part.attributes.get(name)
    if not _is_position(value):
        raise InfeasibleError(f"{name} is missing")
    return value


def positions(part: Part, name: str) -> tuple[Position, ...]:
    """Return positions (east, north, up), metres; empty where they are absent."""
    value = part.attributes.get(name)
    return tuple(each for each in value if _is_position(each)) if isinstance(value, tuple) else ()


def ring(part: Part, name: str) -> Ring:
    """Return a border as (east, north) vertices; empty where it is absent."""
    return tuple((east, north) for east, north, _ in positions(part, name))


def holes(part: Part) -> tuple[Ring, ...]:
    """Return the holes of an area."""
    value = part.attributes.get("holes")
    return tuple(ring(each, "points") for each in value if isinstance(each, Part)) if _is_many(value) else ()


def pairs(part: Part, name: str) -> tuple[tuple[str, str], ...]:
    """Return keys and values of contained pairs."""
    value = part.attributes.get(name)
    found = [each for each in value if isinstance(each, Part)] if _is_many(value) else []
    return tuple((text(each, "key"), text(each, "value")) for each in found)


def element_called(elements: Iterable[Part], name: str) -> Part | None:
    """Return the first element of that name, which is what a reference to it holds; None if there is none.

    A reference to an element without a name holds its path, such as ``//@elements.2``.
    """
    return next((each for each in elements if name in (text(each, "name"), each.place.path)), None)


def _is_many(value: Value) -> TypeGuard[tuple[Value, ...]]:
    return isinstance(value, tuple)


def _is_position(value: Value) -> TypeGuard[Position]:
    return (
        isinstance(value, tuple) and len(value) == 3 and all(isinstance(each, (int, float)) for each in value)
    )
