"""Where every robot may be: the paths of all its moves, whatever its Choices decide.

A forward pass over the moves of each robot. What is propagated is the set of places where the robot
may be when a move begins; a place is a ball, because an object may be found anywhere within its
tolerance of where it is expected. A move of unknown path leaves a gap, and so do the
moves after it until one leads to a known target.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from mmrs_core.analysis.figures import move_kind_of
from mmrs_core.analysis.verdicts import UnknownMove, once
from mmrs_core.behaviour.program import Move, RobotProgram
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.rules import MoveKind
from mmrs_core.scene import Position

MOST_PLACES = 16
"""With more different places at one move, the robot's position counts as unknown."""


@dataclass(frozen=True, slots=True)
class Ball:
    """Somewhere within `radius` metres of `centre`."""

    centre: Position
    radius: float = 0.0


Whereabouts: TypeAlias = "Ball | None"
"""Where a robot may be; None: unknown."""


@dataclass(frozen=True, slots=True)
class MovePath:
    """One possible path of a move.

    Attributes:
        move: index in the robot.
        points: the nominal path, at least one point.
        radius: how far, in metres, the robot may be from that path.
    """

    move: int
    points: tuple[Position, ...]
    radius: float = 0.0


@dataclass(slots=True)
class Motion:
    """All legs of one robot, in the order of a walk over its moves, and the gaps between them."""

    paths: list[MovePath] = field(default_factory=list)
    gaps: list[UnknownMove] = field(default_factory=list)


def motions(input: CheckInput) -> Mapping[str, Motion]:
    """Return the motion of every robot by its identifier; found once for all checks."""
    return once(input, _motions)


def _motions(input: CheckInput) -> Mapping[str, Motion]:
    return {robot.id: motion_of(input, robot) for robot in input.program.robots}


def motion_of(input: CheckInput, robot: RobotProgram) -> Motion:
    """Return the motion of one robot; linear in its moves times the places that each may begin at."""
    motion = Motion()
    seen: dict[int, set[Whereabouts]] = {}
    begin = Ball(robot.home) if robot.home is not None else None
    pending: deque[tuple[int, Whereabouts]] = deque([(robot.start, begin)])
    while pending:
        index, place = pending.popleft()
        places = seen.setdefault(index, set())
        if place in places:
            continue
        if len(places) >= MOST_PLACES:
            place = None
            if None in places:
                continue
        places.add(place)
        after = _pass(input, robot, index, place, motion)
        transition = robot.transitions.get(index)
        pending.extend((successor, after) for successor in (transition.next_moves if transition else ()))
    return motion


def _pass(
    input: CheckInput, robot: RobotProgram, index: int, place: Whereabouts, motion: Motion
) -> Whereabouts:
    move = robot.moves[index]
    kind = move_kind_of(input, move)
    if kind is None:
        motion.gaps.append(UnknownMove(index, f"no plug-in provides the move kind '{move.kind}'"))
        return None
    reason = _unknown_target(move)
    if reason is None and place is None:
        reason = "its start is unknown"
    if reason is not None or place is None:
        motion.gaps.append(UnknownMove(index, reason or ""))
        return _known_end(kind, move, robot.home)
    path = kind.path(move, place.centre, robot.home)
    if path is None:
        motion.gaps.append(UnknownMove(index, "its path is unknown"))
        return None
    spread = move.target.tolerance or 0.0 if move.target else 0.0
    motion.paths.append(MovePath(index, path, place.radius + spread))
    return Ball(path[-1], spread + (0.0 if _forgets_begin(move) else place.radius))


def _unknown_target(move: Move) -> str | None:
    if move.target is None:
        return None
    if move.target.position is None:
        return f"where the object '{move.target.description}' is, is not known"
    if move.target.tolerance is None:
        return f"how far the object '{move.target.description}' may be from its place is not known"
    return None


def _forgets_begin(move: Move) -> bool:
    # At a distance from its target a robot ends on the side that it came from. The map from where it
    # began, and from where the target is, to where it ends brings no two points further apart.
    return move.target is not None and move.distance == 0.0


def _known_end(kind: MoveKind, move: Move, home: Position | None) -> Whereabouts:
    target = move.target
    if target is None or target.position is None or target.tolerance is None or move.distance != 0.0:
        return None
    path = kind.path(move, target.position, home)
    return Ball(path[-1], target.tolerance) if path else None
