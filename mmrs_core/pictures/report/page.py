"""Makes the page of a report; it needs neither a network nor a script."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import datetime

import numpy as np
from markupsafe import Markup

from mmrs_core.pictures.documents import render, style_sheets
from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.flights.planned import PlannedLeg
from mmrs_core.pictures.palette import style_of, variables
from mmrs_core.pictures.preview.key import gaps_in_words, key_of
from mmrs_core.pictures.preview.map import map_of
from mmrs_core.pictures.preview.picture import Picture
from mmrs_core.pictures.preview.profile import BARS_OF_FLIGHTS, profile_of
from mmrs_core.pictures.preview.timeline import KEY_OF_FLIGHTS, timeline_of
from mmrs_core.pictures.report import tables
from mmrs_core.pictures.report.assembly import Given
from mmrs_core.pictures.report.charts import battery_chart, cross_track_chart
from mmrs_core.pictures.report.contents import Report, TaskStatus
from mmrs_core.pictures.report.deviations import deviations_over_time
from mmrs_core.pictures.report.energies import planned_levels
from mmrs_core.pictures.report.tables import Section
from mmrs_core.pictures.report.wording import metres, nearness, percent, spoken
from mmrs_runtime.policies import EVENTS

_NO_TRACK = "Its track is unknown; pale: its planned path."


def page(report: Report, given: Given, picture: Picture) -> str:
    """Return a whole HTML document; nothing in it refers to another file."""
    document = render(
        "report.html",
        title=report.title or "mission",
        style=Markup(variables()) + style_sheets("page", "map", "charts", "report"),
        lead=f"{_when(report.begun)}; run {report.run or 'without a name'}. Origin: {picture.origin}.",
        simulated=report.simulated,
        injected=report.injected,
        verdict=verdict(report),
        figures=list(figures(report)),
        map=map_of(picture),
        key=key_of(picture),
        gaps=gaps_in_words(picture),
        tasks=tables.tasks(report),
        sections=[section for section in _sections(report, given, picture) if not section.empty],
        foot=_foot(report),
    )
    return str(document)


def _when(begun: str) -> str:
    try:
        return datetime.fromisoformat(begun).strftime("%-d %B %Y, %H:%M:%S UTC")
    except ValueError:
        return "Date and time of day unknown"


def _sections(report: Report, given: Given, picture: Picture) -> Iterator[Section]:
    """Yield the sections beneath the map."""
    yield tables.robots(report)
    yield tables.events(report)
    yield Section("Timeline and waits", note=KEY_OF_FLIGHTS, drawings=(("", timeline_of(picture)),))
    yield Section("Altitude above origin", note=BARS_OF_FLIGHTS, drawings=(("", profile_of(picture)),))
    yield tables.deviations(report)
    yield tables.approaches(report)
    yield tables.separations(report)
    yield tables.energies(report)
    yield tables.waits(report)
    legs = given.legs()
    for index, robot in enumerate(picture.robots):
        yield _robot(index, robot.name, given, picture, legs[robot.name])
    yield tables.photos(report)
    yield tables.readings(report)
    yield tables.links(report)
    yield tables.moves(report)
    yield tables.unknown(report)


def _robot(index: int, name: str, given: Given, picture: Picture, legs: Sequence[PlannedLeg]) -> Section:
    flown, colour = given.flight.robots[name], style_of(index).colour
    pieces = deviations_over_time(flown, legs)
    drawings = [("", map_of(picture, only=index))]
    if pieces:
        drawings.append(("Cross-track error in metres", cross_track_chart(pieces, picture.shown, colour)))
    battery = bool(np.isfinite(flown.track.energies).any())
    if battery:
        levels, _ = planned_levels(given.planned.run, name)
        samples = given.planned.run.tracks.get(name, ()) if given.planned.run is not None else ()
        planned = np.array([sample.time for sample in samples if sample.energy is not None])
        lines = (flown.track.times, flown.track.energies), (planned[: len(levels)], levels)
        drawn = battery_chart(*lines, given.program.reserve, picture.shown, colour)
        drawings.append(("Battery; dashed grey: as planned; red: the reserve", drawn))
    note = "" if len(flown.track.times) else _NO_TRACK
    return Section(name, note=note, words="" if battery else "No battery data.", drawings=tuple(drawings))


def verdict(report: Report) -> tuple[str, str]:
    """Return one sentence on how it went, and its colour: ``good``, ``fair`` or ``bad``."""
    asked = [task for task in report.tasks if task.status is not TaskStatus.NOT_CHOSEN]
    done = sum(task.status is TaskStatus.DONE for task in asked)
    ended = sum(robot.ended_early for robot in report.robots)
    near = any(each.too_near for each in (*report.approaches, *report.separations))
    success = report.outcome == "success"
    whole = "all robots completed their programs" if success else ""
    tasks = f"{done} of {len(asked)} tasks done" if asked else whole
    early = f"{ended} robot{'s' * (ended != 1)} ended early" if ended else ""
    close = "a required distance was not kept" if near else ""
    empty = any(e.lowest is not None and e.lowest < e.reserve - 0.005 for e in report.energies)
    low = "a battery fell below the reserve" if empty else ""
    strange = "the logs do not match this behaviour" if report.complaints else ""
    unfinished = "not all programs were completed" if not success and not ended else ""
    words = "; ".join(each for each in (tasks, early, unfinished, close, low, strange) if each)
    if near or strange or (asked and not done):
        return words, "bad"
    words = words or "how it ended is unknown"
    return words, "good" if done == len(asked) and success and not empty else "fair"


def figures(report: Report) -> Iterator[tuple[str, str]]:
    """Yield the figures that matter first: (name, value)."""
    yield "time", clock(report.duration)
    tracks = [robot.way for robot in report.robots if robot.way is not None]
    yield "total distance", metres(sum(tracks)) if len(tracks) == len(report.robots) else "unknown"
    if report.deviations:
        worst = max(report.deviations, key=lambda each: each.sideways.largest)
        yield "maximum cross-track error", f"{metres(worst.sideways.largest)} ({worst.robot})"
    judged = [each for each in report.approaches if each.required is not None]
    if judged:
        nearest = min(judged, key=lambda each: each.kept - (each.required or 0.0))
        distance = f"{nearest.kept:.2f} m of {nearest.required:.2f} m"
        value = f"{distance}, {nearness(nearest)} ({nearest.robot}, {nearest.area})"
        yield "closest approach (required clearance)", value
    lowest = [(each.lowest, each.robot) for each in report.energies if each.lowest is not None]
    if lowest:
        part, robot = min(lowest)
        yield "lowest battery level", f"{percent(part)} ({robot})"
    if report.photos and not report.simulated:
        taken = sum(photo.state == "taken" for photo in report.photos)
        yield "photos confirmed", f"{taken} of {len(report.photos)}"
    yield "faults", _faults(report)


def _faults(report: Report) -> str:
    """Return how many faults there were, and which: those that ended programs, or were responded to."""
    ended = [(e.robot, e.what.partition(":")[0]) for e in report.events if e.kind == "fault"]
    decided = [(e.robot, e.what) for e in report.events if e.kind == "decision" and e.what in EVENTS]
    faults = [*ended, *(each for each in decided if each not in ended)]
    names = dict.fromkeys(spoken(name) for _, name in faults)
    return f"{len(faults)} ({', '.join(names)})" if faults else "none"


def _foot(report: Report) -> str:
    tracks = [robot.way for robot in report.robots if robot.way is not None]
    total = f" Total distance: {metres(sum(tracks))}." if len(tracks) == len(report.robots) else ""
    return f"Times are minutes and seconds since the run began; it took {clock(report.duration)}.{total}"
