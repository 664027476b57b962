"""Values of attributes between memory and JSON: numbers and truth values plain, all else as text."""

from __future__ import annotations

import math
import re
from decimal import Decimal
from json.encoder import encode_basestring

from mmrs_core.languages.datatypes import DataType, shown
from mmrs_core.languages.json_form.tree import Leaf, Node, Number, Words
from mmrs_core.languages.metaclass import Enumeration

_EXACT = 2**53
"""Beyond this, many readers of JSON round whole numbers."""
_CHARACTERS = ("char", "java.lang.Character")
_LAST_UNIT = "\uffff"
_LONE = re.compile("[\ud800-\udfff]")


def quoted(text: str) -> str:
    """Return a text as JSON writes it; halves of surrogate pairs as escapes, since no UTF-8 holds them."""
    written = encode_basestring(text)
    return _LONE.sub(lambda match: f"\\u{ord(match.group()):04x}", written)


def written(kind: DataType | Enumeration, value: object) -> str:
    """Return a value as it stands in a file; `kind` must accept it."""
    if isinstance(kind, Enumeration):
        return quoted(kind.render(value))
    if kind.java_class in _CHARACTERS:
        return quoted(str(value))
    if kind.python is bool:
        return "true" if value else "false"
    if kind.python is float and math.isfinite(value):  # type: ignore[arg-type]  # it is accepted
        return repr(float(value))  # type: ignore[arg-type]
    if kind.python is int and abs(int(value)) < _EXACT:  # type: ignore[call-overload]
        return str(value)
    return quoted(kind.render(value))


def parsed(kind: DataType | Enumeration, value: object) -> object:
    """Return the value that a file states, for an attribute of that type; null is not asked about.

    Raises:
        ValueError: if the type does not allow it; the message begins with the value.
    """
    if isinstance(value, bool):
        if isinstance(kind, DataType) and kind.python is bool:
            return value
        raise ValueError(f"{'true' if value else 'false'}: not of the type {kind.name}")
    if isinstance(value, Number):
        return _number(kind, value)
    if not isinstance(value, str):
        what = "an object" if isinstance(value, Node) else "a list" if isinstance(value, list) else "null"
        raise ValueError(f"{what}: not a value of the type {kind.name}")
    is_character = isinstance(kind, DataType) and kind.java_class in _CHARACTERS
    if not is_character or isinstance(value, Words | Leaf):
        return kind.parse(value)
    return _character(kind, value)


def _character(kind: DataType | Enumeration, value: str) -> object:
    """Return one UTF-16 unit, which is all that a char holds; in XML it is written as its number."""
    if len(value) == 1 and value > _LAST_UNIT:
        raise ValueError(f"{shown(value)}: not one character of 16 bits")
    return value if len(value) == 1 else kind.parse(value)


def _number(kind: DataType | Enumeration, value: Number) -> object:
    if isinstance(kind, DataType) and (
        kind.python in (int, float, Decimal) or kind.java_class in _CHARACTERS
    ):
        return kind.parse(str(value))
    raise ValueError(f"{shown(str(value))}: a number, not of the type {kind.name}; write it in quotes")
