"""Latitudes and longitudes as tables have them: in decimals, or in minutes and seconds."""

from __future__ import annotations

import re

MARKS = str.maketrans(
    {**dict.fromkeys("′’‘´", "'"), **dict.fromkeys("″”“", '"'), "º": "°", "−": "-", "\N{NO-BREAK SPACE}": " "}
)
"""How else the marks of degrees, minutes and seconds are typed."""
SIXTY = 60
LATITUDE, LONGITUDE = "NS", "EW"
_LONGEST = 60
_ORDERS = frozenset(("", "°", "°'", "°'\"", "°'''", ":", "::"))
"""The marks behind degrees, minutes and seconds, as far as they are written."""
_WORD = re.compile(r"[NSEW]|[^\sNSEW]+")
_NUMBER = re.compile(r"[0-9]{1,3}(\.[0-9]{1,20})?", re.ASCII)


def angle_of(text: str, axis: str) -> float:
    r"""Return the degrees that a text states; south and west are negative.

    Args:
        text: with a point before decimals.
        axis: the letters that may stand beside it, `LATITUDE` or `LONGITUDE`.

    >>> angle_of("42.5", LATITUDE), angle_of("42°30'0\"S", LATITUDE), angle_of("W 13 30.6", LONGITUDE)
    (42.5, -42.5, -13.51)

    Raises:
        ValueError: if it is none.
    """
    try:
        if "_" not in text:
            return float(text)
    except ValueError:
        pass
    plain = text.translate(MARKS).upper() if len(text) <= _LONGEST else ""
    marks = "".join(each for each in plain if each in "°:'\"")
    words = _WORD.findall(plain.translate(dict.fromkeys(map(ord, "°:'\""), " ")))
    letter = next((words.pop(at) for at in (0, -1) if words and words[at] in "NSEW"), "")
    sign = words[0][:1] if words and words[0][:1] in "+-" else ""
    numbers = [words[0][len(sign) :], *words[1:]] if words else [""]
    if marks not in _ORDERS or len(numbers) > 3 or not all(map(_NUMBER.fullmatch, numbers)):
        raise ValueError("neither degrees nor degrees, minutes and seconds")
    if letter and letter not in axis:
        raise ValueError(f"expected one of the letters {' and '.join(axis)}")
    degrees, minutes, seconds = (*map(float, numbers), 0.0, 0.0)[:3]
    if minutes >= SIXTY or seconds >= SIXTY:
        raise ValueError(f"minutes and seconds are below {SIXTY}")
    if (sign and letter) or (minutes and degrees % 1) or (seconds and minutes % 1):
        raise ValueError("it states two things that exclude each other")
    size = round(degrees + minutes / SIXTY + seconds / SIXTY**2, 9)
    return -size if sign == "-" or letter in ("S", "W") else size
