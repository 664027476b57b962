"""Positions on the Earth as people paste them: in decimals, in minutes and seconds, as links of maps."""

from __future__ import annotations

import re
from urllib.parse import unquote

from mmrs_core.drawings.angles import MARKS, SIXTY
from mmrs_core.errors import UsageError

FORMS = "such as 43.77, 11.25 or 43°46'12\"N 11°15'0\"E, a geo: address, or a link of a map program"
_LONGEST, _LONGEST_LINK = 200, 2000
_DECIMAL = r"([+-]?\d{1,4}(?:\.\d+)?)"
_LINKS = tuple(
    re.compile(each)
    for each in (
        rf"^geo:{_DECIMAL},{_DECIMAL}",
        rf"!3d{_DECIMAL}!4d{_DECIMAL}",
        rf"@{_DECIMAL},{_DECIMAL}",
        rf"[?&](?:q|query|ll|center|daddr|destination)=(?:loc:)?{_DECIMAL},\s*{_DECIMAL}",
        rf"[?&]mlat={_DECIMAL}&mlon={_DECIMAL}",
        rf"#map=\d+(?:\.\d+)?/{_DECIMAL}/{_DECIMAL}",
    )
)
_BODY = r"""(?P<sign{n}>[+-])?\s*(?P<degrees{n}>\d{{1,4}}(?:[.,]\d+)?)(?:\s*°)?
    (?:(?:(?<=°)\s*|\s+)(?P<minutes{n}>\d{{1,2}}(?:[.,]\d+)?)\s*'(?:\s*(?P<seconds{n}>\d{{1,2}}(?:[.,]\d+)?)\s*(?:"|\'\'))?)?"""
_FIRST, _SECOND = (_BODY.format(n=number) for number in "12")
_BETWEEN = r"(?:\s*[,;/]\s*|\s+|(?<=[NSEW])|(?<=['\"]))"
_PAIRS = tuple(
    re.compile(each, re.VERBOSE | re.IGNORECASE | re.ASCII)
    for each in (
        rf"(?P<axis1>[NSEW])\s*{_FIRST}{_BETWEEN}?(?P<axis2>[NSEW])\s*{_SECOND}",
        rf"{_FIRST}\s*(?P<axis1>[NSEW])?{_BETWEEN}{_SECOND}\s*(?P<axis2>[NSEW])?",
    )
)
_AXES = {"N": "latitude", "S": "latitude", "E": "longitude", "W": "longitude"}


def position_of(text: str, source: str = "position") -> tuple[float, float]:
    r"""Return the latitude and longitude that a text states, in degrees.

    Latitude comes first, unless letters (N, S, E, W) say otherwise.

    >>> position_of("43.77, 11.25")
    (43.77, 11.25)
    >>> position_of("11°15'E 43°46'12\"N")
    (43.77, 11.25)
    >>> position_of("https://www.google.com/maps/@43.77,11.25,15z")
    (43.77, 11.25)

    Raises:
        UsageError: if it is none, or not on the Earth.
    """
    wanted = text.strip().strip("()[]").translate(MARKS)
    is_link = "://" in wanted or wanted.lower().startswith("geo:")
    if len(wanted) > (_LONGEST_LINK if is_link else _LONGEST):
        raise UsageError(f"{source}: too long for a position; expected one {FORMS}")
    if is_link:
        link = unquote(wanted)
        found = next((match for each in _LINKS if (match := each.search(link))), None)
        if found is None:
            raise UsageError(f"{source}: no position in this link; expected one {FORMS}")
        return _on_earth(float(found[1]), float(found[2]), source)
    pair = next((found for each in _PAIRS if (found := each.fullmatch(wanted))), None)
    if pair is None or (
        ("," in pair["degrees1"]) is not ("," in pair["degrees2"]) and {".", ","} <= {*wanted}
    ):
        raise UsageError(f"{source}: {_short(text)!r} is not a position; expected one {FORMS}")
    one, other = (_angle(pair, number, source) for number in "12")
    axes = [_AXES.get((pair[f"axis{number}"] or "").upper()) for number in "12"]
    if axes[0] is not None and axes[0] == axes[1]:
        raise UsageError(f"{source}: {_short(text)!r} states the {axes[0]} twice")
    if axes[0] == "longitude" or axes[1] == "latitude":
        one, other = other, one
    return _on_earth(one, other, source)


def _angle(pair: re.Match[str], number: str, source: str) -> float:
    parts = (pair[f"{name}{number}"] or "0" for name in ("degrees", "minutes", "seconds"))
    degrees, minutes, seconds = (float(each.replace(",", ".")) for each in parts)
    if minutes >= SIXTY or seconds >= SIXTY:
        raise UsageError(f"{source}: minutes and seconds are below {SIXTY}")
    letter = (pair[f"axis{number}"] or "").upper()
    size = round(degrees + minutes / SIXTY + seconds / SIXTY**2, 9)
    return -size if pair[f"sign{number}"] == "-" or letter in ("S", "W") else size


def _on_earth(latitude: float, longitude: float, source: str) -> tuple[float, float]:
    if abs(latitude) <= 90 and abs(longitude) <= 180:
        return latitude, longitude
    swapped = abs(longitude) <= 90 < abs(latitude) <= 180
    hint = "; latitude comes first" if swapped else "; latitudes go to 90, longitudes to 180"
    raise UsageError(f"{source}: {latitude:g}, {longitude:g} is not on the Earth{hint}")


def _short(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:59]}…"
