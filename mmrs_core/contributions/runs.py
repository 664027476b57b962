"""Runs: moves that follow each other without a stop, which autopilots are given as one mission."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from mmrs_core.contributions.rules import MoveKind, most_specific

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Move, RobotProgram, Transition
    from mmrs_core.scene import Name

SHORTEST = 3
"""Runs of fewer moves are commanded one by one: uploading them gains nothing."""

STRAIGHT_DEGREES = 10.0
"""Up to where a turn is none, so that a vehicle that keeps to its legs passes it without a stop."""


def runs_of(robot: RobotProgram, move_kinds: Mapping[Name, MoveKind]) -> tuple[tuple[int, ...], ...]:
    """Return the runs of a robot as indices of moves, in the order of their first moves.

    A run is a longest chain of at least three straight GoTo moves with fluid, unconditional
    transitions without waits, and without actions inside. At the end of its first move the vehicle stops.
    """
    chained = {
        source: transition.to
        for source, transition in robot.transitions.items()
        if _chains(robot, source, transition, move_kinds)
    }
    entered = set(chained.values())
    chains = (_chain(each, chained) for each in chained if each not in entered)
    return tuple(sorted(each for each in chains if len(each) >= SHORTEST))


def _chain(first: int, chained: Mapping[int, int]) -> tuple[int, ...]:
    moves = [first]
    while moves[-1] in chained and chained[moves[-1]] not in moves:
        moves.append(chained[moves[-1]])
    return tuple(moves)


def _chains(
    robot: RobotProgram, source: int, transition: Transition, move_kinds: Mapping[Name, MoveKind]
) -> bool:
    if not transition.fluid or transition.waits or transition.condition is not None:
        return False
    before, after = robot.moves[source], robot.moves[transition.to]
    alone = sum(transition.to in other.next_moves for other in robot.transitions.values()) == 1
    plain = _is_plain(before, move_kinds) and _is_plain(after, move_kinds)
    return alone and plain and not before.after and not after.before


def _is_plain(move: Move, move_kinds: Mapping[Name, MoveKind]) -> bool:
    """Return whether a move goes straight to a coordinate, and looks where it goes."""
    name = most_specific(move.metaclasses, move_kinds)
    target = move.target
    if name is None or move_kinds[name].manoeuvre != "go_to" or target is None or target.position is None:
        return False
    east, north, up = target.position
    path = move_kinds[name].path(move, (east - 10.0, north - 10.0, up - 10.0), None)
    plain = target.description is None and move.distance == 0.0 and move.heading is None
    return plain and path is not None and len(path) == 2
