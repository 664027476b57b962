"""What is asked of every element of a class to write it as JSON, worked out once for the class."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import Element
from mmrs_core.languages.json_form.scalars import EXACT, is_character
from mmrs_core.languages.json_form.stream import key_of, quoted
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass
from mmrs_core.languages.values.codecs import render_boolean
from mmrs_core.languages.values.real import (
    LARGEST_SINGLE,
    render_real,
    render_schema_real,
    render_schema_single,
    render_single,
)
from mmrs_core.languages.values.texts import LAST_UNIT

_Text = Callable[[Any], str | None]  # it is asked about values of one class only
"""The text of a value; None where that takes more care."""


class Row(NamedTuple):
    """One feature that files hold.

    Attributes:
        feature: the feature.
        read: gets its bare slot; raises AttributeError where that is empty.
        key: its key, up to the value.
        quiet: whether nothing is written where nothing is in it, whatever the file says.
        usual: the class of most of its values; `Row` itself, which is none's, where they all take more care.
        text: the text of such a value.
    """

    feature: Feature
    read: Callable[[Element], object]
    key: str
    quiet: bool
    usual: type
    text: _Text


def rows_of(metaclass: Metaclass) -> tuple[Row, ...]:
    """Return the features of a class that has elements, in file order."""
    return tuple(_rows(metaclass))


def _rows(metaclass: Metaclass) -> Iterator[Row]:
    assert metaclass.implementation is not None  # it has elements
    slots = metaclass.implementation._mmrs_slots
    for feature in metaclass.features:
        if feature.stored:
            name = key_of(feature.name)
            quiet = not (feature.nullable or feature.unsettable)
            usual, text = _usual(feature)
            yield Row(feature, slots[feature.attribute].__get__, f"{quoted(name)}: ", quiet, usual, text)


def _usual(feature: Feature) -> tuple[type, _Text]:
    kind = feature.type
    odd = feature.default != feature.default  # NaN, which is the default although it does not equal it
    if feature.many or odd or isinstance(kind, Metaclass):
        return Row, quoted
    if isinstance(kind, Enumeration):
        return str, {each.name: quoted(each.literal) for each in kind.literals}.get
    if kind.python is int:
        return int, _whole(kind)
    if is_character(kind):
        return str, _character
    return _TEXTS.get(kind.render, (Row, quoted))


def _real(value: float) -> str | None:
    return repr(value) if math.isfinite(value) else None


def _single(value: float) -> str | None:
    return repr(value) if abs(value) <= LARGEST_SINGLE else None


def _character(value: str) -> str | None:
    return quoted(value) if len(value) == 1 and value <= LAST_UNIT else None


def _whole(kind: DataType) -> _Text:
    bound = EXACT if kind.bits is None else min(EXACT, 1 << kind.bits - 1)
    return lambda value: str(value) if -bound < value < bound else None


def _truth(value: bool) -> str:
    return "true" if value else "false"


_TEXTS: dict[Callable[[object], str], tuple[type, _Text]] = {
    render_real: (float, _real),
    render_schema_real: (float, _real),
    render_single: (float, _single),
    render_schema_single: (float, _single),
    render_boolean: (bool, _truth),
    str: (str, quoted),
}
"""The usual class and text of values, by the renderer of their type."""
