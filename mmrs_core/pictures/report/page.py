"""Makes the page of a report; it needs neither a network nor a script."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import datetime

import numpy as np

from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.flights.planned import PlannedLeg
from mmrs_core.pictures.preview.key import key_markup
from mmrs_core.pictures.preview.map_drawing import map_markup
from mmrs_core.pictures.preview.markup import element, style_sheet, text
from mmrs_core.pictures.preview.palette import style_of
from mmrs_core.pictures.preview.picture import Picture
from mmrs_core.pictures.preview.profile import BARS_OF_FLIGHTS, profile_markup
from mmrs_core.pictures.preview.timeline import KEY_OF_FLIGHTS, timeline_markup
from mmrs_core.pictures.report import measures, sections
from mmrs_core.pictures.report.charts import battery_chart, off_way_chart
from mmrs_core.pictures.report.deviations import deviations_over_time
from mmrs_core.pictures.report.energies import planned_levels
from mmrs_core.pictures.report.making import Given
from mmrs_core.pictures.report.summary import tiles, verdict
from mmrs_core.pictures.report.tables import section
from mmrs_core.pictures.report.values import Report
from mmrs_core.pictures.report.words import metres

_POLICY = "default-src 'none'; style-src 'unsafe-inline'"
_NO_MAP = "Where it was is not known; pale: where it should have been."


def page(report: Report, given: Given, picture: Picture) -> str:
    """Return a whole HTML document; nothing in it refers to another file."""
    title = f"{report.title or 'mission'}: report"
    head = (
        '<meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{text(_POLICY)}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        '<meta name="color-scheme" content="light dark">',
        element("title", None, text(title)),
        element("style", None, _style()),
    )
    body = (_head(report, picture), *_sections(report, given, picture), _foot(report))
    markup = element("head", None, head) + element("body", {"class": "report"}, body)
    return f'<!doctype html>\n<html lang="en">{markup}</html>\n'


def _style() -> str:
    own = style_sheet("report.css", "mmrs_core.pictures.report")
    return style_sheet("page.css") + own + style_sheet("dark.css")


def _head(report: Report, picture: Picture) -> str:
    lead = f"{_when(report.begun)}; run {report.run or 'without a name'}. Origin: {picture.origin}."
    simulated = element("p", {"class": "verdict none"}, "Simulated: no vehicle has flown this.")
    return element(
        "header",
        None,
        element("h1", None, text(report.title or "mission")),
        element("p", None, f"<bdi>{text(lead)}</bdi>"),
        simulated if report.simulated else "",
        _injected(report),
        verdict(report),
        tiles(report),
    )


def _injected(report: Report) -> str:
    if not report.injected:
        return ""
    words = f"A rehearsal: these faults were made on purpose: {', '.join(report.injected)}."
    return element("p", {"class": "verdict none"}, text(words))


def _when(begun: str) -> str:
    try:
        return datetime.fromisoformat(begun).strftime("%-d %B %Y, %H:%M:%S UTC")
    except ValueError:
        return "Date and time of day not known"


def _sections(report: Report, given: Given, picture: Picture) -> Iterator[str]:
    yield sections.tasks(report)
    yield section("Map", _map(picture), key_markup(picture))
    yield sections.robots(report)
    yield sections.events(report)
    shown = _wide(timeline_markup(picture))
    yield section("Who did what, and who waited for whom", shown, note=KEY_OF_FLIGHTS)
    yield section("Heights above the origin", _wide(profile_markup(picture)), note=BARS_OF_FLIGHTS)
    yield measures.deviations(report)
    yield measures.approaches(report)
    yield measures.separations(report)
    yield measures.energies(report)
    yield sections.waits(report)
    legs = given.legs()
    for index, robot in enumerate(picture.robots):
        yield _robot(index, robot.name, report, given, picture, legs[robot.name])
    yield measures.photos(report)
    yield measures.readings(report)
    yield measures.links(report)
    yield sections.moves(report)
    yield sections.unknown(report)


def _robot(
    index: int, name: str, report: Report, given: Given, picture: Picture, legs: Sequence[PlannedLeg]
) -> str:
    flown, colour = given.flight.robots[name], style_of(index).colour
    pieces = deviations_over_time(flown, legs)
    levels, _ = planned_levels(given.planned.run, name)
    samples = given.planned.run.tracks.get(name, ()) if given.planned.run is not None else ()
    planned = np.array([sample.time for sample in samples if sample.energy is not None])
    charts = [_chart("Metres sideways from the planned way", off_way_chart(pieces, picture.shown, colour))]
    if np.isfinite(flown.track.energies).any():
        line = (planned[: len(levels)], levels)
        battery = flown.track.times, flown.track.energies
        drawn = battery_chart(battery, line, given.program.reserve, picture.shown, colour)
        charts.append(_chart("Battery; dashed grey: as planned; red: the reserve", drawn))
    else:
        charts.append(element("p", {"class": "soft"}, "Its battery was not told."))
    words = "" if len(flown.track.times) else _NO_MAP
    return section(name, _map(picture, index), *(charts if pieces else charts[1:]), note=words)


def _chart(words: str, drawn: str) -> str:
    return element("figure", None, element("figcaption", None, text(words)), _wide(drawn))


def _wide(drawn: str) -> str:
    return element("div", {"class": "wide"}, drawn)


def _map(picture: Picture, only: int | None = None) -> str:
    return element("div", {"class": "sheet"}, map_markup(picture, only=only))


def _foot(report: Report) -> str:
    ways = [robot.way for robot in report.robots if robot.way is not None]
    all_ways = f" All robots travelled {metres(sum(ways))}." if len(ways) == len(report.robots) else ""
    words = (
        f"Times are minutes and seconds since the run began, which took {clock(report.duration)}.{all_ways}"
    )
    return element("footer", None, element("p", None, text(words)))
