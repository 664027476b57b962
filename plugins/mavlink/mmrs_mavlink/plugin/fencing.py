"""The vehicle's own geofence: forbidden areas, enlarged by the robot's clearance.

Planned legs lead along the edge of that, and vehicles stray from their legs: the wind pushes them, and
their position estimate jumps. So that the fence does not stop a vehicle that follows its plan, it
stays away from every leg by that error, and is as large as that allows: at most the robot's
clearance from the area, at least the area as drawn.

Only being inside breaks a fence. ArduPilot's FENCE_MARGIN moves no fence: nearer than that, it only
warns, and halts pilots who fly manually (``AC_Fence.cpp``, ``check_fence_polygon``). A Rover halts in any
mode, so that it is set to a tenth of a metre there (`vehicles.owner_settings`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, cos, inf, pi, remainder, sin

import numpy as np
from shapely import (
    LineString,
    MultiLineString,
    MultiPoint,
    Point,
    Polygon,
    prepare,
    remove_repeated_points,
    unary_union,
)
from shapely.geometry.base import BaseGeometry

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.behaviour.walk import Graph, successors
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.safety import areas_of, clearance_of
from mmrs_core.scene import Area, AreaUse, Ring
from mmrs_core.scene import Point as Vertex
from mmrs_mavlink.plugin.escapes import Escape

STRAY = 0.5
"""Metres that a vehicle may stray from its legs at least; more where the mission's position error is more.

Gusts of two metres a second carry our simulated copters about 0.4 m from their legs.
"""

BEVEL = 1.0
"""Corners are cut off where a round one would be cut, which leaves two: vehicles keep few corners.

An ArduCopter keeps less than a hundred in all. These two are farther away than the rest of the fence:
by a twelfth where the area's corner is a right angle, more where it is sharper (`reach_of`).
"""

CHORDS = 16
"""Chords to a circle where corners cannot be cut off; the circle is inside them."""

FINE = 0.01
"""Metres to which the largest fence is found."""

ONE = 1e-9
"""Metres within which two vertices are one."""

TOUCHING = 1e-7
"""Metres that rounding may take from a fence."""

Leg = tuple[Vertex, Vertex]


@dataclass(frozen=True, slots=True)
class Fence:
    """An area that a vehicle stays out of.

    Attributes:
        area: its name. ring: its edge, metres.
        kept: metres that it is around the area as drawn, at least.
        wanted: metres that the robot must keep from the area. stray: metres that it may stray.
        reach: how much farther than `kept` its corners are, as a factor.
    """

    area: str
    ring: Ring
    kept: float
    wanted: float
    stray: float
    reach: float

    @property
    def is_tight(self) -> bool:
        """Return whether it is tighter than straying along the edge of what must be kept makes it."""
        return self.kept < max(0.0, (self.wanted - self.stray) / self.reach) - 2.0 * FINE

    def __str__(self) -> str:
        """Return how tight it is, in words."""
        return (
            f"the fence around '{self.area}' is {self.kept:.1f} m from it, although {self.wanted:.1f} m must"
            " be kept: its path leads so near"
        )


def fences_of(robot: RobotProgram, input: TargetInput, escapes: Iterable[Escape]) -> tuple[Fence, ...]:
    """Return what a robot must not enter, its paths to emergency areas left free.

    Args:
        robot: of the input's behaviour.
        input: the behaviour and what belongs to it.
        escapes: its paths to emergency areas.
    """
    error = input.program.position_error
    clearance = clearance_of(input.types.get(robot.type_name), error)
    legs = [leg for escape in escapes for leg in escape.legs]
    return fence_of(robot, areas_of(robot, input), clearance, error, legs)


def fence_of(
    robot: RobotProgram,
    areas: Iterable[Area],
    clearance: float,
    position_error: float,
    escapes: Sequence[Leg] = (),
) -> tuple[Fence, ...]:
    """Return what a robot must not enter at any height.

    Areas with an upper or lower side are left out: fences know no heights, and a route may lead
    over or under them.

    Args:
        robot: whose legs are left free.
        areas: that concern it.
        clearance: metres that it keeps; the safety distance of each area comes on top.
        position_error: of the mission, metres.
        escapes: further legs that are left free, as those to emergency areas.
    """
    legs, stray = legs_of(robot, escapes), max(STRAY, position_error)
    prepare(legs)
    return tuple(_around(area, area.safety_distance + clearance, legs, stray) for area in _fenced(areas))


def fence_faults(robot: RobotProgram, areas: Iterable[Area]) -> Iterator[str]:
    """Yield what of a robot's program lies inside its fence, however tight that is drawn."""
    legs, home = legs_of(robot), robot.home
    for area in _fenced(areas):
        drawn = Polygon(area.shell)
        if home is not None and drawn.intersects(Point(home[0], home[1])):
            yield f"robot '{robot.id}': its home is inside the fence around '{area.name}'"
        elif drawn.intersects(legs):
            yield f"robot '{robot.id}': its path leads through the fence around '{area.name}'"


def legs_of(robot: RobotProgram, more: Sequence[Leg] = ()) -> BaseGeometry:
    """Return the straight legs that a robot may travel, and more of them, seen from above."""
    places = _places(robot)
    graph = successors(robot)
    legs = [
        LineString([places[move], places[after]]) for move in places for after in _next(move, places, graph)
    ]
    legs += [LineString(leg) for leg in more]
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


def reach_of(shell: Ring) -> float:
    """Return how much farther than the rest the corners of a fence around an area are, as a factor.

    >>> round(reach_of(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))), 3)
    1.082
    """
    corners = zip((shell[-1], *shell[:-1]), shell, (*shell[1:], shell[0]), strict=True)
    return max(1.0 / cos(_turn(*corner) / 4.0) for corner in corners)


def _turn(before: Vertex, here: Vertex, after: Vertex) -> float:
    """Return by how much an edge turns at a vertex, radians up to pi."""
    arriving = atan2(here[1] - before[1], here[0] - before[0])
    leaving = atan2(after[1] - here[1], after[0] - here[0])
    return abs(remainder(leaving - arriving, 2.0 * pi))


def _around(area: Area, wanted: float, legs: BaseGeometry, stray: float) -> Fence:
    """Return the largest fence around an area that leaves the legs free."""
    # Vertices that are as good as one would turn by angles that are not there.
    drawn = remove_repeated_points(Polygon(area.shell), ONE)
    assert isinstance(drawn, Polygon)
    reach = reach_of(tuple((x, y) for x, y in drawn.exterior.coords[:-1]))

    def leaves_room(metres: float) -> bool:
        return legs.is_empty or _grown(drawn, metres).distance(legs) >= stray

    if wanted < FINE or not drawn.is_valid or not leaves_room(0.0):
        return Fence(area.name, area.shell, 0.0, wanted, stray, reach)
    kept, most = (wanted, wanted) if leaves_room(wanted) else (0.0, wanted)
    while most - kept > FINE:
        middle = (kept + most) / 2.0
        kept, most = (middle, most) if leaves_room(middle) else (kept, middle)
    edge = _grown(drawn, kept).exterior.coords[:-1]
    return Fence(area.name, tuple((float(x), float(y)) for x, y in edge), kept, wanted, stray, reach)


def _grown(drawn: Polygon, metres: float) -> Polygon:
    """Return an area with `metres` around it; what that closes in belongs to it."""
    if metres <= 0.0:
        return Polygon(drawn.exterior)
    # Along a spike with no width, GEOS divides by zero on its way.
    with np.errstate(divide="ignore", invalid="ignore"):
        grown: BaseGeometry = drawn.buffer(metres, join_style="mitre", mitre_limit=BEVEL)
        if not grown.buffer(TOUCHING).covers(drawn.buffer(metres)):
            # It loses some such spikes.
            grown = unary_union([drawn, *_around_edges(drawn, metres)])
    assert isinstance(grown, Polygon)
    return Polygon(grown.exterior)


def _around_edges(drawn: Polygon, metres: float) -> Iterator[BaseGeometry]:
    """Yield the strip of `metres` around each edge of an area, its ends rounded by chords outside."""
    far = metres / cos(pi / CHORDS)
    turns = [2.0 * pi * chord / CHORDS for chord in range(CHORDS)]
    circle = [(far * cos(turn), far * sin(turn)) for turn in turns]
    for edge in pairwise(drawn.exterior.coords):
        yield MultiPoint([(x + east, y + north) for x, y in edge for east, north in circle]).convex_hull
