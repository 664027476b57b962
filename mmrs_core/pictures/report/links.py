"""How well robots could be heard, and how they answered."""

from __future__ import annotations

import re

from mmrs_core.pictures.flights.values import Flown
from mmrs_core.pictures.report.values import LinkReport
from mmrs_runtime.records.entries import number_of

_SORT = re.compile(r"(udp|tcp|serial|simulation|can)", re.IGNORECASE)
_ACCEPTED = frozenset({"ACCEPTED", "IN_PROGRESS"})


def link_of(flown: Flown) -> LinkReport | None:
    """Return what is known of the link to a robot; None where there is no black box of it."""
    if not len(flown.track.times) and not flown.entries:
        return None
    commands = flown.of_kind("command")
    tries = [number_of(entry.content.get("tries")) or 1.0 for entry in commands]
    seconds = [found for entry in commands if (found := number_of(entry.content.get("seconds"))) is not None]
    gaps = [until - since for since, until in flown.track.gaps]
    starts = flown.of_kind("start")
    start = starts[0].content if starts else {}
    words = [str(start[name]) for name in ("vehicle", "firmware") if start.get(name)]
    return LinkReport(
        flown.robot,
        ", ".join(words),
        _sort(start.get("link")),
        len(flown.track.times),
        len(gaps),
        max(gaps, default=0.0),
        sum(gaps),
        dict(flown.counted),
        len(commands),
        sum(each > 1 for each in tries),
        sum(str(entry.content.get("result", "")) not in _ACCEPTED for entry in commands),
        max(seconds, default=None),
    )


def _sort(link: object) -> str:
    """Return the sort of a link, without any address or path."""
    if not isinstance(link, str) or not link:
        return ""
    found = _SORT.match(link)
    return found[0].lower() if found else "serial"
