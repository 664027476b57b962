"""The tables of what was measured: distances, energy, photos, readings, links."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from mmrs_core.pictures.figures import clock, quantity
from mmrs_core.pictures.preview.markup import element, text
from mmrs_core.pictures.report.tables import Markup, badge, folded, section, table
from mmrs_core.pictures.report.values import Nearness, Report
from mmrs_core.pictures.report.words import UNKNOWN, level, metres, percent, place, seconds

_PAIRS = 20
"""How many pairs of robots are shown at once."""


def deviations(report: Report) -> str:
    """Return how far robots were off their ways."""
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
        "sideways, half under",
        "95 % under",
        "largest",
        "there",
        "height, half / 95 % under",
        "largest",
        "fixes",
    )
    note = (
        "From each fix to the nearest point of the way that its move should have gone; fixes outside of"
        " moves, on the ground, on the way to objects that had to be found, and while a policy led the"
        " robot elsewhere do not count."
        " Errors of the vehicle's own position are not in these figures."
    )
    return section("Planned against flown", table(head, rows) if rows else "", note=note)


def approaches(report: Report) -> str:
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
    head = ("robot", "area", "smallest distance", "required", "verdict", "when", "where")
    note = (
        "Measured in all three dimensions to the shapes as drawn, straight between fixes."
        " Required: the area's safety distance, half the robot's diagonal and the position error, which may"
        " be used up; nearer than that is too near."
    )
    return section("Distances to forbidden areas and obstacles", table(head, rows) if rows else "", note=note)


def separations(report: Report) -> str:
    """Return how near robots came to each other, the nearest first."""
    rows = [
        (
            f"{each.robot}, {each.other}",
            metres(each.kept),
            metres(each.required) if each.required is not None else "nothing asked for",
            _kept(each) if each.required is not None else "",
            clock(each.time),
            place(each.where),
        )
        for each in sorted(report.separations, key=lambda each: each.kept)
    ]
    head = ("robots", "smallest distance", "required", "verdict", "when", "where the first was")
    note = (
        "While both were under way; each went straight between its fixes. Required: the separation that the"
        " mission asks for, and the position error of both, which may be used up."
    )
    rest = folded(f"all {len(rows)} pairs", table(head, rows)) if len(rows) > _PAIRS else ""
    return section("Distances between robots", table(head, rows[:_PAIRS]) if rows else "", rest, note=note)


def _kept(approach: Nearness) -> Markup:
    if approach.required is None:
        return badge(UNKNOWN, "none")
    if approach.too_near:
        return badge("too near", "bad")
    return badge("kept, within the position error" if approach.within_error else "kept", "good")


def energies(report: Report) -> str:
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
    note = "Parts of a full battery; charges and changes of batteries count as new ones."
    return section("Energy", table(head, rows), note=note)


def _reserve(lowest: float | None, reserve: float) -> Markup:
    words = f"{percent(reserve)} to be left"
    if lowest is None:
        return badge(words, "none")
    return (
        badge(f"{words}: kept", "good") if lowest >= reserve - 0.005 else badge(f"{words}: not kept", "bad")
    )


def photos(report: Report) -> str:
    """Return photos, those first that nobody confirmed."""
    missing = [photo for photo in report.photos if photo.state == "not confirmed"]
    rest = [photo for photo in report.photos if photo.state != "not confirmed"]
    rows = [
        (
            "" if each.index is None else str(each.index),
            each.robot,
            clock(each.time),
            badge(each.state, {"taken": "good", "not confirmed": "bad"}.get(each.state, "none")),
            each.task,
            place(each.where),
        )
        for each in (*missing, *rest)
    ]
    if not rows:
        return ""
    words = f"{len(rest)} photos" if report.simulated else f"{len(rest)} photos were confirmed"
    words += f"; {len(missing)} were ordered and not confirmed" if missing else ""
    shown = table(("number", "robot", "time", "state", "task", "place"), rows)
    note = "Confirmed: the vehicle said that the camera took it. Nobody has looked at the pictures."
    return section("Photos", element("p", None, text(words + ".")), folded("all photos", shown), note=note)


def readings(report: Report) -> str:
    """Return what was measured and reported."""
    rows = [
        (clock(each.time), each.robot, each.kind, each.name, each.content, place(each.where))
        for each in report.readings
    ]
    head = ("time", "robot", "kind", "name", "content", "place")
    return section("Measurements and reports", table(head, rows) if rows else "")


def links(report: Report) -> str:
    """Return how well robots could be heard."""
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
    return section("Links", table(head, rows) if rows else "")


def _dropped(counts: Mapping[str, int]) -> str:
    """Return how many frames were dropped, by reason where there are reasons beside the types."""
    reasons: Counter[str] = Counter()
    for name, count in counts.items():
        reasons[name.partition(": ")[2] or name] += count
    told = (f"{count} {reason}" for reason, count in sorted(reasons.items()) if count)
    return ", ".join(told) or "none counted"
