"""What must hold for rovers, for terrain, and for missions that use them."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, number, text
from mmrs_core.languages.element import Element, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_rover.names import ROVER, TERRAIN
from mmrs_rover.places import off_level, on_impassable_ground
from mmrs_rover.terrain import LIMITS

MISSION = ("urn:mmrs:mission:1.0", "Mission")
UPRIGHT = 90.0
"""Degrees."""


def _unknown_curves(rover: Element, models: ModelSet) -> Iterator[Finding]:
    if text(rover, "drive") == "WHEELS" and number(rover, "turningRadius") is None:
        yield Finding(rover, f"turningRadius of '{label_of(rover)}' is missing, and it is on wheels")


def _wide_on_tracks(rover: Element, models: ModelSet) -> Iterator[Finding]:
    radius = number(rover, "turningRadius") or 0.0
    if text(rover, "drive") == "TRACKS" and radius > 0.0:
        yield Finding(rover, f"turningRadius of '{label_of(rover)}' is {radius:g} m, though it is on tracks")


def _negative_limits(rover: Element, models: ModelSet) -> Iterator[Finding]:
    for name in ("turningRadius", "maxSlope", "wadingDepth", "groundClearance"):
        figure = number(rover, name)
        if figure is not None and not figure >= 0.0:
            yield Finding(rover, f"{name} of '{label_of(rover)}' is {figure:g}, it must not be negative")


def _climbs_walls(rover: Element, models: ModelSet) -> Iterator[Finding]:
    steepest = number(rover, "maxSlope") or 0.0
    if not steepest < UPRIGHT:
        yield Finding(rover, f"maxSlope of '{label_of(rover)}' is {steepest:g}°, upright is {UPRIGHT:g}°")


def _taller_than_itself(feature: str, rover: Element) -> Iterator[Finding]:
    size, figure = child(rover, "size"), number(rover, feature)
    height = number(size, "height") if size is not None else None
    if height is not None and figure is not None and figure >= height:
        yield Finding(
            rover, f"{feature} of '{label_of(rover)}' is {figure:g} m, it is itself only {height:g} m high"
        )


def _drowns(rover: Element, models: ModelSet) -> Iterator[Finding]:
    return _taller_than_itself("wadingDepth", rover)


def _on_stilts(rover: Element, models: ModelSet) -> Iterator[Finding]:
    return _taller_than_itself("groundClearance", rover)


def _harmless(terrain: Element, models: ModelSet) -> Iterator[Finding]:
    if not any(number(terrain, feature) for feature, _, _ in LIMITS):
        names = ", ".join(feature for feature, _, _ in LIMITS)
        yield Finding(terrain, f"terrain '{label_of(terrain)}' states none of {names}: it bars no robot")


def _no_such_ground(terrain: Element, models: ModelSet) -> Iterator[Finding]:
    for feature, _, _ in LIMITS:
        figure = number(terrain, feature)
        if figure is not None and not figure >= 0.0:
            yield Finding(
                terrain, f"{feature} of terrain '{label_of(terrain)}' is {figure:g}, it must not be negative"
            )
    slope = number(terrain, "slope") or 0.0
    if slope > UPRIGHT:
        yield Finding(
            terrain, f"slope of terrain '{label_of(terrain)}' is {slope:g}°, upright is {UPRIGHT:g}°"
        )


CONSTRAINTS = (
    Constraint(
        "ROV001",
        "A rover on wheels states its turning radius",
        ROVER,
        _unknown_curves,
        "write turningRadius, in metres; 0 for wheels that turn it on the spot",
    ),
    Constraint(
        "ROV002",
        "A rover on tracks turns on the spot",
        ROVER,
        _wide_on_tracks,
        'leave turningRadius out, or write drive="WHEELS"',
        Severity.WARNING,
    ),
    Constraint(
        "ROV003",
        "The limits of a rover are not negative",
        ROVER,
        _negative_limits,
        "correct the figure, or leave it out",
    ),
    Constraint(
        "ROV004",
        "A rover climbs no walls",
        ROVER,
        _climbs_walls,
        "write maxSlope in degrees from level; 100 % are 45 degrees",
    ),
    Constraint(
        "ROV005",
        "A rover wades through no water that is as deep as it is high",
        ROVER,
        _drowns,
        "write wadingDepth in metres, or correct the height of its size",
    ),
    Constraint(
        "ROV006",
        "The ground clearance of a rover is less than its height",
        ROVER,
        _on_stilts,
        "write groundClearance in metres, or correct the height of its size",
    ),
    Constraint(
        "ROV007",
        "Terrain states what makes it hard to pass",
        TERRAIN,
        _harmless,
        "write its slope, waterDepth or stepHeight; what no robot may enter is a forbidden area",
        Severity.WARNING,
    ),
    Constraint(
        "ROV008",
        "Slope, water and steps of terrain are possible",
        TERRAIN,
        _no_such_ground,
        "write the slope in degrees from level, depth and height in metres",
    ),
    Constraint(
        "ROV009",
        "The home of a rover lies on ground that it can pass, with room to turn",
        MISSION,
        on_impassable_ground,
        "move the home, or use a type of rover that gets over that ground",
    ),
    Constraint(
        "ROV010",
        "Some robot of the team gets to the height of each task",
        MISSION,
        off_level,
        "leave the task's altitude out, which puts it on the ground, or add a robot that flies or dives",
    ),
)
