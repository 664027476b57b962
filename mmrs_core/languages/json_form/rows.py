"""What is asked of every element of a class to write it as JSON, worked out once for the class."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import Element
from mmrs_core.languages.json_form.values import EXACT, is_character, quoted
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass

_Text = Callable[[Any], str | None]  # it is asked about values of one class only
"""The text of a value; None where that takes more care."""


class Row(NamedTuple):
    """One feature that files hold.

    Attributes:
        feature: the feature.
        read: gets its bare slot; raises AttributeError where that is empty.
        key: its key, up to the value.
        quiet: whether nothing is written where nothing is in it, whatever the file says.
        usual: the class of most of its values; NoneType where they all take more care.
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
            name = f"${feature.name}" if feature.name.startswith("$") else feature.name
            quiet = not (feature.nullable or feature.unsettable)
            usual, text = _usual(feature)
            yield Row(feature, slots[feature.attribute].__get__, f"{quoted(name)}: ", quiet, usual, text)


def _usual(feature: Feature) -> tuple[type, _Text]:
    kind = feature.type
    odd = feature.default != feature.default  # NaN, which is the default although it does not equal it
    if feature.many or odd or isinstance(kind, Metaclass):
        return type(None), quoted
    if isinstance(kind, Enumeration):
        return str, {each.name: quoted(each.literal) for each in kind.literals}.get
    return _TEXTS.get(kind.python, (type(None), quoted)) if _is_simple(kind) else (type(None), quoted)


def _is_simple(kind: DataType) -> bool:
    return kind.python is not str or kind.render is str or is_character(kind)


def _real(value: float) -> str | None:
    return repr(value) if math.isfinite(value) else None


def _whole(value: int) -> str | None:
    return str(value) if -EXACT < value < EXACT else None


def _truth(value: bool) -> str:
    return "true" if value else "false"


_TEXTS: dict[type, tuple[type, _Text]] = {
    float: (float, _real),
    int: (int, _whole),
    bool: (bool, _truth),
    str: (str, quoted),
}
