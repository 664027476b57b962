"""Messages of ground stations' logs (``.tlog``): MAVLink frames, each with the time of day before it."""

from __future__ import annotations

import re
import struct
from collections.abc import Collection, Iterator
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from .damage import Damages

_STAMP = 8
_V1, _V2 = 0xFE, 0xFD
_SIGNED = 0x01
_MARK = re.compile(b"[\xfd\xfe]")


def is_telemetry(data: bytes) -> bool:
    """Return whether data begins with a frame after a time."""
    return len(data) > _STAMP and data[_STAMP] in (_V1, _V2)


def messages_in(data: bytes, wanted: Collection[str], damages: Damages) -> Iterator[Any]:
    """Yield the messages of some types, as pymavlink has them.

    The times of day are skipped: they are when messages arrived at the ground station.

    Args:
        data: of the log.
        wanted: names of messages.
        damages: counts bytes that hold no message.
    """
    numbers = {number for number, each in mavlink.mavlink_map.items() if each.msgname in wanted}
    decoder = mavlink.MAVLink(None)
    offset, end = 0, len(data)
    while offset + _STAMP + 2 <= end:
        begin = offset + _STAMP
        size, number = _frame(data, begin)
        if not size:
            offset = _next(data, offset, damages)
            continue
        if begin + size > end:
            damages.cut = offset
            return
        if number in numbers:
            try:
                message = decoder.decode(bytearray(data[begin : begin + size]))
            except (mavlink.MAVError, struct.error):
                offset = _next(data, offset, damages)
                continue
            yield message
        elif not _follows(data, begin + size):
            offset = _next(data, offset, damages)
            continue
        offset = begin + size


def _follows(data: bytes, end: int) -> bool:
    """Return whether another frame follows, or nothing: else what seemed to be one was none."""
    return end + _STAMP >= len(data) or data[end + _STAMP] in (_V1, _V2)


def _next(data: bytes, offset: int, damages: Damages) -> int:
    """Return where the next frame may begin, with its time."""
    found = _MARK.search(data, offset + _STAMP + 1)
    following = found.start() - _STAMP if found else len(data)
    damages.skip(offset, following - offset)
    return following


def _frame(data: bytes, begin: int) -> tuple[int, int]:
    """Return the bytes of a frame and the number of its message; (0, 0) where none begins."""
    if data[begin] == _V1 and begin + 6 <= len(data):
        return data[begin + 1] + 8, data[begin + 5]
    if data[begin] == _V2 and begin + 10 <= len(data):
        number = int.from_bytes(data[begin + 7 : begin + 10], "little")
        signature = 13 if data[begin + 2] & _SIGNED else 0
        return data[begin + 1] + 12 + signature, number
    return 0, 0
