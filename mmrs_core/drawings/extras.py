"""What formats have no place of their own for, as properties whose names begin with ``mmrs:``."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import UTC, datetime
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from mmrs_core.drawings.drawing import Drawing, HeightReference, MapFeature, Property, Role
from mmrs_core.drawings.sheet import FeatureTraits

PREFIX = "mmrs:"
ROLE, RADIUS, FOLDERS, REFERENCE, SINCE_START, COLOUR = (
    f"{PREFIX}{name}" for name in ("role", "radius", "folders", "heightReference", "sinceStart", "colour")
)
DEGREES, METRES = 8, 3
"""Decimals: a millimetre."""


def extras_of(feature: MapFeature, native: Iterable[str] = ()) -> dict[str, Property]:
    """Return what a feature has that its format lacks; `native`: keys of what the format itself says."""
    folders = "/".join(re.sub(r"([\\/])", r"\\\1", folder) for folder in feature.folders)
    extras: dict[str, Property | None] = {
        ROLE: feature.role.value,
        RADIUS: feature.radius,
        FOLDERS: folders,
        REFERENCE: feature.reference.value if feature.heights else "",
        SINCE_START: feature.since_start and feature.times is not None,
        COLOUR: feature.colour,
    }
    return {key: value for key, value in extras.items() if value and key not in native}


def take_extras(properties: dict[str, Property]) -> tuple[FeatureTraits, HeightReference | None]:
    """Remove extras from properties; return them, and what heights are measured from if that is among them.

    An extra with a value that it cannot have stays a property.
    """
    traits: FeatureTraits = {}
    role, reference = properties.get(ROLE), properties.get(REFERENCE)
    if role in list(Role):
        traits["role"] = Role(str(properties.pop(ROLE)))
    if (radius := _number(properties.get(RADIUS))) > 0.0:
        traits["radius"] = radius
        del properties[RADIUS]
    if FOLDERS in properties:
        parts = re.findall(r"(?:[^\\/]|\\.)+", str(properties.pop(FOLDERS)))
        traits["folders"] = tuple(re.sub(r"\\(.)", r"\1", part) for part in parts)
    if str(properties.get(SINCE_START)).lower() == "true":
        traits["since_start"] = bool(properties.pop(SINCE_START))
    if re.fullmatch("#[0-9a-f]{6}", str(properties.get(COLOUR))):
        traits["colour"] = str(properties.pop(COLOUR))
    if reference in list(HeightReference):
        del properties[REFERENCE]
        return traits, HeightReference(reference)
    return traits, None


def _number(value: Property | None) -> float:
    try:
        number = float(value if value is not None else 0.0)
    except (ValueError, OverflowError):
        return 0.0
    return number if isfinite(number) else 0.0


def seconds_of(text: str) -> float:
    """Return seconds since 1970 of a time as ISO 8601 writes it; without a zone it is UTC.

    Raises:
        ValueError: if it is none.

    >>> seconds_of("1970-01-01T00:01:00.5Z")
    60.5
    """
    time = datetime.fromisoformat(text.strip())
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()


def time_texts(seconds: NDArray[np.float64]) -> list[str]:
    """Return seconds since 1970 as ISO 8601, in UTC and to the millisecond.

    >>> time_texts(np.array([60.5]))
    ['1970-01-01T00:01:00.500Z']
    """
    milliseconds = (seconds * 1000.0).round().astype(np.int64).astype("datetime64[ms]")
    return [f"{text}Z" for text in np.datetime_as_string(milliseconds)]


def times_of(texts: object) -> NDArray[np.float64]:
    """Return seconds since 1970 of a list of times; a ValueError names the first that is none."""
    if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
        raise ValueError("not a list of times")
    return np.fromiter(map(seconds_of, texts), dtype=np.float64)


def decimal_texts(values: NDArray[np.float64], decimals: int) -> list[str]:
    """Return rounded numbers without an exponent.

    >>> decimal_texts(np.array([8.5, -1e-9]), DEGREES)
    ['8.5', '0']
    """
    rounded = (values.round(decimals) + 0.0).tolist()
    return [f"{value:.{decimals}f}".rstrip("0").rstrip(".") for value in rounded]


def property_text(value: Property) -> str:
    """Return a property as XML has it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def lost(drawing: Drawing, cases: Mapping[str, Callable[[MapFeature], bool]]) -> tuple[str, ...]:
    """Return a message for each case that is there, with the number of its features."""

    def counted() -> Iterator[str]:
        for message, concerns in cases.items():
            count = sum(map(concerns, drawing.features))
            if count:
                yield f"{message} ({count} feature{'s' * (count > 1)})"

    return tuple(counted())


def above(reference: HeightReference) -> Callable[[MapFeature], bool]:
    """Return whether a feature has heights that are measured from that."""
    return lambda feature: feature.reference is reference
