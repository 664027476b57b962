"""Where a robot flies in an emergency: from the end of each move to an emergency area."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.behaviour.program import BEHAVIOUR, Move
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.escaping import Call
from mmrs_core.mavlink.context import RobotContext
from mmrs_core.mavlink.movements import MULTICOPTER, place_of
from mmrs_core.mavlink.safety import areas_of, escape_from
from mmrs_core.scene import Point, Position

AT_HOME = ((BEHAVIOUR, "Start"), (BEHAVIOUR, "Recharge"))
"""Moves after which a robot is at home."""


def escapes_of(
    context: RobotContext, input: TargetInput, points: tuple[Point, ...], clearance: float
) -> Iterator[tuple[str, Call]]:
    """Yield, by move, where to go from where that move ends; nothing for moves from which no way is safe."""
    if not points:
        return
    areas = areas_of(context.robot, input)
    for index, move in enumerate(context.robot.moves):
        position = _end_of(index, move, context)
        place = escape_from(position, points, areas, clearance) if position is not None else None
        if place is not None:
            yield move.id, place_of(place, context)


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
