"""Values of attributes between memory and JSON: numbers and truth values plain, all else as text."""

from __future__ import annotations

import math
from decimal import Decimal

from mmrs_core.languages.datatypes import DataType, render_real, shown
from mmrs_core.languages.json_form.stream import LIST, NUMBER, OBJECT, TEXT, WORD, quoted
from mmrs_core.languages.json_form.tree import Leaf, Words
from mmrs_core.languages.metaclass import Enumeration

EXACT = 2**53
"""Beyond this, many readers of JSON round whole numbers."""
_CHARACTERS = ("char", "java.lang.Character")
_LAST_UNIT = "\uffff"


def written(kind: DataType | Enumeration, value: object) -> str:
    """Return a value as it stands in a file; `kind` must accept it.

    Raises:
        ValueError: if no file could hold it, as `DataType.render` says.
    """
    if isinstance(kind, Enumeration):
        return quoted(kind.render(value))
    if kind.render is render_real and isinstance(value, float) and math.isfinite(value):
        return repr(value)
    text = kind.render(value)
    if kind.java_class in _CHARACTERS:
        return quoted(str(value))
    if kind.python is float and math.isfinite(value):  # type: ignore[arg-type]  # it is accepted
        return repr(float(value))  # type: ignore[arg-type]
    if kind.python is bool or (kind.python is int and abs(int(value)) < EXACT):  # type: ignore[call-overload]
        return text
    return quoted(text)


def parsed(kind: DataType | Enumeration, sort: int, text: str) -> object:
    """Return the value that a file states, for an attribute of that type; null is not asked about.

    Args:
        kind: the type.
        sort: what comes, such as `TEXT`.
        text: what it says.

    Raises:
        ValueError: if the type does not allow it; the message begins with the value.
    """
    if sort == NUMBER:
        if isinstance(kind, DataType) and takes_numbers(kind):
            return kind.parse(text)
        raise ValueError(f"{shown(text)}: a number, not of the type {kind.name}; write it in quotes")
    if sort == WORD and text != "null":
        if isinstance(kind, DataType) and kind.python is bool:
            return text == "true"
        raise ValueError(f"{text}: not of the type {kind.name}")
    if sort != TEXT:
        what = {OBJECT: "an object", LIST: "a list"}.get(sort, "null")
        raise ValueError(f"{what}: not a value of the type {kind.name}")
    if is_character(kind) and not isinstance(text, Words | Leaf):
        return _character(kind, text)
    return kind.parse(text)


def is_character(kind: DataType | Enumeration) -> bool:
    """Return whether the values of a type are single characters."""
    return isinstance(kind, DataType) and kind.java_class in _CHARACTERS


def takes_numbers(kind: DataType | Enumeration) -> bool:
    """Return whether a number in a file, one without quotes, may be a value of a type."""
    return is_character(kind) or (isinstance(kind, DataType) and kind.python in (int, float, Decimal))


def _character(kind: DataType | Enumeration, value: str) -> object:
    """Return one UTF-16 unit, which is all that a char holds; in XML it is written as its number."""
    if len(value) == 1 and value > _LAST_UNIT:
        raise ValueError(f"{shown(value)}: not one character of 16 bits")
    return value if len(value) == 1 else kind.parse(value)
