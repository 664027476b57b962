"""The sections of a report: what was asked, what was achieved, what happened, what was measured."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from markupsafe import Markup

from mmrs_core.pictures.figures import clock, quantity
from mmrs_core.pictures.report.contents import Event, Nearness, Report, TaskReport, TaskStatus
from mmrs_core.pictures.report.events import BY_PEOPLE
from mmrs_core.pictures.report.wording import (
    UNKNOWN,
    level,
    metres,
    more_or_less,
    nearness,
    percent,
    place,
    seconds,
    span,
    spoken,
)

MOST_ROWS = 5000
"""Rows of a table that a page shows."""
_PAIRS = 20
"""Pairs of robots that are shown at once."""


class Badge(NamedTuple):
    """Words in a colour: ``good``, ``fair``, ``bad`` or ``none``; `part` is drawn as a bar, 0 to 1."""

    words: str
    kind: str
    part: float | None = None


Cell: TypeAlias = str | Badge


@dataclass(frozen=True, slots=True)
class Table:
    """A table; a folded one is shown on demand, under its `fold`."""

    head: tuple[str, ...]
    rows: Sequence[tuple[Cell, ...]]
    fold: str = ""

    @property
    def shown(self) -> Sequence[tuple[Cell, ...]]:
        """Return the rows that a page shows."""
        return self.rows[:MOST_ROWS]


@dataclass(frozen=True, slots=True)
class Section:
    """A section of the page; it is left out where it has neither words nor drawings nor rows.

    Attributes:
        note: how its figures are meant. words: what it says at once. notes: a list.
        drawings: (caption, drawing), wide ones.
    """

    title: str
    tables: tuple[Table, ...] = ()
    note: str = ""
    words: str = ""
    notes: tuple[str, ...] = ()
    drawings: tuple[tuple[str, Markup], ...] = ()

    @property
    def empty(self) -> bool:
        """Return whether it has nothing to show."""
        rows = any(table.rows for table in self.tables)
        return not (rows or self.words or self.notes or self.drawings)


def tasks(report: Report) -> Section:
    """Return what was asked and what was achieved."""
    rows = [
        (
            task.name,
            _status(task),
            ", ".join(task.robots) or "none",
            span(task.planned),
            span(task.flown) if task.flown is not None else "not started",
        )
        for task in report.tasks
    ]
    table = Table(("task", "achieved", "robots", "planned", "flown"), rows)
    return Section("Tasks", (table,), "Fractions of the planned working time of the moves that serve a task.")


def _status(task: TaskReport) -> Badge:
    kinds = {
        TaskStatus.DONE: "good",
        TaskStatus.PART: "fair",
        TaskStatus.NOT_DONE: "bad",
        TaskStatus.NOT_CHOSEN: "none",
    }
    if task.status is TaskStatus.PART:
        return Badge(f"{task.status.value}: {percent(task.part)}", "fair", task.part)
    return Badge(task.status.value, kinds[task.status])


def robots(report: Report) -> Section:
    """Return each robot as a whole."""
    rows = [
        (
            robot.robot,
            robot.type_name,
            Badge(spoken(robot.ending), _ending(robot.ending)),
            f"{robot.moves[0]} of {robot.moves[1]}",
            f"{metres(robot.way)} of {metres(robot.planned_way)}",
            f"{seconds(robot.time)} of {seconds(robot.planned_time)}",
        )
        for robot in report.robots
    ]
    head = (
        "robot",
        "type",
        "program",
        "moves completed",
        "distance flown / planned",
        "time (flown / planned)",
    )
    return Section("Robots", (Table(head, rows),))


def _ending(words: str) -> str:
    if words == "completed":
        return "good"
    wanted = words in BY_PEOPLE or words.startswith("suspended")
    return "fair" if wanted else "bad"


def waits(report: Report) -> Section:
    """Return which robot waited for which."""
    rows = [
        (
            each.robot,
            each.move,
            ", ".join(each.slots),
            ", ".join(each.setters) or UNKNOWN,
            f"{clock(each.since)} to {clock(each.since + each.seconds)}",
            seconds(each.seconds) + (", timed out" if each.until is None else ""),
            seconds(each.planned),
        )
        for each in report.waits
    ]
    head = ("robot", "after move", "for slots", "set by", "when", "waited", "planned")
    return Section("Waits", (Table(head, rows),))


def events(report: Report) -> Section:
    """Return faults, decisions, commands and warnings."""
    rows = [
        (clock(each.time), each.robot, _event(each), _what(each), spoken(each.why)) for each in report.events
    ]
    table = Table(("time", "robot", "kind", "what", "cause and response"), rows)
    return Section("Faults, decisions, commands, warnings", (table,), words="" if rows else "None.")


def _event(event: Event) -> Badge:
    words = {"text": "vehicle warning", "order": "command"}.get(event.kind, event.kind)
    return Badge(words, {"fault": "bad", "decision": "fair", "text": "fair"}.get(event.kind, "none"))


def _what(event: Event) -> str:
    """Return what happened; a vehicle's own words are quoted."""
    return event.what if event.kind == "text" else spoken(event.what)


def moves(report: Report) -> Section:
    """Return every move, folded."""
    rows = [
        (
            each.robot,
            each.move,
            each.kind,
            each.task,
            clock(each.entered),
            seconds(each.flown),
            seconds(each.planned),
            more_or_less(each.flown, each.planned) if each.ended else "not completed",
        )
        for each in report.moves
    ]
    head = ("robot", "move", "kind", "task", "since", "took", "planned", "difference")
    return Section("Moves", (Table(head, rows, f"all {len(rows)} moves"),))


def unknown(report: Report) -> Section:
    """Return what is unknown or was assumed."""
    complaints = (f"the logs do not match this behaviour: {each}" for each in report.complaints)
    return Section("Unknowns and assumptions", notes=(*complaints, *report.unknown))


def deviations(report: Report) -> Section:
    """Return how far robots were off their planned paths."""
    rows = [
        (
            each.robot,
            metres(each.sideways.median),
            metres(each.sideways.most),
            f"{metres(each.sideways.largest)} at {clock(each.time)}, move {each.move}",
            place(each.where),
            f"{metres(each.upwards.median)} / {metres(each.upwards.most)}",
            f"{metres(each.upwards.largest)} at {clock(each.high_time)}, move {each.high_move}",
            str(each.fixes),
        )
        for each in report.deviations
    ]
    head = (
        "robot",
        "cross-track, median",
        "95 %",
        "maximum",
        "position",
        "altitude, median / 95 %",
        "maximum",
        "fixes",
    )
    note = (
        "From each fix to the nearest point of its move's planned path. Fixes outside of moves, on the"
        " ground, during searches for objects and during off-plan responses do not count."
        " Errors of the vehicle's own position are not in these figures."
    )
    return Section("Planned vs. flown", (Table(head, rows),), note)


def approaches(report: Report) -> Section:
    """Return how near robots came to areas."""
    ordered = sorted(report.approaches, key=lambda each: each.kept - (each.required or 0.0))
    rows = [
        (
            each.robot,
            f"{each.area} ({each.use})",
            metres(each.kept) if each.kept > 0 else "inside",
            metres(each.required),
            _kept(each),
            clock(each.time),
            place(each.where),
        )
        for each in ordered
    ]
    head = ("robot", "area", "closest approach", "required clearance", "verdict", "when", "position")
    note = (
        "Measured in three dimensions to the shapes as drawn, straight between fixes."
        " Required: the area's safety distance, half the robot's diagonal and the position error, which may"
        " be used up; closer than that is too close."
    )
    return Section("Distances to forbidden areas and obstacles", (Table(head, rows),), note)


def separations(report: Report) -> Section:
    """Return how near robots came to each other, the nearest first."""
    rows = [
        (
            f"{each.robot}, {each.other}",
            metres(each.kept),
            metres(each.required) if each.required is not None else "no separation required",
            _kept(each) if each.required is not None else "",
            clock(each.time),
            place(each.where),
        )
        for each in sorted(report.separations, key=lambda each: each.kept)
    ]
    head = ("robots", "closest approach", "required separation", "verdict", "when", "first robot's position")
    note = (
        "While both were in motion, straight between fixes. Required: the mission's minimum separation and"
        " the position error of both, which may be used up."
    )
    rest = (Table(head, rows, f"all {len(rows)} pairs"),) if len(rows) > _PAIRS else ()
    return Section("Distances between robots", (Table(head, rows[:_PAIRS]), *rest), note)


def _kept(approach: Nearness) -> Badge:
    kind = "none" if approach.required is None else "bad" if approach.too_near else "good"
    return Badge(nearness(approach), kind)


def energies(report: Report) -> Section:
    """Return what robots used of their batteries."""
    rows = [
        (
            each.robot,
            level(each.planned, each.capacity),
            level(each.used, each.capacity),
            f"{level(each.lowest)} at {clock(each.lowest_at)}" if each.lowest_at is not None else UNKNOWN,
            level(each.planned_lowest),
            level(each.end),
            _reserve(each.lowest, each.reserve),
        )
        for each in report.energies
    ]
    head = ("robot", "planned use", "used", "lowest", "lowest as planned", "at the end", "reserve")
    note = "Fractions of a full battery; a charged or replaced battery counts as a new one."
    return Section("Energy", (Table(head, rows),), note)


def _reserve(lowest: float | None, reserve: float) -> Badge:
    if lowest is None:
        return Badge(percent(reserve), "none")
    kept = lowest >= reserve - 0.005
    return Badge(f"{percent(reserve)}: {'kept' if kept else 'not kept'}", "good" if kept else "bad")


def photos(report: Report) -> Section:
    """Return photos, unconfirmed ones first."""
    missing = [photo for photo in report.photos if photo.state == "not confirmed"]
    rest = [photo for photo in report.photos if photo.state != "not confirmed"]
    rows = [
        (
            "" if each.index is None else str(each.index),
            each.robot,
            clock(each.time),
            Badge(each.state, {"taken": "good", "not confirmed": "bad"}.get(each.state, "none")),
            each.task,
            place(each.where),
        )
        for each in (*missing, *rest)
    ]
    words = f"{len(rest)} photos" if report.simulated else f"{len(rest)} photos were confirmed"
    words += f"; {len(missing)} were commanded and not confirmed" if missing else ""
    table = Table(("number", "robot", "time", "state", "task", "position"), rows, "all photos")
    note = (
        "Confirmed: the vehicle reported that the camera took it. The pictures themselves were not examined."
    )
    return Section("Photos", (table,), note, f"{words}." if rows else "")


def readings(report: Report) -> Section:
    """Return what was measured and reported."""
    rows = [
        (clock(each.time), each.robot, each.kind, each.name, each.content, place(each.where))
        for each in report.readings
    ]
    head = ("time", "robot", "kind", "name", "content", "position")
    return Section("Measurements and reports", (Table(head, rows),))


def links(report: Report) -> Section:
    """Return the quality of the links."""
    rows = [
        (
            each.robot,
            ", ".join(part for part in (each.vehicle, each.by) if part) or UNKNOWN,
            str(each.fixes),
            f"{each.gaps}, {seconds(each.silent)} in all" if each.gaps else "none",
            seconds(each.longest) if each.gaps else "",
            _dropped(each.dropped),
            f"{each.commands}, {each.repeated} repeated, {each.refused} not accepted",
            quantity(each.slowest, "s") if each.slowest is not None else "",
        )
        for each in report.links
    ]
    head = (
        "robot",
        "vehicle, link",
        "fixes",
        "gaps",
        "longest",
        "frames dropped",
        "commands",
        "slowest answer",
    )
    return Section("Links", (Table(head, rows),))


def _dropped(counts: Mapping[str, int]) -> str:
    """Return how many frames were dropped, by cause where there are causes beside the types."""
    causes: Counter[str] = Counter()
    for name, count in counts.items():
        causes[name.partition(": ")[2] or name] += count
    listed = (f"{count} {cause}" for cause, count in sorted(causes.items()) if count)
    return ", ".join(listed) or "none counted"
