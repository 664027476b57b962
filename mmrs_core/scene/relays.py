"""The relays of a scene, which pass on the radio of its robots."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from mmrs_core.scene.attributes import number, position, text
from mmrs_core.scene.primitives import Part, Position

RELAY = ("urn:mmrs:context:1.0", "Relay")


@dataclass(frozen=True, slots=True)
class Relay:
    """A relay of the context.

    Attributes:
        name: its own, or else its path.
        position: of its antenna, (east, north, up), metres.
        range: of its radio, metres.
    """

    name: str
    position: Position
    range: float


def relays_of(elements: Iterable[Part]) -> tuple[Relay, ...]:
    """Return the relays among the elements of a context, those of types that extend them included.

    Raises:
        InfeasibleError: one has no position.
    """
    return tuple(
        Relay(text(each, "name") or each.place.path, position(each, "position"), number(each, "range") or 0.0)
        for each in elements
        if each.is_a(RELAY)
    )
