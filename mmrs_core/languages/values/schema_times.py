"""Dates, times and durations of XML Schema, which are kept as the texts that they are."""

from __future__ import annotations

import re
from datetime import date

from mmrs_core.languages.values.texts import collapsed, render_collapsed, shown

_YEAR = r"-?(?:[1-9]\d{4,}|\d{4})"
_MONTH, _DAY = r"(?:0[1-9]|1[0-2])", r"(?:0[1-9]|[12]\d|3[01])"
_TIME = r"(?:(?:[01]\d|2[0-3]):[0-5]\d:(?:[0-5]\d|60)(?:\.\d+)?|24:00:00(?:\.0+)?)"
_ZONE = r"(?:Z|[+-](?:0\d|1[0-3]):[0-5]\d|[+-]14:00)?"
_DATE = rf"(?P<year>{_YEAR})-(?P<month>{_MONTH})-(?P<day>{_DAY})"
_FORMS = (
    f"{_DATE}(?:T{_TIME})?",
    _TIME,
    f"(?P<year>{_YEAR})(?:-{_MONTH})?",
    f"--(?P<month>{_MONTH})(?:-(?P<day>{_DAY}))?",
    f"---{_DAY}",
)
_MOMENTS = [re.compile(form + _ZONE, re.ASCII) for form in _FORMS]
_DURATION = re.compile(
    r"-?P(?=\d|T\d)(?:\d+Y)?(?:\d+M)?(?:\d+D)?(?:T(?=\d)(?:\d+H)?(?:\d+M)?(?:\d+(?:\.\d+)?S)?)?", re.ASCII
)
_LEAP_YEAR = 2000


def parse_moment(text: str) -> str:
    """Read a date, a time, or a part of a date; EMF takes each of them for any of those types."""
    found = next((match for form in _MOMENTS if (match := form.fullmatch(collapsed(text)))), None)
    if found is None or not _exists(found.groupdict()):
        raise ValueError(f"{shown(text)}: not a date or time of XML Schema, such as 2024-05-01T10:11:12Z")
    return found.group()


def _exists(parts: dict[str, str | None]) -> bool:
    """Return whether there is that day in that month; there is no year 0."""
    year, month, day = parts.get("year"), parts.get("month"), parts.get("day")
    if year is not None and not year.strip("-0"):
        return False
    if month is None or day is None:
        return True
    try:
        date(_LEAP_YEAR if year is None else int(year[-4:]) % 400 + 400, int(month), int(day))
    except ValueError:
        return False
    return True


def parse_duration(text: str) -> str:
    """Read a duration."""
    found = collapsed(text)
    if not _DURATION.fullmatch(found):
        raise ValueError(f"{shown(text)}: not a duration of XML Schema, such as P1DT12H")
    return found


def render_moment(value: object) -> str:
    """Write such a text; raises ValueError for what is none."""
    return parse_moment(render_collapsed(value))


def render_duration(value: object) -> str:
    """Write a duration; raises ValueError for what is none."""
    return parse_duration(render_collapsed(value))
