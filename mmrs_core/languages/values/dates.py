"""Dates as values: what EMF reads from a text, and a text that EMF reads as that date.

EMF reads dates with Java's ``SimpleDateFormat``: it counts the digits behind the point of the seconds in
milliseconds, knows a zone only behind them and only as +0200, GMT+2:00, GMT or UTC, takes the time zone of
its machine where there is none, and lets 13 months pass. So do we, with UTC for the machine's zone; a date
keeps the text of its file, and knows what is doubtful about it. Before 15 October 1582, where Java counts in
the Julian calendar, there are no dates here.
"""

from __future__ import annotations

import re
from datetime import UTC, date, datetime, timedelta, timezone
from typing import Self

from mmrs_core.languages.values.texts import shown

_GREGORIAN = date(1582, 10, 15)
_OUTSIDE = "before 15 October 1582, when the calendar changed, or after the year 9999: not supported"
_LONGEST = 9
_BLANKS = "[ \t]*"
_NUMBER = rf"{_BLANKS}(-?\d+)"
_ZONE = (
    rf"{_BLANKS}(?P<zone>(?P<sign>[+-])(?P<hours>[01][0-9]|2[0-3])(?P<minutes>[0-5][0-9])|"
    r"(?i:GMT)(?P<sign2>[+-])(?P<hours2>[01]?[0-9]|2[0-3]):(?P<minutes2>[0-5][0-9])|(?i:GMT(?![+-])|UTC))"
)
_FORM = re.compile(
    rf"{_NUMBER}-{_NUMBER}-{_NUMBER}"
    rf"(?:T{_NUMBER}:{_NUMBER}(?::{_NUMBER}(?:\.{_NUMBER}(?:{_ZONE})?)?)?)?(?P<rest>.*)",
    re.DOTALL,
)
_NAMED_ZONE = re.compile(rf"{_BLANKS}[A-Za-z]{{2}}")


class WrittenDate(datetime):
    """A date whose file writes it otherwise than EMF would; any other date of that instant equals it.

    What is made of it by arithmetic is a date like any other, and written as EMF writes dates.

    Attributes:
        text: what the file says.
        local: whether EMF would take it in the time zone of its machine.
    """

    text: str = ""
    local: bool = False

    @classmethod
    def of(cls, plain: datetime, text: str, local: bool) -> Self:
        """Return a date as a file writes it."""
        made = cls.combine(plain.date(), plain.timetz())
        made.text, made.local = text, local
        return made

    @property
    def plain(self) -> datetime:
        """The same date without its text."""
        return datetime.combine(self.date(), self.timetz())

    def __reduce_ex__(self, protocol: object) -> tuple[object, ...]:
        """Let copies keep the text."""
        return WrittenDate.of, (self.plain, self.text, self.local)


def parse_date(text: str) -> datetime:
    """Read a date as EMF does on a machine whose clock shows UTC.

    Returns:
        A plain date if its text is the one that EMF writes, else a `WrittenDate`.

    Raises:
        ValueError: if EMF reads none, or one before 15 October 1582 or after the year 9999, or if a zone
            has another name than GMT or UTC.
    """
    found = _FORM.match(text)
    numbers = found.groups("0")[:7] if found is not None else ()
    if found is None or any(len(number.lstrip("-0")) > _LONGEST for number in numbers):
        raise ValueError(f"{shown(text)}: not a date such as 2024-05-01T10:11:12.123+0200")
    if found[7] and not found["zone"] and _NAMED_ZONE.match(found["rest"]):
        raise ValueError(f"{shown(text)}: a zone by name; write it as +0200")
    try:
        value = _instant(*map(int, numbers), zone=_zone(found))
    except (ValueError, OverflowError):
        raise ValueError(f"{shown(text)}: {_OUTSIDE}") from None
    if found["zone"] and _render_plain(value) == text:
        return value
    return WrittenDate.of(value, text, local=not found["zone"])


def _zone(found: re.Match[str]) -> timezone:
    sign, hours, minutes = (found[name] or found[f"{name}2"] for name in ("sign", "hours", "minutes"))
    offset = timedelta(hours=int(hours or 0), minutes=int(minutes or 0))
    return timezone(-offset if sign == "-" else offset) if offset else UTC


def _instant(
    year: int, month: int, day: int, hour: int, minute: int, second: int, milli: int, *, zone: timezone
) -> datetime:
    """Return a date of parts that have no bounds; raises ValueError or OverflowError for none of ours."""
    more, index = divmod(month - 1, 12)
    since = timedelta(days=day - 1, hours=hour, minutes=minute, seconds=second, milliseconds=milli)
    value = datetime(year + more, index + 1, 1, tzinfo=zone) + since
    if year < _GREGORIAN.year or value.date() < _GREGORIAN:
        raise ValueError
    return value


def render_date(value: object) -> str:
    """Write a date as its file did, or as EMF does if it comes from none; one without a zone is taken as UTC.

    Raises:
        ValueError: if it is finer than EMF's milliseconds, or before 15 October 1582.
    """
    assert isinstance(value, datetime)  # accepts() vouches for it
    if isinstance(value, WrittenDate) and value.text:
        return value.text
    if value.microsecond % 1000:
        raise ValueError(f"{value.isoformat()}: finer than milliseconds")
    return _render_plain(value)


def _render_plain(value: datetime) -> str:
    offset = value.utcoffset()
    try:
        if offset is not None and offset % timedelta(minutes=1):
            value = value.astimezone(UTC)  # its zone is one of the time before railways
    except OverflowError:
        raise ValueError(f"{value.isoformat()}: {_OUTSIDE}") from None
    if value.date() < _GREGORIAN:
        raise ValueError(f"{value.isoformat()}: {_OUTSIDE}")
    zone = f"{value:%z}" or "+0000"
    return f"{value:%Y-%m-%dT%H:%M:%S}.{value.microsecond // 1000:03}{zone}"


def doubt_of_date(value: object) -> str:
    """Return what of a date is not plain from its text, and after a semicolon what to write instead."""
    if not isinstance(value, WrittenDate) or not value.text:
        naive = isinstance(value, datetime) and value.tzinfo is None
        return "has no zone and is written as UTC; state its zone" if naive else ""
    known = _render_plain(value)
    if value.local:
        return f"is read as {known}, and by Eclipse in the time zone of its machine; {_advice(value)}"
    usual = re.sub(r"-0000$", "+0000", value.text.strip(" "))
    return "" if usual == known else f"is read as {known}, as by Eclipse; {_advice(value)}"


def _advice(value: WrittenDate) -> str:
    """Return what to write: what ISO 8601 makes of the text, if it differs from what EMF does."""
    known = _render_plain(value)
    try:
        meant = datetime.fromisoformat(value.text.strip())
        other = render_date(meant if meant.tzinfo else meant.replace(tzinfo=UTC))
    except ValueError:
        other = known
    return f"write {known}" if other == known else f"write {other} if that is meant, else {known}"
