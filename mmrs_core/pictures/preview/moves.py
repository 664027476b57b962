"""Finds the moves of a behaviour that carry out the legs of a planned picture."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import zip_longest
from math import dist

from mmrs_core.behaviour.program import BEHAVIOUR, Move, Program, RobotProgram
from mmrs_core.pictures.preview.picture import Leg, Picture, RobotPicture
from mmrs_core.scene import Position

_TRAVEL = frozenset({"launch", "transit", "recover"})
_ASIDE = frozenset({"", "wait", "recharge", "choice", "notify"})
_HOLD = (BEHAVIOUR, "HoldPosition")
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
    groups = list(_groups(picture.legs))
    for group, following in zip_longest(groups, groups[1:]):
        first = next((i for i, move in enumerate(moves) if _fits(move, group[0])), len(moves))
        more = following is not None and _serve_the_same(group[0], following[0])
        there, still = _split(group[0], moves[first:], more=more)
        if there or still:
            del moves[: first + len(there) + len(still)]
        own = _shared(group, there, still)
        legs += [replace(leg, moves=_words(part)) for leg, part in zip(group, own, strict=True)]
    return replace(picture, legs=tuple(legs))


def _groups(legs: Iterable[Leg]) -> Iterator[list[Leg]]:
    """Yield legs one by one, but together those that stay, for the same task, where one before ended."""
    group: list[Leg] = []
    for leg in legs:
        follows = group and leg.stays and _serve_the_same(leg, group[0])
        if follows and dist(leg.points[0], group[0].points[-1]) < _SAME_PLACE:
            group.append(leg)
            continue
        if group:
            yield group
        group = [leg]
    if group:
        yield group


def _serve_the_same(leg: Leg, other: Leg) -> bool:
    return (leg.kind, leg.task) == (other.kind, other.task)


def _split(leg: Leg, moves: list[Move], *, more: bool) -> tuple[list[Move], list[Move]]:
    """Return the moves that lead along a leg, and those after them that stay where it ends.

    Args:
        leg: the first of its group.
        moves: from its first one on.
        more: whether the next group serves the same, so that moves beyond the leg's end are its.
    """
    there: list[Move] = []
    ahead = [] if leg.stays else list(leg.points[1:])
    still: list[Move] = []
    for move in moves:
        position = move.target.position if move.target is not None else None
        if not _fits(move, leg) or (position is not None and not ahead and more):
            break
        if position is not None:
            ahead = ahead[_reached(ahead, position) :]
        if position is None and not ahead:
            still.append(move)
        else:
            there += [*still, move]
            still = []
    return there, still


def _reached(ahead: list[Position], position: Position) -> int:
    """Return how many of the places ahead are behind once a robot is at a position."""
    near = (i + 1 for i, place in enumerate(ahead) if dist(place, position) < _SAME_PLACE)
    return next(near, 0)


def _shared(group: list[Leg], there: list[Move], still: list[Move]) -> list[list[Move]]:
    """Return the moves of each leg of a group: each stay ends with its hold.

    Where the holds do not tell whose they are, every leg gets all that stay.
    """
    if len(group) == 1:
        return [[*there, *still]]
    stays = _until_holds(still)
    if len(stays) == len(group):
        return [[*there, *stays[0]], *stays[1:]]
    if not group[0].stays and len(stays) == len(group) - 1:
        return [there, *stays]
    return [[*there, *still], *([still] * (len(group) - 1))]


def _until_holds(moves: list[Move]) -> list[list[Move]]:
    parts: list[list[Move]] = [[]]
    for move in moves:
        parts[-1].append(move)
        if move.is_a(_HOLD):
            parts.append([])
    return parts if parts[-1] else parts[:-1]


def _fits(move: Move, leg: Leg) -> bool:
    kind = move.rule if move.rule in _TRAVEL else "work"
    return kind == leg.kind and move.task == leg.task


def _words(moves: list[Move]) -> str:
    if not moves:
        return ""
    first, last = moves[0].id, moves[-1].id
    return f"move {first}" if first == last else f"moves {first} to {last}"
