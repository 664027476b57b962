"""The tables of what was asked and what happened: tasks, robots, waits, events, moves."""

from __future__ import annotations

from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.preview.markup import element, text
from mmrs_core.pictures.report.events import BY_PEOPLE
from mmrs_core.pictures.report.tables import Markup, badge, folded, section, table
from mmrs_core.pictures.report.values import Event, Report, Status, TaskReport
from mmrs_core.pictures.report.words import (
    UNKNOWN,
    metres,
    more_or_less,
    percent,
    seconds,
    span,
    spoken,
)

_KINDS = {
    Status.DONE: "good",
    Status.PART: "fair",
    Status.NOT_DONE: "bad",
    Status.NOT_CHOSEN: "none",
}


def tasks(report: Report) -> str:
    """Return what was asked and what was achieved."""
    rows = [
        (task.name, _status(task), ", ".join(task.robots) or "none", span(task.planned), _flown(task))
        for task in report.tasks
    ]
    head = ("task", "achieved", "robots", "planned", "flown")
    note = "Parts are of the planned working time of the moves that serve a task."
    return section("Tasks", table(head, rows) if rows else "", note=note)


def _status(task: TaskReport) -> Markup:
    words = f"{task.status.value}: {percent(task.part)}" if task.status is Status.PART else task.status.value
    bar = element("i", {"style": f"width: {100 * task.part:.1f}%"}, "\u200b")
    part = element("span", {"class": "part"}, bar) if task.status is Status.PART else ""
    return Markup(badge(words, _KINDS[task.status]) + part)


def _flown(task: TaskReport) -> str:
    if task.flown is None:
        return "never begun"
    return span(task.flown)


def robots(report: Report) -> str:
    """Return each robot as a whole."""
    rows = [
        (
            robot.robot,
            robot.type_name,
            badge(spoken(robot.ending), _ending(robot.ending)),
            f"{robot.moves[0]} of {robot.moves[1]}",
            f"{metres(robot.way)} of {metres(robot.planned_way)}",
            f"{seconds(robot.time)} of {seconds(robot.planned_time)}",
        )
        for robot in report.robots
    ]
    head = ("robot", "type", "program", "moves ended", "way, of planned", "time, of planned")
    return section("Robots", table(head, rows))


def _ending(words: str) -> str:
    if words == "to its end":
        return "good"
    wanted = words in BY_PEOPLE or words.startswith("suspended")
    return "fair" if wanted else "bad"


def waits(report: Report) -> str:
    """Return who waited for whom."""
    rows = [
        (
            each.robot,
            each.move,
            ", ".join(each.slots),
            ", ".join(each.setters) or UNKNOWN,
            f"{clock(each.since)} to {clock(each.since + each.seconds)}",
            seconds(each.seconds) + (", in vain" if each.until is None else ""),
            seconds(each.planned),
        )
        for each in report.waits
    ]
    head = ("robot", "after move", "for slots", "set by", "when", "waited", "planned")
    return section("Waits", table(head, rows) if rows else "")


def events(report: Report) -> str:
    """Return faults, decisions, orders and warnings."""
    rows = [
        (clock(each.time), each.robot, _event(each), _what(each), spoken(each.why)) for each in report.events
    ]
    head = ("time", "robot", "kind", "what", "why, and what was done")
    shown = table(head, rows) if rows else element("p", None, "None.")
    return section("Faults, decisions, orders, warnings", shown)


def _event(event: Event) -> Markup:
    words = {"text": "vehicle warns", "injected": "made on purpose"}.get(event.kind, event.kind)
    return badge(words, {"fault": "bad", "decision": "fair", "text": "fair"}.get(event.kind, "none"))


def _what(event: Event) -> str:
    """Return what happened; what a vehicle said stays as it said it."""
    return event.what if event.kind == "text" else spoken(event.what)


def moves(report: Report) -> str:
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
            more_or_less(each.flown, each.planned) if each.ended else "not ended",
        )
        for each in report.moves
    ]
    head = ("robot", "move", "kind", "task", "since", "took", "planned", "more")
    return section("Moves", folded(f"all {len(rows)} moves", table(head, rows))) if rows else ""


def unknown(report: Report) -> str:
    """Return what is not known, or was taken for granted."""
    notes = [
        *(f"the logs are no run of this behaviour: {each}" for each in report.complaints),
        *report.unknown,
    ]
    items = element("ul", None, (element("li", None, f"<bdi>{text(note)}</bdi>") for note in notes))
    return section("What is not known, and what was taken for granted", items if notes else "")
