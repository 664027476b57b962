"""Messages of IMC 5.4 that plans are made of, as their published definitions have them, and their packets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite, pi
from struct import Struct
from typing import Literal, TypeAlias

from mmrs_core.errors import UnsupportedError

Kind: TypeAlias = Literal["uint8", "uint16", "fp32", "fp64", "plaintext", "message", "message-list"]
Value: TypeAlias = "int | float | str | Message | tuple[Message, ...] | None"

LATITUDE, LONGITUDE, ANGLE = (-pi / 2, pi / 2), (-pi, pi), (-1.0, 2 * pi)
UNCONSIDERED = -1.0
"""An angle that the vehicle may ignore."""

DEPTH = 1
METRES_PER_SECOND = 0
FROM_HERE, WAIT_AT_SURFACE, KEEP_STATION = 0x01, 0x02, 0x04
REQUEST, SET = 0, 0


@dataclass(frozen=True, slots=True)
class Field:
    """A field: its name, its type, and between which numbers it may be; None: what its type holds."""

    name: str
    kind: Kind
    limits: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Definition:
    """A type of message: its number and its fields, in the order in which they are sent."""

    number: int
    fields: tuple[Field, ...]


@dataclass(frozen=True, slots=True)
class Message:
    """A message: the name of its definition, and a value for each field."""

    name: str
    values: Mapping[str, Value]


def _reference() -> tuple[Field, ...]:
    return (
        Field("lat", "fp64", LATITUDE),
        Field("lon", "fp64", LONGITUDE),
        Field("z", "fp32"),
        Field("z_units", "uint8", (0, 3)),
    )


_SPEED = (Field("speed", "fp32"), Field("speed_units", "uint8", (0, 2)))
_CUSTOM = Field("custom", "plaintext")
_TIMEOUT = Field("timeout", "uint16")

DEFINITIONS: Mapping[str, Definition] = {
    "Goto": Definition(
        450,
        (
            _TIMEOUT,
            *_reference(),
            *_SPEED,
            Field("roll", "fp64", ANGLE),
            Field("pitch", "fp64", ANGLE),
            Field("yaw", "fp64", ANGLE),
            _CUSTOM,
        ),
    ),
    "PopUp": Definition(
        451,
        (
            _TIMEOUT,
            *_reference(),
            *_SPEED,
            Field("duration", "uint16"),
            Field("radius", "fp32", (1.0, 100_000.0)),
            Field("flags", "uint8", (0, 7)),
            _CUSTOM,
        ),
    ),
    "StationKeeping": Definition(
        461, (*_reference(), Field("radius", "fp32"), Field("duration", "uint16"), *_SPEED, _CUSTOM)
    ),
    "PlanSpecification": Definition(
        551,
        (
            Field("plan_id", "plaintext"),
            Field("description", "plaintext"),
            Field("vnamespace", "plaintext"),
            Field("variables", "message-list"),
            Field("start_man_id", "plaintext"),
            Field("maneuvers", "message-list"),
            Field("transitions", "message-list"),
            Field("start_actions", "message-list"),
            Field("end_actions", "message-list"),
        ),
    ),
    "PlanManeuver": Definition(
        552,
        (
            Field("maneuver_id", "plaintext"),
            Field("data", "message"),
            Field("start_actions", "message-list"),
            Field("end_actions", "message-list"),
        ),
    ),
    "PlanTransition": Definition(
        553,
        (
            Field("source_man", "plaintext"),
            Field("dest_man", "plaintext"),
            Field("conditions", "plaintext"),
            Field("actions", "message-list"),
        ),
    ),
    "PlanDB": Definition(
        556,
        (
            Field("type", "uint8", (0, 3)),
            Field("op", "uint8", (0, 7)),
            Field("request_id", "uint16"),
            Field("plan_id", "plaintext"),
            Field("arg", "message"),
            Field("info", "plaintext"),
        ),
    ),
    "EntityParameter": Definition(801, (Field("name", "plaintext"), Field("value", "plaintext"))),
    "SetEntityParameters": Definition(804, (Field("name", "plaintext"), Field("params", "message-list"))),
}


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
