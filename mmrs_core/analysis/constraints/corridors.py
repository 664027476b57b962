"""Corridors of entry and exit."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from shapely.geometry import LineString

from mmrs_core.analysis.constraints.findings import CONTEXT, called, finding, guessed, listed
from mmrs_core.analysis.constraints.sketch import DrawnArea, DrawnRobot, sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity, lengths
from mmrs_core.grounding.features import children, number, text, texts
from mmrs_core.grounding.parts import heights_of
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet


def _line(corridor: Element, models: ModelSet) -> LineString | None:
    """Return the line of a corridor; None where one of its places is not known."""
    positions, places = sketch_of(models).ground.positions, children(corridor, "points")
    if len(places) < 2 or any(each not in positions for each in places):
        return None
    return LineString([positions[each][:2] for each in places])


def _pointless(corridor: Element, models: ModelSet) -> Iterator[Finding]:
    line = _line(corridor, models)
    if line is not None and line.length <= 0.0:
        yield finding(corridor, "its line leads nowhere: all its places are the same")


def _blocked(corridor: Element, models: ModelSet) -> Iterator[Finding]:
    line = _line(corridor, models)
    if line is None or line.length <= 0.0:
        return
    for area in sketch_of(models).kept_from:
        short = area.safety_distance - line.distance(area.shape)
        if _shuts(area, *heights_of(corridor)) and (short > 0.0 or line.crosses(area.shape)):
            within = f" with its safetyDistance of {area.safety_distance:g} m" if area.safety_distance else ""
            yield finding(corridor, f"its line leads through {called(area.element)}{within}")


def _shuts(area: DrawnArea, low: float, high: float) -> bool:
    """Return whether an area leaves nothing between two heights."""
    return area.low - area.safety_distance <= low and high <= area.high + area.safety_distance


def _users(corridor: Element, models: ModelSet) -> list[DrawnRobot]:
    """Return the robots of the team that a corridor is for."""
    types = texts(corridor, "robotTypes")
    robots = sketch_of(models).robots
    return [
        each for each in robots if not types or (each.type is not None and text(each.type, "name") in types)
    ]


def _narrow(corridor: Element, models: ModelSet) -> Iterator[Finding]:
    users = _users(corridor, models)
    known = [each.clearance for each in users if each.clearance is not None]
    if not known or len(known) < len(users):
        return
    needed, width, (low, high) = 2.0 * min(known), number(corridor, "width"), heights_of(corridor)
    if width is not None and 0.0 < width < needed:
        yield finding(corridor, _short("wide", width, needed))
    if low < high < inf and high - low < needed:
        yield finding(corridor, _short("high", high - low, needed))


def _short(word: str, has: float, needed: float) -> str:
    told, least = lengths(has, needed)
    return f"is {told} {word}, but the smallest of its robots needs more than {least}"


def _unknown_types(corridor: Element, models: ModelSet) -> Iterator[Finding]:
    for name in texts(corridor, "robotTypes"):
        if name not in models.robots and "" not in models.robots:  # which may be the one that is meant
            hint = guessed(f"known are {listed(sorted(models.robots))}", name, models.robots)
            yield finding(corridor, f"unknown robot type {name!r}", hint if models.robots else "")


CONSTRAINTS = (
    Constraint(
        "CTX024",
        "The line of a corridor leads from one place to another.",
        (CONTEXT, "Corridor"),
        _pointless,
        "draw the line from outside to the field of work",
    ),
    Constraint(
        "CTX025",
        "The line of a corridor does not lead through a forbidden area or obstacle.",
        (CONTEXT, "Corridor"),
        _blocked,
        "draw the corridor or the area elsewhere, or let the corridor lead above or beneath the area",
    ),
    Constraint(
        "CTX026",
        "A corridor has room for a robot.",
        (CONTEXT, "Corridor"),
        _narrow,
        "make it wider or higher, or name by robotTypes which robots it is for",
        Severity.WARNING,
    ),
    Constraint(
        "CTX027",
        "The robot types that a corridor is for are known.",
        (CONTEXT, "Corridor"),
        _unknown_types,
        "correct the name, or add the robot type to the project's robots folder",
    ),
)
