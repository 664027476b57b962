"""Messages of IMC 5.4 that plans are made of, as their published definitions have them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Literal, TypeAlias

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
