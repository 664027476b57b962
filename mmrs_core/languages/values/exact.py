"""Whole and decimal numbers as values, within the bounds of Java's types."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Context, Decimal

from mmrs_core.languages.values.texts import LAST_UNIT, collapsed, described, shown

MOST_DIGITS = 100_000
"""The most digits of a number that is read or written; the time for it grows faster than their count."""

_AT_ONCE = 4000
"""Digits that Python turns into a number in one go; of many more it refuses to."""
_BITS_AT_ONCE = 2000
_MOST_OF_64_BITS = 20
_INTEGER = re.compile(r"[+-]?\d+")


class LongInteger(int):
    """A whole number of more digits than Python writes; this one can be written and shown."""

    def __str__(self) -> str:
        """Return all its digits."""
        return _written(int(self))

    __repr__ = __str__


def ascii_digits(text: str) -> str:
    """Return a text with the digits of other scripts, which Java reads as well, made our own.

    Raises:
        ValueError: if some are beyond the 16 bits of Java's characters.
    """
    if text.isascii():
        return text
    if max(text) > LAST_UNIT:
        raise ValueError(f"{shown(text)}: not a number")
    return "".join(str(int(each)) if each.isdecimal() else each for each in text)


def parse_whole(text: str, bits: int | None) -> int:
    """Read a whole number as Java does.

    Args:
        text: digits of any script, perhaps with a sign before them.
        bits: how many the type has, sign included; None for any number.

    Raises:
        ValueError: if it is none or does not fit.
    """
    if not _INTEGER.fullmatch(text):
        raise ValueError(f"{shown(text)}: not a whole number")
    number = _without_leading_zeros(ascii_digits(text))
    if bits is None:
        return _read(number)
    if len(number) > _MOST_OF_64_BITS or not _fits(int(number), bits):
        raise ValueError(f"{shown(text)}: does not fit into {bits} bits")
    return int(number)


def _without_leading_zeros(number: str) -> str:
    sign = number[:1] if number[:1] in "+-" else ""
    return sign + (number[len(sign) :].lstrip("0") or "0")


def _fits(value: int, bits: int) -> bool:
    return -(1 << bits - 1) <= value < 1 << bits - 1


def reader(bits: int | None) -> Callable[[str], int]:
    """Return `parse_whole` for a type."""
    return lambda text: parse_whole(text, bits)


def schema_reader(bits: int | None) -> Callable[[str], int]:
    """Return the same for a type of XML Schema: blanks around do not count, nor does a plus before all."""
    return lambda text: parse_whole(collapsed(text).removeprefix("+"), bits)


def writer(bits: int | None) -> Callable[[object], str]:
    """Return the function that writes numbers of a type; it raises ValueError for those that do not fit."""

    def render(value: object) -> str:
        assert isinstance(value, int)  # accepts() vouches for it
        if bits is not None and not _fits(value, bits):
            raise ValueError(f"{described(value)}: does not fit into {bits} bits")
        return _written(value)

    return render


def _read(number: str) -> int:
    if len(number) <= _AT_ONCE:
        return int(number)
    digits = number.lstrip("+-")
    if len(digits) > MOST_DIGITS:
        raise ValueError(f"{shown(number)}: more than {MOST_DIGITS} digits")
    value = _joined(digits)
    return LongInteger(-value if number[0] == "-" else value)


def _joined(digits: str) -> int:
    if len(digits) <= _AT_ONCE:
        return int(digits)
    half = len(digits) // 2
    tens: int = 10**half
    return _joined(digits[:-half]) * tens + _joined(digits[-half:])


def _written(value: int) -> str:
    if value.bit_length() <= 3 * _AT_ONCE:
        return int.__repr__(value)
    if value.bit_length() < 4 * MOST_DIGITS:
        digits = str(_in_tens(abs(value), Context(prec=2 * MOST_DIGITS)))
        if len(digits) <= MOST_DIGITS:
            return f"-{digits}" if value < 0 else digits
    raise ValueError(f"a whole number of {value.bit_length()} bits: more than {MOST_DIGITS} digits")


def _in_tens(value: int, context: Context) -> Decimal:
    if value.bit_length() <= _BITS_AT_ONCE:
        return Decimal(value)
    half = value.bit_length() // 2
    high = _in_tens(value >> half, context)
    low = _in_tens(value & ((1 << half) - 1), context)
    return context.fma(
        high, _in_tens(1 << half, context) if half > _BITS_AT_ONCE else Decimal(1 << half), low
    )


_DECIMAL = re.compile(r"[+-]?(?:\d+(?:\.(\d*))?|\.(\d+))(?:[eE]([+-]?)(\d+))?")
_BITS = 31
"""The bits of the scale, which is the number of digits behind the point, and of the power of ten."""
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
