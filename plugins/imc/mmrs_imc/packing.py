"""IMC packets: header, message and check sum, least significant byte first."""

from __future__ import annotations

from math import isfinite
from struct import Struct

from mmrs_core.errors import UnsupportedError
from mmrs_imc.messages import DEFINITIONS, Field, Message, Value

SYNC = 0xFE54
NOBODY, NO_ENTITY, NO_MESSAGE = 0xFFFF, 0xFF, 0xFFFF
LARGEST = 0xFFFF
"""Bytes of a message, of a text, and messages of a list, at most."""

_HEADER = Struct("<HHHdHBHB")
_NUMBERS = {"uint8": Struct("<B"), "uint16": Struct("<H"), "fp32": Struct("<f"), "fp64": Struct("<d")}
_COUNT = _NUMBERS["uint16"]
_WHOLE = {"uint8": 0xFF, "uint16": 0xFFFF}


def packet(message: Message) -> bytes:
    """Return a message as a packet without source or destination, at time 0.

    Raises:
        UnsupportedError: the message takes more bytes than packets hold.
        ValueError: a value does not fit its field.
    """
    body = payload(message)
    if len(body) > LARGEST:
        raise UnsupportedError(f"plan: takes {len(body):,} bytes, a message of IMC holds {LARGEST:,}")
    number = DEFINITIONS[message.name].number
    head = _HEADER.pack(SYNC, number, len(body), 0.0, NOBODY, NO_ENTITY, NOBODY, NO_ENTITY)
    return head + body + _COUNT.pack(crc16(head + body))


def payload(message: Message) -> bytes:
    """Return a message without header and check sum.

    Raises:
        ValueError: a value is none of its field.
    """
    fields = DEFINITIONS[message.name].fields
    if {each.name for each in fields} != set(message.values):
        raise ValueError(f"{message.name}: has the fields {', '.join(each.name for each in fields)}")
    return b"".join(_field(each, message.values[each.name], message.name) for each in fields)


def _field(field: Field, value: Value, owner: str) -> bytes:
    kind = field.kind
    if kind == "plaintext" and isinstance(value, str) and value.isascii() and len(value) <= LARGEST:
        return _COUNT.pack(len(value)) + value.encode("ascii")
    if kind == "message" and (value is None or isinstance(value, Message)):
        return _inline(value)
    if kind == "message-list" and isinstance(value, tuple) and len(value) <= LARGEST:
        return _COUNT.pack(len(value)) + b"".join(_inline(each) for each in value)
    if kind in _NUMBERS and isinstance(value, (int, float)) and _fits(field, value):
        return _NUMBERS[kind].pack(value)
    raise ValueError(f"{owner}.{field.name}: {value!r} is no {kind}")


def _fits(field: Field, value: float) -> bool:
    if field.kind in _WHOLE and not (isinstance(value, int) and 0 <= value <= _WHOLE[field.kind]):
        return False
    low, high = field.limits or (-3.4e38, 3.4e38)
    return isfinite(value) and low <= value <= high


def _inline(message: Message | None) -> bytes:
    if message is None:
        return _COUNT.pack(NO_MESSAGE)
    return _COUNT.pack(DEFINITIONS[message.name].number) + payload(message)


def crc16(data: bytes) -> int:
    """Return the check sum CRC-16-IBM: polynomial 0x8005, bits reflected, from 0.

    >>> hex(crc16(b"123456789"))
    '0xbb3d'
    """
    found = 0
    for byte in data:
        found = found >> 8 ^ _TABLE[(found ^ byte) & 0xFF]
    return found


def _entry(byte: int) -> int:
    for _ in range(8):
        byte = byte >> 1 ^ (0xA001 if byte & 1 else 0)
    return byte


_TABLE = tuple(map(_entry, range(256)))
