"""Decimal numbers as values, within the bounds of Java's ``BigDecimal``."""

from __future__ import annotations

import re
from decimal import Decimal

from mmrs_core.languages.values.texts import collapsed, shown
from mmrs_core.languages.values.whole import ascii_digits

_DECIMAL = re.compile(r"[+-]?(?:\d+(?:\.(\d*))?|\.(\d+))(?:[eE]([+-]?)(\d+))?")
_BITS = 31
"""Of the scale, which is the number of digits behind the point, and of the power of ten."""
_LONGEST_POWER = 10
_MOST_PLAIN = 1000
"""Digits that a number may need for its place alone; one that needs more is written with a power of ten."""


def parse_decimal(text: str) -> Decimal:
    """Read a decimal number; raises ValueError if Java has no such number."""
    found = _DECIMAL.fullmatch(text)
    if found is None:
        raise ValueError(f"{shown(text)}: not a decimal number")
    power = ascii_digits(found[4] or "").lstrip("0") or "0"
    if len(power) > _LONGEST_POWER:
        raise ValueError(f"{shown(text)}: the power of ten does not fit into {_BITS + 1} bits")
    exponent = int(f"{found[3] or ''}{power}")
    _fit(exponent, len(found[1] or found[2] or "") - exponent, text)
    return Decimal(ascii_digits(text))


def parse_schema_decimal(text: str) -> Decimal:
    """Read the same where blanks around do not count."""
    return parse_decimal(collapsed(text))


def render_decimal(value: object) -> str:
    """Write a decimal number as Java does, with a power of ten where that is shorter.

    Raises:
        ValueError: if it is not finite, or Java has no such number.
    """
    assert isinstance(value, Decimal)  # accepts() vouches for it
    if not value.is_finite():
        raise ValueError(f"{value}: not a finite number")
    exponent = value.as_tuple().exponent
    assert isinstance(exponent, int)  # it is finite
    _fit(value.adjusted(), -exponent, str(value))
    return str(value)


def render_schema_decimal(value: object) -> str:
    """Write a decimal number plainly, as XML Schema wants it, unless it would get long or lose its scale.

    EMF writes all of them plainly; of 1E+5 it then reads another number of digits than it wrote.
    """
    text = render_decimal(value)
    assert isinstance(value, Decimal)  # render_decimal() has looked
    exponent = value.as_tuple().exponent
    assert isinstance(exponent, int)  # it is finite
    return format(value, "f") if value.adjusted() > -_MOST_PLAIN and exponent <= 0 else text


def _fit(exponent: int, scale: int, text: str) -> None:
    limit = 1 << _BITS
    if not (-limit <= exponent < limit and -limit <= scale < limit):
        raise ValueError(f"{shown(text)}: the power of ten does not fit into {_BITS + 1} bits")
