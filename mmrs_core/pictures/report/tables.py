"""The sections of a report: what was asked, what was achieved, what happened, what was measured."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeAlias, TypeVar

from markupsafe import Markup

from mmrs_core.pictures.figures import clock, quantity
from mmrs_core.pictures.report.contents import (
    EnergyReport,
    Event,
    LinkReport,
    Nearness,
    Report,
    Separation,
    Spread,
    TaskReport,
    TaskStatus,
)
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
Item = TypeVar("Item")


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


def _table(items: Iterable[Item], *columns: tuple[str, Callable[[Item], Cell]], fold: str = "") -> Table:
    """Return a table with a row for each item, from columns: (name, the item's cell)."""
    head = tuple(name for name, _ in columns)
    return Table(head, [tuple(cell(item) for _, cell in columns) for item in items], fold)


def tasks(report: Report) -> Section:
    """Return what was asked and what was achieved."""
    table = _table(
        report.tasks,
        ("task", lambda task: task.name),
        ("achieved", _status),
        ("robots", lambda task: ", ".join(task.robots) or "none"),
        ("planned", lambda task: span(task.planned)),
        ("flown", lambda task: span(task.flown) if task.flown is not None else "not started"),
    )
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
    table = _table(
        report.robots,
        ("robot", lambda each: each.robot),
        ("type", lambda each: each.type_name),
        ("program", lambda each: Badge(spoken(each.ending), _ending(each.ending))),
        ("moves completed", lambda each: f"{each.moves[0]} of {each.moves[1]}"),
        ("distance flown / planned", lambda each: f"{metres(each.way)} of {metres(each.planned_way)}"),
        ("time (flown / planned)", lambda each: f"{seconds(each.time)} of {seconds(each.planned_time)}"),
    )
    return Section("Robots", (table,))


def _ending(words: str) -> str:
    if words == "completed":
        return "good"
    wanted = words in BY_PEOPLE or words.startswith("suspended")
    return "fair" if wanted else "bad"


def waits(report: Report) -> Section:
    """Return which robot waited for which."""
    table = _table(
        report.waits,
        ("robot", lambda each: each.robot),
        ("after move", lambda each: each.move),
        ("for slots", lambda each: ", ".join(each.slots)),
        ("set by", lambda each: ", ".join(each.setters) or UNKNOWN),
        ("when", lambda each: f"{clock(each.since)} to {clock(each.since + each.seconds)}"),
        ("waited", lambda each: seconds(each.seconds) + (", timed out" if each.until is None else "")),
        ("planned", lambda each: seconds(each.planned)),
    )
    return Section("Waits", (table,))


def events(report: Report) -> Section:
    """Return faults, decisions, commands and warnings."""
    table = _table(
        report.events,
        ("time", lambda each: clock(each.time)),
        ("robot", lambda each: each.robot),
        ("kind", _event),
        ("what", _what),
        ("cause and response", lambda each: spoken(each.why)),
    )
    words = "" if report.events else "None."
    return Section("Faults, decisions, commands, warnings", (table,), words=words)


def _event(event: Event) -> Badge:
    words = {"text": "vehicle warning", "order": "command"}.get(event.kind, event.kind)
    return Badge(words, {"fault": "bad", "decision": "fair", "text": "fair"}.get(event.kind, "none"))


def _what(event: Event) -> str:
    """Return what happened; a vehicle's own words are quoted."""
    return event.what if event.kind == "text" else spoken(event.what)


def moves(report: Report) -> Section:
    """Return every move, folded."""
    table = _table(
        report.moves,
        ("robot", lambda each: each.robot),
        ("move", lambda each: each.move),
        ("kind", lambda each: each.kind),
        ("task", lambda each: each.task),
        ("since", lambda each: clock(each.entered)),
        ("took", lambda each: seconds(each.flown)),
        ("planned", lambda each: seconds(each.planned)),
        (
            "difference",
            lambda each: more_or_less(each.flown, each.planned) if each.ended else "not completed",
        ),
        fold=f"all {len(report.moves)} moves",
    )
    return Section("Moves", (table,))


def unknown(report: Report) -> Section:
    """Return what is unknown or was assumed."""
    complaints = (f"the logs do not match this behaviour: {each}" for each in report.complaints)
    return Section("Unknowns and assumptions", notes=(*complaints, *report.unknown))


def deviations(report: Report) -> Section:
    """Return how far robots were off their planned paths."""
    table = _table(
        report.deviations,
        ("robot", lambda each: each.robot),
        ("cross-track, median", lambda each: metres(each.sideways.median)),
        ("95 %", lambda each: metres(each.sideways.most)),
        ("maximum", lambda each: _largest(each.sideways, each.time, each.move)),
        ("position", lambda each: place(each.where)),
        (
            "altitude, median / 95 %",
            lambda each: f"{metres(each.upwards.median)} / {metres(each.upwards.most)}",
        ),
        ("maximum", lambda each: _largest(each.upwards, each.high_time, each.high_move)),
        ("fixes", lambda each: str(each.fixes)),
    )
    note = (
        "From each fix to the nearest point of its move's planned path. Fixes outside of moves, on the"
        " ground, during searches for objects and during off-plan responses do not count."
        " Errors of the vehicle's own position are not in these figures."
    )
    return Section("Planned vs. flown", (table,), note)


def _largest(spread: Spread, time: float, move: str) -> str:
    return f"{metres(spread.largest)} at {clock(time)}, move {move}"


def approaches(report: Report) -> Section:
    """Return how near robots came to areas."""
    table = _table(
        sorted(report.approaches, key=lambda each: each.kept - (each.required or 0.0)),
        ("robot", lambda each: each.robot),
        ("area", lambda each: f"{each.area} ({each.use})"),
        ("closest approach", lambda each: metres(each.kept) if each.kept > 0 else "inside"),
        ("required clearance", lambda each: metres(each.required)),
        ("verdict", _kept),
        ("when", lambda each: clock(each.time)),
        ("position", lambda each: place(each.where)),
    )
    note = (
        "Measured in three dimensions to the shapes as drawn, straight between fixes."
        " Required: the area's safety distance, half the robot's diagonal and the position error, which may"
        " be used up; closer than that is too close."
    )
    return Section("Distances to forbidden areas and obstacles", (table,), note)


def separations(report: Report) -> Section:
    """Return how near robots came to each other, the nearest first."""
    table = _table(
        sorted(report.separations, key=lambda each: each.kept),
        ("robots", lambda each: f"{each.robot}, {each.other}"),
        ("closest approach", lambda each: metres(each.kept)),
        ("required separation", _required),
        ("verdict", lambda each: _kept(each) if each.required is not None else ""),
        ("when", lambda each: clock(each.time)),
        ("first robot's position", lambda each: place(each.where)),
    )
    note = (
        "While both were in motion, straight between fixes. Required: the mission's minimum separation and"
        " the position error of both, which may be used up."
    )
    pairs = len(table.rows)
    rest = (replace(table, fold=f"all {pairs} pairs"),) if pairs > _PAIRS else ()
    return Section("Distances between robots", (replace(table, rows=table.rows[:_PAIRS]), *rest), note)


def _required(each: Separation) -> str:
    return metres(each.required) if each.required is not None else "no separation required"


def _kept(approach: Nearness) -> Badge:
    kind = "none" if approach.required is None else "bad" if approach.too_near else "good"
    return Badge(nearness(approach), kind)


def energies(report: Report) -> Section:
    """Return what robots used of their batteries."""
    table = _table(
        report.energies,
        ("robot", lambda each: each.robot),
        ("planned use", lambda each: level(each.planned, each.capacity)),
        ("used", lambda each: level(each.used, each.capacity)),
        ("lowest", _lowest),
        ("lowest as planned", lambda each: level(each.planned_lowest)),
        ("at the end", lambda each: level(each.end)),
        ("reserve", lambda each: _reserve(each.lowest, each.reserve)),
    )
    note = "Fractions of a full battery; a charged or replaced battery counts as a new one."
    return Section("Energy", (table,), note)


def _lowest(each: EnergyReport) -> str:
    return f"{level(each.lowest)} at {clock(each.lowest_at)}" if each.lowest_at is not None else UNKNOWN


def _reserve(lowest: float | None, reserve: float) -> Badge:
    if lowest is None:
        return Badge(percent(reserve), "none")
    kept = lowest >= reserve - 0.005
    return Badge(f"{percent(reserve)}: {'kept' if kept else 'not kept'}", "good" if kept else "bad")


def photos(report: Report) -> Section:
    """Return photos, unconfirmed ones first."""
    missing = [photo for photo in report.photos if photo.state == "not confirmed"]
    rest = [photo for photo in report.photos if photo.state != "not confirmed"]
    table = _table(
        (*missing, *rest),
        ("number", lambda each: "" if each.index is None else str(each.index)),
        ("robot", lambda each: each.robot),
        ("time", lambda each: clock(each.time)),
        (
            "state",
            lambda each: Badge(each.state, {"taken": "good", "not confirmed": "bad"}.get(each.state, "none")),
        ),
        ("task", lambda each: each.task),
        ("position", lambda each: place(each.where)),
        fold="all photos",
    )
    words = f"{len(rest)} photos" if report.simulated else f"{len(rest)} photos were confirmed"
    words += f"; {len(missing)} were commanded and not confirmed" if missing else ""
    note = (
        "Confirmed: the vehicle reported that the camera took it. The pictures themselves were not examined."
    )
    return Section("Photos", (table,), note, f"{words}." if report.photos else "")


def readings(report: Report) -> Section:
    """Return what was measured and reported."""
    table = _table(
        report.readings,
        ("time", lambda each: clock(each.time)),
        ("robot", lambda each: each.robot),
        ("kind", lambda each: each.kind),
        ("name", lambda each: each.name),
        ("content", lambda each: each.content),
        ("position", lambda each: place(each.where)),
    )
    return Section("Measurements and reports", (table,))


def links(report: Report) -> Section:
    """Return the quality of the links."""
    table = _table(
        report.links,
        ("robot", lambda each: each.robot),
        ("vehicle, link", lambda each: ", ".join(filter(None, (each.vehicle, each.by))) or UNKNOWN),
        ("fixes", lambda each: str(each.fixes)),
        ("gaps", lambda each: f"{each.gaps}, {seconds(each.silent)} in all" if each.gaps else "none"),
        ("longest", lambda each: seconds(each.longest) if each.gaps else ""),
        ("frames dropped", lambda each: _dropped(each.dropped)),
        ("commands", _commands),
        ("slowest answer", lambda each: quantity(each.slowest, "s") if each.slowest is not None else ""),
    )
    return Section("Links", (table,))


def _commands(each: LinkReport) -> str:
    return f"{each.commands}, {each.repeated} repeated, {each.refused} not accepted"


def _dropped(counts: Mapping[str, int]) -> str:
    """Return how many frames were dropped, by cause where there are causes beside the types."""
    causes: Counter[str] = Counter()
    for name, count in counts.items():
        causes[name.partition(": ")[2] or name] += count
    listed = (f"{count} {cause}" for cause, count in sorted(causes.items()) if count)
    return ", ".join(listed) or "none counted"
