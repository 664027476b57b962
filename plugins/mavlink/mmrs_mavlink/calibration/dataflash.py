"""Messages of ArduPilot's logs on board (``.bin``), which define their own formats.

A message is A3 95, the number of its type, and its fields. A message FMT (128) gives a type its name, its
length, the code of each field and their names. pymavlink's own reader expects an undamaged log: it prints
each bad byte, and never comes to an end where a format has length 0.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterator
from dataclasses import dataclass

from pymavlink.DFReader import FORMAT_TO_STRUCT

from .damage import Damages

MAGIC = b"\xa3\x95"
_FORMAT = 0x80
_FORMAT_LENGTH = 89
_HEADER = 3

Fields = dict[str, float | str]


@dataclass(frozen=True, slots=True)
class _Format:
    """The format of one type. Attributes: name; length with header; unpacks its body; its fields, scales."""

    name: str
    length: int
    unpacks: struct.Struct | None = None
    fields: tuple[str, ...] = ()
    scales: tuple[float | None, ...] = ()

    def values(self, body: bytes) -> Fields:
        """Return the fields; none where the format makes no sense."""
        if self.unpacks is None:
            return {}
        found: Fields = {}
        for name, scale, value in zip(self.fields, self.scales, self.unpacks.unpack(body), strict=True):
            if isinstance(value, bytes):
                found[name] = _text(value)
            else:
                found[name] = float(value) if scale is None else float(value) * scale
        return found


def messages_in(data: bytes, wanted: Collection[str], damages: Damages) -> Iterator[tuple[str, Fields]]:
    """Yield the messages of some types: their names and their fields, scaled to their units.

    Args:
        data: of the log.
        wanted: names of types.
        damages: counts bytes that hold no message.
    """
    formats = {_FORMAT: _Format("FMT", _FORMAT_LENGTH)}
    offset, end = 0, len(data)
    while offset + _HEADER <= end:
        kind = formats.get(data[offset + 2]) if data[offset : offset + 2] == MAGIC else None
        if kind is None:
            following = data.find(MAGIC, offset + 1)
            following = end if following < 0 else following
            damages.skip(offset, following - offset)
            offset = following
            continue
        if offset + kind.length > end:
            damages.cut = offset
            return
        body = data[offset + _HEADER : offset + kind.length]
        if kind.name == "FMT":
            number, made = _format(body)
            if made is not None and number != _FORMAT:
                formats[number] = made
        elif kind.name in wanted:
            yield kind.name, kind.values(body)
        offset += kind.length


def _format(body: bytes) -> tuple[int, _Format | None]:
    """Return the number of a type, and its format; None where it cannot be one."""
    number, length, name, codes, names = struct.unpack("<BB4s16s64s", body)
    if length < _HEADER:
        return number, None
    fields = tuple(each for each in _text(names).split(",") if each)
    known = [FORMAT_TO_STRUCT.get(code) for code in _text(codes)]
    if len(fields) != len(known) or any(each is None for each in known):
        return number, _Format(_text(name), length)
    layout = struct.Struct("<" + "".join(each[0] for each in known))
    if layout.size != length - _HEADER:
        return number, _Format(_text(name), length)
    return number, _Format(_text(name), length, layout, fields, tuple(each[1] for each in known))


def _text(value: bytes) -> str:
    return value.split(b"\0", 1)[0].decode("ascii", "replace")
