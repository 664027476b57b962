"""Real numbers as values, in Java's notation and in that of XML Schema.

A real number keeps all its bits, whatever its type: one of EFloat is the double that its text means, and is
written with the fewest digits that give that double again. EMF rounds it to 32 bits when it reads it; what
EMF wrote comes back to it unchanged. Beyond the range of 32 bits it is infinite, as for EMF.
"""

from __future__ import annotations

import re
from decimal import Decimal
from math import copysign, inf

from mmrs_core.languages.values.texts import collapsed, shown

LARGEST_SINGLE = float(2**128 - 2**103)
"""What rounds to a finite number of 32 bits; beyond it, Java's float is infinite."""

_JAVA_REAL = re.compile(r"[+-]?(?:NaN|Infinity|(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?[fFdD]?)", re.ASCII)
_JAVA_BITS = re.compile(r"[+-]?0[xX](?:[\da-fA-F]+\.?|[\da-fA-F]*\.[\da-fA-F]+)[pP][+-]?\d+[fFdD]?", re.ASCII)
_JAVA_BLANKS = "".join(map(chr, range(33)))
_SCHEMA_WORDS = {"INF": inf, "+INF": inf, "-INF": -inf}


def parse_real(text: str) -> float:
    """Read a number in Java's notation, which has NaN, Infinity, a trailing d or f, and powers of two."""
    # most numbers are in Python's notation too; it differs by underscores, other digits, words at the end
    if text[-1:].isdigit() and "_" not in text and text.isascii():
        try:
            return float(text)
        except ValueError:
            pass  # one in hexadecimal digits ends like that, too
    stripped = text.strip(_JAVA_BLANKS)
    if _JAVA_BITS.fullmatch(stripped):
        return _from_bits(stripped)
    if not _JAVA_REAL.fullmatch(stripped):
        raise ValueError(f"{shown(text)}: not a number")
    return float(stripped if stripped[-1] == "y" else stripped.rstrip("fFdD"))


def _from_bits(text: str) -> float:
    digits, _, power = text.lower().partition("p")
    try:
        return float.fromhex(f"{digits}p{power.rstrip('fd')}")
    except OverflowError:
        return copysign(inf, -1 if text[0] == "-" else 1)


def parse_single(text: str) -> float:
    """Read a number of a type with 32 bits; what is too large for them is infinite."""
    number = parse_real(text)
    return copysign(inf, number) if abs(number) > LARGEST_SINGLE else number


def render_real(value: object) -> str:
    """Write a number as Java does: plain between 1e-3 and 1e7, else with a power of ten.

    >>> [render_real(x) for x in (0.0, -1.5, 42.0, 1e7, 12345678.9, 0.00012, float("inf"))]
    ['0.0', '-1.5', '42.0', '1.0E7', '1.23456789E7', '1.2E-4', 'Infinity']

    Raises:
        ValueError: if it is a whole number that no real one equals.
    """
    number = _as_real(value)
    if number != number:
        return "NaN"
    if number in (inf, -inf):
        return "Infinity" if number > 0 else "-Infinity"
    if number == 0.0 or 1e-3 <= abs(number) < 1e7:
        text = format(Decimal(repr(number)), "f")
        return text if "." in text else f"{text}.0"
    sign, digits, exponent = Decimal(repr(number)).as_tuple()
    if len(digits) == 1:  # Java writes the nearest two; they differ for a few of the smallest numbers only
        sign, digits, exponent = Decimal(f"{number:.1e}").as_tuple()
    figures = "".join(map(str, digits))
    power = int(exponent) + len(figures) - 1
    fraction = figures[1:].rstrip("0") or "0"
    return f"{'-' if sign else ''}{figures[0]}.{fraction}E{power}"


def render_single(value: object) -> str:
    """Write a number of a type with 32 bits.

    Raises:
        ValueError: if it is finite and too large for them: EMF would read infinity.
    """
    text = render_real(value)
    if LARGEST_SINGLE < abs(_as_real(value)) < inf:
        raise ValueError(f"{text}: too large for a real number of 32 bits")
    return text


def _as_real(value: object) -> float:
    if isinstance(value, float):
        return value
    assert isinstance(value, int)  # accepts() vouches for it
    try:
        number = float(value)
    except OverflowError:
        raise ValueError(f"2**{value.bit_length() - 1} or more: too large for a real number") from None
    if number != value:
        raise ValueError(f"{value}: no real number of 64 bits equals it")
    return number


def parse_schema_real(text: str) -> float:
    """Read a number as XML Schema part 2 has it, section 3.2.5, or in Java's notation."""
    number = _SCHEMA_WORDS.get(collapsed(text))
    return parse_real(text) if number is None else number


def parse_schema_single(text: str) -> float:
    """Read one of a type with 32 bits."""
    number = parse_schema_real(text)
    return copysign(inf, number) if abs(number) > LARGEST_SINGLE else number


def render_schema_real(value: object) -> str:
    """Write a number as XML Schema part 2 has it; errors as of `render_real`."""
    return render_real(value).replace("Infinity", "INF")


def render_schema_single(value: object) -> str:
    """Write one of a type with 32 bits; errors as of `render_single`."""
    return render_single(value).replace("Infinity", "INF")
