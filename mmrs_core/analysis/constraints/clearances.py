"""Homes and tasks, and the areas that robots keep away from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations
from math import dist, floor, inf, log10

import shapely
from shapely.geometry.base import BaseGeometry

from mmrs_core.analysis.constraints.blocked import SEGMENTS, BlockedLine, blocked_line
from mmrs_core.analysis.constraints.capabilities import able_by_type
from mmrs_core.analysis.constraints.findings import BEHAVIOUR, MISSION, called, finding
from mmrs_core.analysis.constraints.sketch import DrawnArea, Sketch, polygon_of, sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity, lengths
from mmrs_core.geometry.polygons import parts
from mmrs_core.grounding.features import child, children, number
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Position

EXACT = 1e-6
"""Metres by which a distance may fall short because numbers are rounded."""

_LEAST = 0.05
"""Square metres under which what cannot be reached is rounding."""


def _home(robot: Element, models: ModelSet) -> Iterator[Finding]:
    sketch = sketch_of(models)
    drawn = next((each for each in sketch.robots if each.element is robot), None)
    if drawn is None or drawn.home is None or drawn.clearance is None:
        return
    for area, distance in sketch.distances(drawn.home):
        needed = area.safety_distance + drawn.clearance
        if distance < needed - EXACT:
            away, required = lengths(distance, needed)
            yield finding(robot, f"its home is {_from(distance, away, area)}; it must keep {required}")


def _from(distance: float, words: str, area: DrawnArea) -> str:
    return f"inside {called(area.element)}" if distance == 0.0 else f"{words} from {called(area.element)}"


def _point(task: Element, models: ModelSet) -> Iterator[Finding]:
    point = child(task, "point")
    away = number(task, "distance") or number(task, "radius")  # the robot does not come to the point
    if point is not None and not away:
        yield from _found(task, unreachable(task, point, "its point", models))


def _beginning(task: Element, models: ModelSet) -> Iterator[Finding]:
    point = child(task, "initialPosition")
    if point is not None:
        yield from _found(task, unreachable(task, point, "its initialPosition", models))


def _found(task: Element, messages: Iterable[str]) -> Iterator[Finding]:
    return (finding(task, message) for message in messages)


def unreachable(task: Element, point: Element, what: str, models: ModelSet) -> Iterator[str]:
    """Yield a message for each area that keeps all capable robots from a point, called `what`."""
    sketch = sketch_of(models)
    position = _at_work(task, sketch.ground.positions.get(point), sketch)
    smallest = smallest_clearance(task, models)
    if position is None or smallest is None:
        return
    for area, distance in sketch.distances(position):
        needed = area.safety_distance + smallest
        if distance < needed - EXACT:
            away, required = lengths(distance, needed)
            yield f"{what} is {_from(distance, away, area)}; every robot that can do it must keep {required}"


def _at_work(task: Element, position: Position | None, sketch: Sketch) -> Position | None:
    """Return a position at the height that the task is done at, if the task has one of its own."""
    altitude, depth = number(task, "altitude"), number(task, "depth")
    up = altitude if depth is None else sketch.ground.frame.surface - depth
    return position if position is None or up is None else (position[0], position[1], up)


def smallest_clearance(task: Element, models: ModelSet) -> float | None:
    """Return the clearance of the smallest robot that can do a task, metres; None if one is not known."""
    clearances = [robots[0].clearance for robots in able_by_type(task, models)]
    known = [each for each in clearances if each is not None]
    return min(known) if known and len(known) == len(clearances) else None


def positions_of(task: Element, feature: str, sketch: Sketch) -> list[Position]:
    """Return where the points of a feature lie, those that can be placed, at the height of the task."""
    found = (sketch.ground.positions.get(each) for each in children(task, feature))
    return [placed for each in found if (placed := _at_work(task, each, sketch)) is not None]


def _line_inside(task: Element, models: ModelSet) -> Iterator[Finding]:
    line = _line_of(task, models)
    if line is not None and line.blocked and not line.left:
        names = ", ".join(dict.fromkeys(name for _, name in line.blocked))
        yield finding(task, f"every part of its line is too near to {names} for every robot")


def _line_through(task: Element, models: ModelSet) -> Iterator[Finding]:
    line = _line_of(task, models)
    if line is not None and line.left:
        for (begin, end), names in line.blocked:
            yield finding(
                task,
                f"{end - begin:.1f} of its {line.length:.1f} m are too near to {names} for every robot, "
                f"from {begin:.1f} m along its line",
            )


def _line_of(task: Element, models: ModelSet) -> BlockedLine | None:
    sketch = sketch_of(models)
    points, smallest = positions_of(task, "points", sketch), smallest_clearance(task, models)
    return blocked_line(sketch, points, smallest) if points and smallest is not None else None


def _covered(task: Element, models: ModelSet) -> Iterator[Finding]:
    return _found(task, covered(task, models))


def covered(task: Element, models: ModelSet) -> Iterator[str]:
    """Yield a message if no capable robot may reach any of a task's shell."""
    area = _area_of(task, models)
    if area is not None and area.closed and not area.left:
        yield "all of its area is too near to what every robot must keep away from"


def _partly_covered(task: Element, models: ModelSet) -> Iterator[Finding]:
    return _found(task, partly_covered(task, models))


def partly_covered(task: Element, models: ModelSet) -> Iterator[str]:
    """Yield a message for each piece of a task's shell that no robot may reach, if others are left."""
    area = _area_of(task, models)
    if area is None or not area.left:
        return
    for piece in area.closed:
        spot = piece.representative_point()
        yield (
            f"about {_roughly(piece.area)} m² of its area, at ({spot.x:.1f}, {spot.y:.1f}), are too near to"
            f" {area.names_at(spot)} for every robot"
        )


def _roughly(area: float) -> str:
    """Return an area to three digits: planning grows what is kept away from a little further."""
    return f"{round(area, 2 - floor(log10(area))):g}"


@dataclass(frozen=True, slots=True)
class _Area:
    """What no robot that can do a task may reach of its area, if any is left, and what is kept away from."""

    closed: tuple[shapely.Polygon, ...]
    left: bool
    grown: list[tuple[str, BaseGeometry]]

    def names_at(self, spot: shapely.Point) -> str:
        """Return what is too near to a place."""
        return ", ".join(name for name, shape in self.grown if shape.distance(spot) < EXACT)


def _area_of(task: Element, models: ModelSet) -> _Area | None:
    sketch = sketch_of(models)
    ring, smallest = sketch.ring(task, "shell"), smallest_clearance(task, models)
    shape = polygon_of(ring) if ring is not None else None
    if shape is None or smallest is None:
        return None
    grown = list(_grown(sketch.kept_from, smallest, _height(task, sketch)))
    holes = (polygon_of(hole) for each in children(task, "holes") if (hole := sketch.ring(each, "points")))
    asked = shape - shapely.union_all([hole for hole in holes if hole is not None])
    kept = shapely.union_all([shape for _, shape in grown])
    return _Area(parts(asked & kept, smallest=_LEAST), (asked - kept).area > _LEAST, grown)


def _height(task: Element, sketch: Sketch) -> float | None:
    """Return the one height that an area task is done at; None where it has none or several."""
    ups = {position[2] for position in positions_of(task, "shell", sketch)}
    return ups.pop() if len(ups) == 1 else None


def _grown(
    areas: Iterable[DrawnArea], clearance: float, up: float | None
) -> Iterator[tuple[str, BaseGeometry]]:
    """Yield areas, called and grown by all that is kept from them, as far as they matter at a height."""
    for area in areas:
        endless, keep = area.low == -inf and area.high == inf, area.safety_distance + clearance
        if endless or (up is not None and area.off(up) < keep):
            yield called(area.element), shapely.buffer(area.shape, keep, quad_segs=SEGMENTS)


def _astray(task: Element, models: ModelSet) -> Iterator[Finding]:
    sketch = sketch_of(models)
    begin = child(task, "initialPosition")
    start = sketch.ground.positions.get(begin) if begin is not None else None
    points = [*positions_of(task, "shell", sketch), *positions_of(task, "points", sketch)]
    if start is None or not points:
        return
    nearest = min(dist(start[:2], point[:2]) for point in points)
    extent = max(dist(points[0][:2], point[:2]) for point in points)
    if nearest > max(1000.0, 2.0 * extent):
        yield finding(task, f"its initialPosition is {nearest / 1000:.1f} km from the rest of the task")


def _crowded(team: Element, models: ModelSet) -> Iterator[Finding]:
    sketch = sketch_of(models)
    for one, other in combinations(sketch.robots, 2):
        if one.home is None or other.home is None or one.clearance is None or other.clearance is None:
            continue
        apart, needed = dist(one.home, other.home), one.clearance + other.clearance
        if apart < needed - EXACT:
            between, required = lengths(apart, needed)
            yield finding(
                other.element,
                f"its home is {between} from that of {called(one.element)}, "
                f"but the two need {required} for their sizes",
            )


def _separated(mission: Element, models: ModelSet) -> Iterator[Finding]:
    separation = number(mission, "minimumSeparation")
    if separation is None:
        return
    for one, other in combinations(sketch_of(models).robots, 2):
        apart = dist(one.home, other.home) if one.home is not None and other.home is not None else inf
        if apart < separation - EXACT:
            yield finding(
                other.element,
                f"its home is {lengths(apart, separation)[0]} from that of {called(one.element)}, "
                f"less than the minimumSeparation of {separation:g} m",
            )


def _bodies(owner: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield a breach if the two largest robots may overlap though they keep the minimum separation."""
    separation = number(owner, "minimumSeparation")
    sketch = sketch_of(models)
    sizes = sorted(
        (half, called(robot.element)) for robot in sketch.robots if (half := robot.half) is not None
    )
    if separation is None or separation < 0.0 or len(sizes) < 2:
        return
    (second, one), (first, other) = sizes[-2:]
    if separation < first + second - EXACT:
        yield finding(
            owner,
            f"minimumSeparation is {separation:g} m, but {one} and {other} need {first + second:.2f} m"
            " for their sizes",
        )


_MOVE_HOME = "move the home away, or make the area smaller"
_MOVE_TASK = "move the task away, or make the area or its safetyDistance smaller"

CONSTRAINTS = (
    Constraint("MML080", "Every robot keeps its clearance at home.", (MISSION, "Robot"), _home, _MOVE_HOME),
    Constraint(
        "MML081",
        "The point of a task is one that some robot can be at.",
        (MISSION, "PointTask"),
        _point,
        _MOVE_TASK,
    ),
    Constraint(
        "MML082", "Some part of a line can be followed.", (MISSION, "LineTask"), _line_inside, _MOVE_TASK
    ),
    Constraint(
        "MML083",
        "All of a line can be followed.",
        (MISSION, "LineTask"),
        _line_through,
        "lead the line around the area, or above it",
        Severity.WARNING,
    ),
    Constraint(
        "MML084",
        "Some part of an area to cover can be reached.",
        (MISSION, "SweepTask"),
        _covered,
        _MOVE_TASK,
    ),
    Constraint(
        "MML085",
        "The initial position of a line task is one that some robot can be at.",
        (MISSION, "LineTask"),
        _beginning,
        "move the initialPosition out of the area",
    ),
    Constraint(
        "MML086",
        "The initial position of an area task is one that some robot can be at.",
        (MISSION, "PolygonTask"),
        _beginning,
        "move the initialPosition out of the area",
    ),
    Constraint(
        "MML087",
        "The initial position of a line task is near the line.",
        (MISSION, "LineTask"),
        _astray,
        "check latitude and longitude of the initialPosition",
        Severity.WARNING,
    ),
    Constraint(
        "MML088",
        "The initial position of an area task is near the area.",
        (MISSION, "PolygonTask"),
        _astray,
        "check latitude and longitude of the initialPosition",
        Severity.WARNING,
    ),
    Constraint(
        "MML089",
        "Robots have room beside each other at home.",
        (MISSION, "Team"),
        _crowded,
        "move the homes apart; if they start one after the other, this may be as it should",
        Severity.WARNING,
    ),
    Constraint(
        "MML090",
        "Homes keep the mission's minimum separation.",
        (MISSION, "Mission"),
        _separated,
        "move the homes apart, or lower minimumSeparation",
    ),
    Constraint(
        "MML091",
        "All of an area to cover can be reached.",
        (MISSION, "SweepTask"),
        _partly_covered,
        "cut a hole there if it need not be done",
        Severity.NOTE,
    ),
    *(
        Constraint(
            code,
            "Robots that keep the minimum separation do not overlap.",
            metaclass,
            _bodies,
            "raise minimumSeparation; it is between the middles of robots",
            Severity.WARNING,
        )
        for code, metaclass in (("MML092", (MISSION, "Mission")), ("BL054", (BEHAVIOUR, "Behaviour")))
    ),
)
