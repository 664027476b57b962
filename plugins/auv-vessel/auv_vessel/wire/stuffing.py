"""How long frames are on the wire: classic CAN after ISO 11898-1, stuff bits included."""

from __future__ import annotations

from auv_vessel.wire.frame import Frame

POLYNOMIAL = 0x4599
TAIL = 13
"""Bits after the check, which are not stuffed: delimiters and acknowledge, end of frame, and the pause."""

_STANDARD, _EXTENDED = 34, 54
"""Bits before the tail without data and stuff bits: start, identifier, control, check."""


def crc_of(bits: str) -> int:
    """Return CRC-15 of a frame's bits up to its data, a text of 0 and 1."""
    crc = 0
    for bit in bits:
        crc = (crc << 1) ^ (POLYNOMIAL | 0x8000 if (bit == "1") != bool(crc & 0x4000) else 0)
        crc &= 0x7FFF
    return crc


def bits_of(frame: Frame) -> str:
    """Return a frame's bits from its start to its check, before stuffing, as a text of 0 and 1."""
    length = f"{len(frame.data):04b}"
    if frame.extended:
        id = f"{frame.id:029b}"
        head = f"0{id[:11]}11{id[11:]}000"
    else:
        head = f"0{frame.id:011b}000"
    said = head + length + "".join(f"{byte:08b}" for byte in frame.data)
    return said + f"{crc_of(said):015b}"


def stuff_bits(bits: str) -> int:
    """Return how many bits are put between these: one of the other value after every five that are alike."""
    count = run = 0
    last = ""
    for bit in bits:
        run = run + 1 if bit == last else 1
        last = bit
        if run == 5:
            count, run = count + 1, 1
            last = "1" if bit == "0" else "0"
    return count


def length_of(frame: Frame) -> int:
    """Return for how many bit times a frame keeps the bus, the pause after it included."""
    bits = bits_of(frame)
    return len(bits) + stuff_bits(bits) + TAIL


def longest(data_bytes: int, extended: bool = False) -> int:
    """Return for how many bit times a frame with so much data keeps the bus at most, whatever it says."""
    stuffed = shortest(data_bytes, extended) - TAIL
    return stuffed + (stuffed - 1) // 4 + TAIL


def shortest(data_bytes: int, extended: bool = False) -> int:
    """Return for how many bit times a frame with so much data keeps the bus if nothing is stuffed."""
    return (_EXTENDED if extended else _STANDARD) + 8 * data_bytes + TAIL
