"""A frame of classic CAN."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple


class Frame(NamedTuple):
    """A data frame as it goes over the bus.

    Attributes:
        id: identifier, 11 bits, or 29 where `extended`.
        data: at most 8 bytes.
    """

    id: int
    data: bytes
    extended: bool = False


POLYNOMIAL, START, FINAL = 0x1D, 0xFF, 0xFF


def _entry(byte: int) -> int:
    for _ in range(8):
        byte = (byte << 1) ^ (POLYNOMIAL | 0x100 if byte & 0x80 else 0)
    return byte


_TABLE = bytes(_entry(byte) for byte in range(256))


def check_of(id: int, data: bytes) -> int:
    """Return the check of a message: over its identifier, low byte first, and the bytes before the check."""
    crc = _TABLE[_TABLE[START ^ (id & 0xFF)] ^ (id >> 8)]
    for byte in data:
        crc = _TABLE[crc ^ byte]
    return crc ^ FINAL


@lru_cache(maxsize=64)  # each node that receives a frame asks
def is_sound(id: int, data: bytes) -> bool:
    """Return whether a message ends with its check."""
    return check_of(id, data[:-1]) == data[-1]
