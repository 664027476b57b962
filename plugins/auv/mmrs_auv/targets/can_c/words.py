"""Values in C: numbers, and names inside comments."""

from __future__ import annotations

from math import isfinite

from mmrs_core.generation.escaping import comment


def number(value: object) -> str:
    """Return a whole number, or a floating-point number in all its digits.

    Raises:
        ValueError: it is neither, or not finite.

    >>> number(3), number(0.1), number(1e22)
    ('3', '0.1', '1e+22')
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not isfinite(value):
        raise ValueError(f"{value!r} is not a number in C")
    return repr(value)


def block(value: object) -> str:
    """Return text in ASCII on one line that neither ends a block comment nor seems to begin one.

    >>> block("a*/b/*c")
    'a* /b/ *c'
    """
    shown = comment(value).encode("ascii", "backslashreplace").decode("ascii").replace("\\", "/")
    while "*/" in shown or "/*" in shown:
        shown = shown.replace("*/", "* /").replace("/*", "/ *")
    return shown.replace("??", "? ?").replace("??", "? ?")
