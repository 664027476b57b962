"""Areas, obstacles, relays and the environment of a context."""

from __future__ import annotations

from collections.abc import Iterator

import shapely

from mmrs_core.analysis.constraints.findings import CONTEXT, called, finding
from mmrs_core.analysis.constraints.sketch import DrawnArea, sketch_of
from mmrs_core.analysis.stations import stations_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, number
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import AreaUse
from mmrs_core.scene.relays import RELAY, Relay


def _upside_down(element: Element, models: ModelSet) -> Iterator[Finding]:
    low, high = number(element, "minHeight"), number(element, "maxHeight")
    if low is not None and high is not None and low >= high:
        yield finding(element, f"its minHeight of {low:g} m is not below its maxHeight of {high:g} m")


_TALL = 1000.0
"""Metres above the origin that no building reaches: the tallest has 828 m."""


def _too_tall(obstacle: Element, models: ModelSet) -> Iterator[Finding]:
    high = number(obstacle, "maxHeight")
    if high is not None and high > _TALL:
        yield finding(obstacle, f"its maxHeight is {high:g} m, higher than any building")


def _emergencies(models: ModelSet) -> Iterator[DrawnArea]:
    return (area for area in sketch_of(models).areas if area.use is AreaUse.EMERGENCY)


def _forbidden_emergency(context: Element, models: ModelSet) -> Iterator[Finding]:
    for area in _emergencies(models):
        for other in _around(area, models):
            yield finding(area.element, f"lies inside {called(other.element)}")


def _around(area: DrawnArea, models: ModelSet) -> list[DrawnArea]:
    return [
        other
        for other in sketch_of(models).kept_from
        if _stands(other) and area.shape.within(other.shape.buffer(other.safety_distance))
    ]


def _stands(area: DrawnArea) -> bool:
    """Return whether an area keeps robots from the ground."""
    return area.low <= 0.0 < area.high


def _narrow_emergency(context: Element, models: ModelSet) -> Iterator[Finding]:
    clearances = [robot.clearance for robot in sketch_of(models).robots]
    known = [each for each in clearances if each is not None]
    if not known or len(known) < len(clearances):
        return
    for area in _emergencies(models):
        room = shapely.maximum_inscribed_circle(area.shape, tolerance=0.01).length
        needed = area.safety_distance + min(known)
        if room + 0.01 < needed:
            yield finding(
                area.element,
                f"has room for a robot within {room:.2f} m of its sides, but {needed:.2f} m are needed",
            )
        elif not _around(area, models):
            yield from _crowded(area, needed, min(known), models)


def _crowded(area: DrawnArea, inwards: float, clearance: float, models: ModelSet) -> Iterator[Finding]:
    """Yield that an emergency area has no point far enough from its sides and clear of other areas."""
    barred = [
        (other, other.shape.buffer(other.safety_distance + clearance))
        for other in sketch_of(models).kept_from
        if _stands(other)
    ]
    inside = area.shape.buffer(0.01 - inwards)
    if inside.difference(shapely.union_all([shape for _, shape in barred])).is_empty:
        near = " and ".join(called(other.element) for other, shape in barred if shape.intersects(inside))
        yield finding(area.element, f"has no room for a robot that keeps from {near}")


def _too_cold_or_hot(environment: Element, models: ModelSet) -> Iterator[Finding]:
    temperature = number(environment, "temperature")
    for name, robot_type in sorted(models.robots.items()):
        limits = child(robot_type, "operatingTemperature")
        low, high = (number(limits, "min"), number(limits, "max")) if limits is not None else (None, None)
        if temperature is None or low is None or high is None or low <= temperature <= high:
            continue
        yield finding(
            environment, f"{temperature:g} °C are outside of what {name!r} works in: {low:g} to {high:g} °C"
        )


_SWAP = "swap them, or leave out the one that is not known"


def _severed_relays(context: Element, models: ModelSet) -> Iterator[Finding]:
    """Find the relays of which no chain leads to the home of any robot whose range is known."""
    positions, relays = sketch_of(models).ground.positions, dict[Relay, Element]()
    for each in children(context, "elements"):
        at, range = child(each, "position"), number(each, "range")
        if is_kind(each, *RELAY) and at is not None and at in positions and range is not None and range > 0.0:
            relays[Relay(label_of(each), positions[at], range)] = each
    severed: dict[Relay, str] | None = None
    for robot in sketch_of(models).robots:
        reach = number(robot.type, "communicationRange") if robot.type is not None else None
        if robot.home is None or reach is None:
            return
        found = dict(stations_of(robot.home, reach, list(relays))[1])
        severed = {each: why for each, why in (severed or found).items() if each in found}
        if not severed:
            return
    for relay, why in (severed or {}).items():
        yield finding(relays[relay], f"no chain of relays leads from it to the home of a robot: {why}")


CONSTRAINTS = (
    Constraint(
        "CTX007",
        "The lower side of an obstacle is below its upper side.",
        (CONTEXT, "Obstacle"),
        _upside_down,
        _SWAP,
    ),
    Constraint(
        "CTX019",
        "The lower side of a corridor is below its upper side.",
        (CONTEXT, "Corridor"),
        _upside_down,
        _SWAP,
    ),
    Constraint(
        "CTX017",
        "An obstacle is not higher than any building.",
        (CONTEXT, "Obstacle"),
        _too_tall,
        "give metres above the origin, not feet or centimetres; leave maxHeight out where there is no limit",
        Severity.WARNING,
    ),
    Constraint(
        "CTX010",
        "No emergency area lies inside a forbidden area or obstacle.",
        (CONTEXT, "Context"),
        _forbidden_emergency,
        "move the emergency area to where robots may go",
    ),
    Constraint(
        "CTX015",
        "An emergency area has room for a robot.",
        (CONTEXT, "Context"),
        _narrow_emergency,
        "draw it larger or farther from what robots keep from, or make its safetyDistance smaller",
        Severity.WARNING,
    ),
    Constraint(
        "CTX021",
        "From every relay a chain leads to the home of a robot.",
        (CONTEXT, "Context"),
        _severed_relays,
        "move the relay nearer, or put another one in between",
        Severity.WARNING,
    ),
    Constraint(
        "CTX016",
        "The temperature suits every robot type.",
        (CONTEXT, "Environment"),
        _too_cold_or_hot,
        "choose another day or another robot",
        Severity.WARNING,
    ),
)
