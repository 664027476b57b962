"""Where a robot flies in an emergency: from the end of each move to an emergency area."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, dist

import numpy as np
from shapely import Polygon, intersects, linestrings, prepare, unary_union

from mmrs_core.behaviour.program import BEHAVIOUR, Move
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.escaping import Call
from mmrs_core.mavlink.context import RobotContext
from mmrs_core.mavlink.movements import MULTICOPTER, place_of
from mmrs_core.mavlink.safety import areas_of, escape_from
from mmrs_core.scene import AreaUse, Point, Position

AT_HOME = ((BEHAVIOUR, "Start"), (BEHAVIOUR, "Recharge"))
"""Moves after which a robot is at home."""

STEP_METRES = 1.0
"""How far apart the places are from which straight lines are looked at."""

SLACK = 0.1
"""Metres by which a line may be nearer to an area than it must: ways lead along the edge of clearance."""

EITHER = 4.0
"""Metres by which one point may be farther than another and still be taken for the nearest."""


def escapes_of(
    context: RobotContext, input: TargetInput, points: tuple[Point, ...], clearance: float
) -> Iterator[tuple[str, Call]]:
    """Yield, by move, where to go from where that move ends; nothing for moves from which no way is safe."""
    for move, _, place in _escapes(context, input, points, clearance):
        yield move.id, place_of(place, context)


def escape_legs(
    context: RobotContext, input: TargetInput, points: tuple[Point, ...], clearance: float
) -> tuple[tuple[Point, Point], ...]:
    """Return the legs from where moves end to emergency areas, seen from above."""
    legs = _escapes(context, input, points, clearance)
    return tuple((begin[:2], end[:2]) for _, begin, end in legs)


def _escapes(
    context: RobotContext, input: TargetInput, points: tuple[Point, ...], clearance: float
) -> Iterator[tuple[Move, Position, Position]]:
    """Yield moves, where they end, and where to go from there, as far as a way is safe."""
    if not points:
        return
    areas = areas_of(context.robot, input)
    for index, move in enumerate(context.robot.moves):
        position = _end_of(index, move, context)
        place = escape_from(position, points, areas, clearance) if position is not None else None
        if position is not None and place is not None:
            yield move, position, place


def _end_of(index: int, move: Move, context: RobotContext) -> Position | None:
    """Return where a move ends, metres; None where it does not say."""
    if move.target is not None:
        return move.target.position
    home, altitude = context.robot.home, move.attributes.get("altitude")
    climbs = move.metaclasses[0] == (MULTICOPTER, "TakeOff") and isinstance(altitude, int | float)
    if home is None or not climbs or not _leaves_home(index, context):
        return None
    assert isinstance(altitude, int | float)
    return (home[0], home[1], home[2] + altitude)


def _leaves_home(index: int, context: RobotContext) -> bool:
    robot = context.robot
    before = [robot.moves[source] for source, each in robot.transitions.items() if index in each.ways]
    return bool(before) and all(kind in AT_HOME for move in before for kind in move.metaclasses[:1])


def straight_lines_are_clear(
    context: RobotContext, input: TargetInput, points: tuple[Point, ...], clearance: float
) -> bool:
    """Return whether a vehicle may fly straight to the nearest point from anywhere on its way.

    That is what it does by itself: it knows no areas and, on its way up and down, no heights; so all
    areas count, however high. Where two points are about as near, either may be chosen.
    """
    if not points or context.frame.is_local:
        return False
    kept = clearance - SLACK
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


def _legs(context: RobotContext) -> Iterator[tuple[Point, Point]]:
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
        todo += [(following, end) for following in transition.ways] if transition is not None else []


def _along(begin: Point, end: Point) -> Iterator[Point]:
    steps = max(1, ceil(dist(begin, end) / STEP_METRES))
    for step in range(steps + 1):
        part = step / steps
        yield (begin[0] + part * (end[0] - begin[0]), begin[1] + part * (end[1] - begin[1]))
