"""Finds the moves of a behaviour that carry out the legs of a planned picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import dist

from mmrs_core.behaviour.program import Move, Program, RobotProgram
from mmrs_core.cli.preview.picture import Leg, Picture, RobotPicture

_TRAVEL = frozenset({"launch", "transit", "recover"})
_ASIDE = frozenset({"", "wait", "recharge", "choice", "notify"})
_SAME_PLACE = 0.05
"""Metres between a planned point and the target made of it, which went through coordinates."""


def with_moves(picture: Picture, program: Program) -> Picture:
    """Return the picture with each leg naming its moves, where they are found.

    Args:
        picture: of the plan that the program was made from.
        program: its moves are in the order of the plan's legs.
    """
    programs = {robot.id: robot for robot in program.robots}
    robots = tuple(
        _named(robot, programs[robot.name]) if robot.name in programs else robot for robot in picture.robots
    )
    return replace(picture, robots=robots)


def _named(picture: RobotPicture, program: RobotProgram) -> RobotPicture:
    ends = (program.start, program.stop)
    moves = [move for i, move in enumerate(program.moves) if i not in ends and move.rule not in _ASIDE]
    legs: list[Leg] = []
    for leg in picture.legs:
        first = next((i for i, move in enumerate(moves) if _fits(move, leg)), len(moves))
        own = list(_of_leg(leg, moves[first:]))
        if own:
            del moves[: first + len(own)]
        legs.append(replace(leg, moves=_words(own)))
    return replace(picture, legs=tuple(legs))


def _of_leg(leg: Leg, moves: list[Move]) -> Iterator[Move]:
    arrived = False
    for move in moves:
        position = move.target.position if move.target is not None else None
        if not _fits(move, leg) or (arrived and position is not None):
            return
        yield move
        arrived = arrived or (position is not None and dist(position, leg.points[-1]) < _SAME_PLACE)


def _fits(move: Move, leg: Leg) -> bool:
    kind = move.rule if move.rule in _TRAVEL else "work"
    return kind == leg.kind and move.task == leg.task


def _words(moves: list[Move]) -> str:
    if not moves:
        return ""
    first, last = moves[0].id, moves[-1].id
    return f"move {first}" if first == last else f"moves {first} to {last}"
