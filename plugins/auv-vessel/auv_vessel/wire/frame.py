"""A frame of classic CAN."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Frame:
    """A data frame as it goes over the bus.

    Attributes:
        id: identifier, 11 bits, or 29 where `extended`.
        data: at most 8 bytes.
    """

    id: int
    data: bytes
    extended: bool = False
