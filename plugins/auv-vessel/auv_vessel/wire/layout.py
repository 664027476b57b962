"""Where the fields of a message lie in its bytes, and which raw numbers they hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil, floor

from auv_vessel.wire.catalogue import CHECK, SEQUENCE, Field, Message

_COUNTER = Field(SEQUENCE, 8, high=255.0, comment="one more with every frame of this message, from 255 to 0")
_CHECK = Field(CHECK, 8, high=255.0, comment="CRC-8 SAE J1850 over the identifier (two bytes) and all before")


@dataclass(frozen=True, slots=True)
class Slot:
    """A field in its place.

    Attributes:
        start: its least significant bit; bit 0 is the lowest of byte 0.
        low, high: the least and the greatest raw number that is sent and believed.
    """

    field: Field
    start: int
    low: int
    high: int


@dataclass(frozen=True, slots=True)
class Layout:
    """A message's fields by name, its counter and check last if it is guarded, and its length in bytes."""

    message: Message
    slots: Mapping[str, Slot]
    length: int


def layout_of(message: Message) -> Layout:
    """Return where a message's fields lie; counter and check have whole bytes to themselves."""
    slots: dict[str, Slot] = {}
    start = 0
    for field in message.fields:
        slots[field.name] = Slot(field, start, *_bounds(field))
        start += field.bits
    length = (start + 7) // 8
    if message.guarded:
        for field in (_COUNTER, _CHECK):
            slots[field.name] = Slot(field, length * 8, 0, 255)
            length += 1
    return Layout(message, slots, length)


def _bounds(field: Field) -> tuple[int, int]:
    """Return the raw numbers within the field's range; one that names stand for has a name."""
    if field.names:
        return 0, len(field.names) - 1
    slack = 1e-9  # a range of whole steps, as floating-point numbers have it
    return ceil(field.low / field.scale - slack), floor(field.high / field.scale + slack)
