"""Values as Ada has them."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from sys import float_info

PIECE = 80
"""Bytes of a text in one line; lines of Ada end at 255 characters."""

_PLAIN = frozenset(range(0x20, 0x7F)) - {ord('"')}


def string(value: object) -> str:
    r"""Return a text as an expression of type String that holds its UTF-8, over as many lines as it takes.

    >>> string('a "b"')
    '("a " & Character\'Val (34) & "b" & Character\'Val (34))'
    >>> string(""), string("\n")
    ('("")', '("" & Character\'Val (10))')
    """
    data = str(value).encode("utf-8", "surrogatepass")
    pieces = list(_pieces(data))
    if len(pieces) < 2 and not (pieces and pieces[0].startswith('"')):
        pieces.insert(0, '""')  # a character alone is no text
    lines = [" & ".join(pieces[index : index + 4]) for index in range(0, len(pieces), 4)]
    return "(" + " &\n         ".join(lines) + ")"


def _pieces(data: bytes) -> Iterator[str]:
    plain = ""
    for byte in data:
        if byte in _PLAIN and len(plain) < PIECE // 2:
            plain += chr(byte)
            continue
        if plain:
            yield f'"{plain}"'
        plain = chr(byte) if byte in _PLAIN else ""
        if byte not in _PLAIN:
            yield f"Character'Val ({byte})"
    if plain:
        yield f'"{plain}"'


def value(value: object) -> str:
    """Return a value as an expression.

    A text is one of Plans.Text, a tuple of floats the aggregate of a record, one of whole numbers a
    Plans.Numbers.Vector.

    Raises:
        ValueError: it has no expression here, or is a number that is not finite.
    """
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, int):
        return str(value) if value >= 0 else f"({value})"
    if isinstance(value, float):
        return _real(value)
    if isinstance(value, str):
        return f"+{string(value)}"
    if isinstance(value, tuple) and value and isinstance(value[0], float):
        return f"({', '.join(map(_real, value))})"
    if isinstance(value, tuple):
        return " & ".join(["None", *(str(int(each)) for each in value)])
    raise ValueError(f"{value!r} has no expression in Ada")


def _real(value: float) -> str:
    """Return a literal; of a number so small that Ada warns of it, that of zero."""
    if not isfinite(value):
        raise ValueError(f"{value} is not finite and has no literal")
    value = value if abs(value) >= float_info.min else 0.0
    mantissa, _, exponent = repr(abs(value)).partition("e")
    text = mantissa if "." in mantissa else f"{mantissa}.0"
    text += f"E{int(exponent)}" if exponent else ""
    return f"(-{text})" if value < 0.0 else text
