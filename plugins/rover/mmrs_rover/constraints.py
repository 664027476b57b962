"""What must hold for rovers, for terrain, and for missions that use them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import atan2, degrees, dist, pi, tan

from shapely import Point

from mmrs_core.analysis.constraints.ranges import Range, at_least_zero, every
from mmrs_core.analysis.constraints.sketch import DrawnRobot, Sketch, polygon_of, sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.coordinates import heights_of_task
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.uris import BEHAVIOUR
from mmrs_rover.names import ROVER, TERRAIN
from mmrs_rover.terrain import LIMITS, hindrances

EXACT = 1e-6
"""Metres."""


def off_level(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks on whose level no rover of the team is; none where some robot is not a rover."""
    sketch = sketch_of(models)
    levels = {_level(robot) for robot in sketch.robots}
    if None in levels or not levels:
        return
    known = sorted(level for level in levels if level is not None)
    for task in children(mission, "tasks"):
        heights = heights_of_task(task, sketch.ground)
        if heights and not any(all(abs(up - level) <= EXACT for up in heights) for level in known):
            yield Finding(task, _words(task, heights, known))


def _words(task: Element, heights: tuple[float, ...], levels: list[float]) -> str:
    low, high = min(heights), max(heights)
    where = f"{low:g} m" if low == high else f"{low:g} to {high:g} m"
    stay = " or ".join(f"{level:g} m" for level in levels)
    return f"task '{label_of(task)}' is at {where}, the team's rovers stay on the ground at {stay}"


def _level(robot: DrawnRobot) -> float | None:
    """Return the height of a rover's home; None for other robots, or without a position."""
    if robot.type is None or robot.home is None or not is_kind(robot.type, *ROVER):
        return None
    return robot.home[2]


def on_impassable_ground(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the rovers whose homes are in, or too near to, terrain that they cannot pass."""
    sketch = sketch_of(models)
    for robot in sketch.robots:
        if robot.type is None or robot.home is None or not is_kind(robot.type, *ROVER):
            continue
        for terrain, why in _hindering(robot.type, models):
            short = _short(robot, terrain, sketch)
            if short > EXACT:
                yield Finding(
                    robot.element,
                    f"home of '{label_of(robot.element)}' is {short:.2f} m too near to"
                    f" '{label_of(terrain)}': {why}",
                )


def _hindering(rover: Element, models: ModelSet) -> Iterator[tuple[Element, str]]:
    for terrain in children(models.context, "elements"):
        if is_kind(terrain, *TERRAIN):
            why = " and ".join(hindrances(partial(number, rover), partial(number, terrain)))
            yield from ((terrain, why),) if why else ()


def _short(robot: DrawnRobot, terrain: Element, sketch: Sketch) -> float:
    """Return by how much a home is too near to terrain, metres; negative where it is not."""
    ring = sketch.ring(terrain, "shell")
    shape = polygon_of(ring) if ring is not None else None
    if shape is None or robot.home is None or robot.type is None:
        return 0.0
    room = (robot.clearance or 0.0) + (number(robot.type, "turningRadius") or 0.0)
    kept = float(shape.distance(Point(robot.home[:2])))
    return room + (number(terrain, "safetyDistance") or 0.0) - kept


MISSION = ("urn:mmrs:mission:1.0", "Mission")


def _unknown_curves(rover: Element, models: ModelSet) -> Iterator[Finding]:
    if text(rover, "drive") == "WHEELS" and number(rover, "turningRadius") is None:
        yield Finding(rover, f"turningRadius of '{label_of(rover)}' is missing, and it is on wheels")


def _wide_on_tracks(rover: Element, models: ModelSet) -> Iterator[Finding]:
    radius = number(rover, "turningRadius") or 0.0
    if text(rover, "drive") == "TRACKS" and radius > 0.0:
        yield Finding(rover, f"turningRadius of '{label_of(rover)}' is {radius:g} m, though it is on tracks")


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


def _overruns_corners(robot: Element, models: ModelSet) -> Iterator[Finding]:
    rover = models.robots.get(text(robot, "typeName"))
    radius = number(rover, "turningRadius") if rover is not None and is_kind(rover, *ROVER) else None
    places = {move: _place_after(move, models) for move in children(robot, "moves")}
    into = [(child(each, "from"), child(each, "to"), each) for each in children(robot, "moveTransitions")]
    before = {to: origin for origin, to, _ in into if origin is not None and to is not None}
    for origin, to, transition in into:
        if not radius or origin is None or to is None or transition.eGet("fluid") is not True:
            continue
        first = before.get(origin)
        start = places.get(first) if first is not None else None
        corner, end = places.get(origin), places.get(to)
        if start and corner and end and (why := _narrow(start, corner, end, radius)):
            yield Finding(origin, f"end of '{label_of(origin)}' is passed without a stop, and {why}")


def _place_after(move: Element, models: ModelSet) -> tuple[float, float] | None:
    """Return where a GoTo leads, and a Start leaves a robot, east and north; None for any other move."""
    at = child(move, "target")
    if is_kind(move, BEHAVIOUR, "Start"):
        robot = move.eContainer()
        at = child(robot, "home") if robot is not None else None
    found = sketch_of(models).program_ground.positions.get(at) if at is not None else None
    return found[:2] if found is not None else None


def _narrow(
    start: tuple[float, float], corner: tuple[float, float], end: tuple[float, float], radius: float
) -> str:
    """Return why a curve of a radius does not fit into a corner, in words; empty where it does."""
    one, two = (corner[0] - start[0], corner[1] - start[1]), (end[0] - corner[0], end[1] - corner[1])
    shorter = min(dist(start, corner), dist(corner, end))
    across, along = one[0] * two[1] - one[1] * two[0], one[0] * two[0] + one[1] * two[1]
    turn = abs(atan2(across, along))
    if shorter <= EXACT or (turn < pi - EXACT and 2.0 * radius * tan(turn / 2.0) <= shorter + EXACT):
        return ""
    return f"a turn of {degrees(turn):.0f}° is too narrow between legs of {shorter:.2f} m"


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
        at_least_zero("turningRadius", "maxSlope", "wadingDepth", "groundClearance"),
        "correct the figure, or leave it out",
    ),
    Constraint(
        "ROV004",
        "A rover climbs no walls",
        ROVER,
        Range(("maxSlope",), high=90.0, without_high=True),
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
        every(at_least_zero(*(feature for feature, _, _ in LIMITS)), Range(("slope",), high=90.0)),
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
    Constraint(
        "ROV011",
        "A rover passes only corners without a stop that its narrowest curve fits into",
        (BEHAVIOUR, "Robot"),
        _overruns_corners,
        'leave fluid="true" out, or make both legs at least 2 · turningRadius · tan(turn / 2) long',
        Severity.WARNING,
    ),
)
