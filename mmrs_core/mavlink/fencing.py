"""The fence that a vehicle guards by itself: forbidden areas, enlarged by what the robot must keep.

Planned legs lead past the enlarged areas by millimetres, and vehicles stray from their legs. So
that the fence does not stop a vehicle that does what it should, it stays `STRAY` metres away from
every leg, and is as large as that allows: at most the clearance, at least the area as drawn.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import inf

from shapely import LineString, MultiLineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.behaviour.walk import Graph, successors
from mmrs_core.scene import Area, AreaUse, Ring
from mmrs_core.scene import Point as Vertex

STRAY = 0.5
"""Metres that a vehicle may stray from its legs without breaking its fence."""

BEVEL = 1.04
"""How much farther than the rest a fence's corners may be: they are cut off, not round.

Vehicles keep few corners (an ArduCopter less than a hundred in all), so a round one has two.
"""

PARTS = tuple(part / 20.0 for part in range(18, 0, -1))


def fence_of(robot: RobotProgram, areas: Iterable[Area], clearance: float) -> tuple[Ring, ...]:
    """Return the rings that a robot must not enter at any height.

    Areas with an upper or lower side are left out: fences know no heights, and a route may lead
    over or under them.

    Args:
        robot: whose legs are left free.
        areas: that concern it.
        clearance: metres that it keeps; the safety distance of each area comes on top.
    """
    legs = legs_of(robot)
    return tuple(_enlarged(area, area.safety_distance + clearance, legs) for area in _fenced(areas))


def fence_faults(robot: RobotProgram, areas: Iterable[Area]) -> Iterator[str]:
    """Yield what of a robot's program lies inside its fence, however tight that is drawn."""
    legs, home = legs_of(robot), robot.home
    for area in _fenced(areas):
        drawn = Polygon(area.shell)
        if home is not None and drawn.intersects(Point(home[0], home[1])):
            yield f"robot '{robot.id}': its home is inside the fence around '{area.name}'"
        elif drawn.intersects(legs):
            yield f"robot '{robot.id}': its way leads through the fence around '{area.name}'"


def legs_of(robot: RobotProgram) -> BaseGeometry:
    """Return the straight legs that a robot may travel, seen from above."""
    places = _places(robot)
    graph = successors(robot)
    legs = [
        LineString([places[move], places[after]]) for move in places for after in _next(move, places, graph)
    ]
    alone = Point(robot.home[0], robot.home[1]) if robot.home is not None else Point()
    return MultiLineString(legs) if legs else alone


def _places(robot: RobotProgram) -> dict[int, Vertex]:
    """Return where moves with a target end, and where the robot starts from."""
    places = {
        index: (move.target.position[0], move.target.position[1])
        for index, move in enumerate(robot.moves)
        if move.target is not None and move.target.position is not None
    }
    if robot.home is not None:
        places.setdefault(robot.start, (robot.home[0], robot.home[1]))
    return places


def _next(move: int, places: dict[int, Vertex], graph: Graph) -> list[int]:
    """Return the next moves with a place, past all that have none."""
    found, seen, waiting = [], {move}, list(graph[move])
    while waiting:
        each = waiting.pop()
        if each in seen:
            continue
        seen.add(each)
        if each in places:
            found.append(each)
        else:
            waiting.extend(graph[each])
    return found


def _fenced(areas: Iterable[Area]) -> list[Area]:
    return [
        area for area in areas if area.use is not AreaUse.EMERGENCY and area.low == -inf and area.high == inf
    ]


def _enlarged(area: Area, clearance: float, legs: BaseGeometry) -> Ring:
    drawn = Polygon(area.shell)
    for part in PARTS if clearance > 0.0 and drawn.is_valid else ():
        grown = drawn.buffer(part * clearance, join_style="mitre", mitre_limit=BEVEL)
        if isinstance(grown, Polygon) and (legs.is_empty or Polygon(grown.exterior).distance(legs) >= STRAY):
            return tuple((float(x), float(y)) for x, y in grown.exterior.coords[:-1])
    return area.shell
