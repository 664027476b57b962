"""Where a robot flies in an emergency: from the end of each move to an emergency area."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, dist

import numpy as np
from shapely import Polygon, intersects, linestrings, prepare, unary_union

from mmrs_core.behaviour.program import BEHAVIOUR, Move, RobotProgram
from mmrs_core.behaviour.travel import capability_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import UnreachableError
from mmrs_core.generation.planned_moves import kinematics_of
from mmrs_core.generation.safety import areas_of, clearance_of
from mmrs_core.planning.paths import Space
from mmrs_core.scene import AreaUse, Point, Position
from mmrs_core.scene.timing import Rates
from mmrs_mavlink.plugin.context import VehicleContext, context_of
from mmrs_runtime.timing import LegTiming

AT_HOME = ((BEHAVIOUR, "Start"), (BEHAVIOUR, "Recharge"))
"""Moves after which a robot is at home."""

STEP_METRES = 1.0
"""How far apart the places are from which straight lines are looked at."""

SLACK = 0.1
"""Metres by which a line may be nearer to an area than it must: ways lead along the edge of clearance."""

USUAL_UPRIGHT = 1.0
"""Metres per second at which robots climb and descend whose type says nothing of that."""

STEADY = LegTiming(acceleration=2.0)
"""Metres per second squared; ways with fewer stops are quicker."""

EITHER = 4.0
"""Metres by which one point may be farther than another and still be taken for the nearest."""


@dataclass(frozen=True, slots=True)
class Escape:
    """A path to an emergency area.

    Attributes:
        move: where it begins: at the end of that one.
        begin: that position; places: its corners, the last one above where the robot lands.
    """

    move: str
    begin: Position
    places: tuple[Position, ...]

    @property
    def legs(self) -> tuple[tuple[Point, Point], ...]:
        """Return its legs as seen from above."""
        flat = [place[:2] for place in (self.begin, *self.places)]
        return tuple(pairwise(flat))


def escapes_of(robot: RobotProgram, input: TargetInput, points: Sequence[Point]) -> tuple[Escape, ...]:
    """Return the quickest clear path, if any, from the end of each move to one of some points.

    Paths keep the robot's clearance from all areas, and stay between the lowest and the highest position
    of its moves. The descent at their ends is in a clear column.
    """
    context = context_of(robot, input)
    ends = [
        (move.id, end)
        for index, move in enumerate(robot.moves)
        if (end := _end_of(index, move, context)) is not None
    ]
    if not points or not ends:
        return ()
    low, high = min(end[2] for _, end in ends), max(end[2] for _, end in ends)
    kept_from = [area for area in areas_of(robot, input) if area.use is not AreaUse.EMERGENCY]
    kinematics = kinematics_of(robot, input)
    radius = 0.0 if kinematics is None else kinematics.turning_radius
    clearance = clearance_of(context.type, input.program.position_error) + radius
    space = Space(kept_from, clearance, low, high, rates=_rates(context), turning_radius=radius)
    clear = [
        p for p in points if space.is_clear(((*p, min(low, context.zero)), (*p, max(high, context.zero))))
    ]
    found = ((move, end, _quickest(space, end, clear)) for move, end in ends)
    return tuple(Escape(move, end, places) for move, end, places in found if places)


def _quickest(space: Space, begin: Position, points: Sequence[Point]) -> tuple[Position, ...]:
    """Return the quickest path to one of the points, without its beginning and without the last descent."""
    routes = []
    for point in points:
        try:
            routes.append(space.route(begin, (*point, begin[2])))
        except UnreachableError:
            continue
    if not routes:
        return ()
    quickest = min(routes, key=space.seconds)[1:]
    comes_down = len(quickest) > 1 and quickest[-2][:2] == quickest[-1][:2]
    return quickest[:-1] if comes_down else quickest


def _rates(context: VehicleContext) -> Rates:
    """Return how fast a robot travels, as far as its type says so."""
    capability = capability_of(context.robot, context.type) if context.type is not None else None
    if capability is None:
        return Rates(1.0, 1.0, 1.0)
    cruise = capability.speed[1] or 1.0
    upright = min(cruise, USUAL_UPRIGHT)
    return Rates(cruise, capability.climb_rate or upright, capability.descent_rate or upright, STEADY)


def _end_of(index: int, move: Move, context: VehicleContext) -> Position | None:
    """Return where a move ends, metres; None where it does not say."""
    if move.target is not None:
        return move.target.position
    home, climbs = context.robot.home, context.manoeuvre(move) == "take_off"
    if home is None or not climbs or not _leaves_home(index, context):
        return None
    return (home[0], home[1], home[2] + context.climb(move))


def _leaves_home(index: int, context: VehicleContext) -> bool:
    robot = context.robot
    before = [robot.moves[source] for source, each in robot.transitions.items() if index in each.next_moves]
    return bool(before) and all(kind in AT_HOME for move in before for kind in move.metaclasses[:1])


def straight_lines_are_clear(context: VehicleContext, input: TargetInput, points: Sequence[Point]) -> bool:
    """Return whether a vehicle may fly straight to the nearest point from anywhere on its path.

    That is its failsafe: it knows no areas and, while it climbs and descends, no heights; so all
    areas count, however high. Where two points are about as near, either may be chosen.
    """
    if not points or context.frame.is_local:
        return False
    kept = clearance_of(context.type, input.program.position_error) - SLACK
    shapes = [
        Polygon(area.shell).buffer(area.safety_distance + kept)
        for area in areas_of(context.robot, input)
        if area.use is not AreaUse.EMERGENCY
    ]
    starts = np.array([place for leg in _legs(context) for place in _along(*leg)])
    if not shapes or not len(starts):
        return True
    ends = np.array(points)
    away = np.hypot(*(starts[:, None, :] - ends[None, :, :]).transpose(2, 0, 1))
    near = np.argwhere(away <= away.min(axis=1, keepdims=True) + EITHER)
    lines = linestrings(np.stack([starts[near[:, 0]], ends[near[:, 1]]], axis=1))
    blocked = unary_union(shapes)
    prepare(blocked)
    return not bool(np.any(intersects(blocked, lines)))


def _legs(context: VehicleContext) -> Iterator[tuple[Point, Point]]:
    """Yield where each move may begin, and where it then ends."""
    robot = context.robot
    if robot.home is None:
        return
    seen: set[tuple[int, Point]] = set()
    todo: list[tuple[int, Point]] = [(robot.start, (robot.home[0], robot.home[1]))]
    while todo:
        index, begin = todo.pop()
        if (index, begin) in seen:
            continue
        seen.add((index, begin))
        position = _end_of(index, robot.moves[index], context)
        end = (position[0], position[1]) if position is not None else begin
        yield begin, end
        transition = robot.transitions.get(index)
        todo += [(following, end) for following in transition.next_moves] if transition is not None else []


def _along(begin: Point, end: Point) -> Iterator[Point]:
    steps = max(1, ceil(dist(begin, end) / STEP_METRES))
    for step in range(steps + 1):
        part = step / steps
        yield (begin[0] + part * (end[0] - begin[0]), begin[1] + part * (end[1] - begin[1]))
