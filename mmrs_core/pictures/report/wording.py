"""Figures of a report in words, with their units."""

from __future__ import annotations

import re

from mmrs_core.contributions.checks import AT_LIMIT
from mmrs_core.pictures.figures import clock, energy, length
from mmrs_core.pictures.flights.positions import GeoPosition
from mmrs_core.pictures.report.contents import Nearness
from mmrs_runtime.policies import EVENTS, RESPONSES

UNKNOWN = "unknown"
_CODES = frozenset((*EVENTS, *RESPONSES, "ORDERED", "REFUSED", "STOPPED", "CRASHED"))
_CODE = re.compile(r"(?<![\w'])[A-Z]+(?:_[A-Z]+)*(?![\w'])")


def seconds(value: float | None) -> str:
    """Return a duration.

    >>> seconds(3.25), seconds(75.0), seconds(None)
    ('3.2 s', '1:15', 'unknown')
    """
    if value is None:
        return UNKNOWN
    return f"{value:.1f} s" if abs(value) < 60 else clock(value)


def more_or_less(flown: float, planned: float | None) -> str:
    """Return by how much something took longer than planned.

    >>> more_or_less(12.0, 10.0), more_or_less(10.0, 12.0), more_or_less(1.0, None)
    ('+2.0 s', '−2.0 s', '')
    """
    if planned is None:
        return ""
    return f"{'+' if flown >= planned else '−'}{seconds(abs(flown - planned))}"


def metres(value: float | None) -> str:
    """Return a distance as exact as it is measured.

    >>> metres(0.034), metres(12.34), metres(None)
    ('0.03 m', '12.3 m', 'unknown')
    """
    if value is None:
        return UNKNOWN
    return f"{value:.2f} m" if abs(value) < 10 else length(value)


def percent(part: float | None) -> str:
    """Return a part of something.

    >>> percent(0.256), percent(0.9999), percent(0.0001), percent(None)
    ('26 %', '99.9 %', '0.1 %', 'unknown')
    """
    if part is None:
        return UNKNOWN
    if 0 < part < 0.005:
        return "0.1 %"
    return "99.9 %" if 0.995 <= part < 1 else f"{100 * part:.0f} %"


def level(part: float | None, capacity: float | None = None) -> str:
    """Return a part of a battery, with the energy where it is known how much a full one holds.

    >>> level(0.25, 360_000.0), level(0.25), level(None)
    ('25 % (25.0 Wh)', '25 %', 'unknown')
    """
    if part is None or capacity is None:
        return UNKNOWN if part is None else f"{100 * part:.0f} %"
    return f"{100 * part:.0f} % ({energy(part * capacity)})"


def nearness(approach: Nearness) -> str:
    """Return how near something came, compared with what was required.

    At the limit is what is within a centimetre of it; the part of the limit that allows for errors is
    named, because it is what is left to use up.
    """
    errors = f" {approach.error:g} m of it" if approach.error else ""
    if approach.required is None:
        return UNKNOWN
    if approach.too_near:
        return "too close"
    if approach.within_error:
        return f"within the{f' {approach.error:g} m' if errors else ''} position error"
    if approach.kept - approach.required < AT_LIMIT:
        return f"at the limit;{errors} is for position errors" if errors else "at the limit"
    return "kept"


def place(where: GeoPosition | None) -> str:
    """Return where something was: degrees where it lies on the Earth, else metres; and the height.

    >>> place(GeoPosition((1.0, 2.0, 3.0), 42.37, 13.35)), place(GeoPosition((1.0, -2.0, 3.0)))
    ('42.3700000, 13.3500000, 3.0 m up', '1.0 m east, -2.0 m north, 3.0 m up')
    """
    if where is None:
        return UNKNOWN
    east, north, up = where.position
    if where.latitude is None or where.longitude is None:
        return f"{east:.1f} m east, {north:.1f} m north, {up:.1f} m up"
    return f"{where.latitude:.7f}, {where.longitude:.7f}, {up:.1f} m up"


def spoken(words: str) -> str:
    """Return words with the names of events and responses in small letters; GPS stays GPS.

    >>> spoken("no GPS fix; failsafe switched it to LAND; response: EMERGENCY_AREA")
    'no GPS fix; failsafe switched it to land; response: emergency area'
    """
    return _CODE.sub(lambda found: _plain(found[0]), words)


def _plain(code: str) -> str:
    return code.replace("_", " ").lower() if "_" in code or code in _CODES else code


def span(times: tuple[float, float | None] | None) -> str:
    """Return from when to when.

    >>> span((0.0, 65.0)), span((5.0, None)), span(None)
    ('0:00 to 1:05', 'from 0:05', 'unknown')
    """
    if times is None:
        return UNKNOWN
    return f"from {clock(times[0])}" if times[1] is None else f"{clock(times[0])} to {clock(times[1])}"
