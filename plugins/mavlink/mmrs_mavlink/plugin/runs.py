"""Finds moves that a vehicle can fly in one go, as an uploaded mission."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import acos, degrees, hypot

from mmrs_core.behaviour.program import Move, RobotProgram, Transition
from mmrs_core.scene import Position
from mmrs_mavlink.plugin.context import VehicleContext

SHORTEST = 3
"""Runs of fewer moves are stepped: uploading them gains nothing."""

STRAIGHT_DEGREES = 10.0
CORNER_SECONDS = 1.0
"""Hold at corners. Measured on ArduCopter 4.7-dev in simulation, at cruise speed: a waypoint without a
hold was passed at 1.65 to 1.69 m, one with a hold of a second at 0.02 to 0.07 m. No test repeats this:
our own simulated vehicle cuts corners within a radius that it was given for that."""


@dataclass(frozen=True, slots=True)
class MoveRun:
    """A run: indices of its moves, and seconds to hold at the end of each."""

    moves: tuple[int, ...]
    holds: tuple[float, ...]


def runs_of(context: VehicleContext, turning_radius: float = 0.0) -> tuple[MoveRun, ...]:
    """Return the robot's runs, in the order of their first moves; none for a local behaviour.

    A run is a longest chain of at least three straight GoTo moves with fluid, unconditional
    transitions without waits, and without actions inside. A vehicle that needs room to turn holds at its end
    alone: where it stood in a corner, it could not turn to the next leg.

    Args:
        context: of the robot.
        turning_radius: of its narrowest curve, metres.
    """
    if context.frame.is_local:
        return ()
    robot = context.robot
    chained = {source: t.to for source, t in robot.transitions.items() if _chains(context, source, t)}
    entered = set(chained.values())
    runs = []
    for first in range(len(robot.moves)):
        if first in chained and first not in entered:
            moves = _chain(first, chained)
            if len(moves) >= SHORTEST:
                passed = (0.0,) * (len(moves) - 1)
                holds = (*passed, CORNER_SECONDS) if turning_radius > 0.0 else _holds(robot, moves)
                runs.append(MoveRun(moves, holds))
    return tuple(runs)


def _chain(first: int, chained: Mapping[int, int]) -> tuple[int, ...]:
    moves = [first]
    while moves[-1] in chained and chained[moves[-1]] not in moves:
        moves.append(chained[moves[-1]])
    return tuple(moves)


def _chains(context: VehicleContext, source: int, transition: Transition) -> bool:
    if not transition.fluid or transition.waits or transition.condition is not None:
        return False
    robot = context.robot
    before, after = robot.moves[source], robot.moves[transition.to]
    alone = sum(transition.to in other.next_moves for other in robot.transitions.values()) == 1
    plain = _plain(before, context) and _plain(after, context)
    return alone and plain and not before.after and not after.before


def _plain(move: Move, context: VehicleContext) -> bool:
    straight = context.manoeuvre(move) == "go_to" and _is_straight(move, context)
    coordinate = move.target is not None and move.target.position is not None
    return straight and coordinate and _is_coordinate(move) and move.distance == 0.0 and move.heading is None


def _is_straight(move: Move, context: VehicleContext) -> bool:
    """Return whether a move goes straight even to a target at another height."""
    if move.target is None or move.target.position is None:
        return False
    east, north, up = move.target.position
    path = context.moves[move.metaclasses[0]].path(move, (east - 10.0, north - 10.0, up - 10.0), None)
    return path is not None and len(path) == 2


def _is_coordinate(move: Move) -> bool:
    return move.target is not None and move.target.description is None


def _holds(robot: RobotProgram, moves: tuple[int, ...]) -> tuple[float, ...]:
    places = [target.position for move in moves if (target := robot.moves[move].target)]
    holds = [CORNER_SECONDS] * len(places)
    for index in range(1, len(places) - 1):
        before, here, after = places[index - 1 : index + 2]
        assert before is not None
        assert here is not None
        assert after is not None
        if _turn(before, here, after) <= STRAIGHT_DEGREES:
            holds[index] = 0.0
    return tuple(holds)


def _turn(before: Position, here: Position, after: Position) -> float:
    a = tuple(q - p for p, q in zip(before, here, strict=True))
    b = tuple(q - p for p, q in zip(here, after, strict=True))
    lengths = hypot(*a) * hypot(*b)
    if lengths == 0.0:
        return 180.0
    cosine = sum(p * q for p, q in zip(a, b, strict=True)) / lengths
    return degrees(acos(max(-1.0, min(1.0, cosine))))
