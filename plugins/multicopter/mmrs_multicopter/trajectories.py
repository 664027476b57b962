"""Ways between two positions by type of trajectory, and routes put together from them.

Drones fly what the paper (section 4.1.1) calls DIRECT, HORIZONTAL_FIRST and VERTICAL_FIRST. A route
of straight legs becomes as few moves as these types allow.
"""

from __future__ import annotations

from itertools import pairwise
from math import dist, hypot
from typing import TYPE_CHECKING

from mmrs_core.contributions.rules import MoveSpec
from mmrs_core.transformation.kinds import before_target
from mmrs_multicopter.names import GO_TO

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Move
    from mmrs_core.scene import Position

SAME = 1e-6
"""Metres within which two positions are one."""


def travel(route: tuple[Position, ...]) -> tuple[MoveSpec, ...]:
    """Return the moves along straight legs; an upright and a level leg in a row become one move.

    Legs without length are left out. The first position is where the robot is.
    """
    stops = _without_repeats(route)
    moves: list[MoveSpec] = []
    here = 0
    while here < len(stops) - 1:
        trajectory = _corner(stops[here : here + 3])
        here += 2 if trajectory else 1
        moves.append(MoveSpec(GO_TO, {"trajectory": trajectory or "DIRECT"}, target=stops[here]))
    return tuple(moves)


def path(move: Move, here: Position, home: Position | None) -> tuple[Position, ...] | None:
    """Return the positions that a GoTo passes, ended where it is `distance` away from its target.

    None where the target is an object whose place is not known.
    """
    if move.target is None or move.target.position is None:
        return None
    goal = move.target.position
    corner = _corner_of(str(move.attributes.get("trajectory") or "DIRECT"), here, goal)
    legs = (here, goal) if corner in (None, here, goal) else (here, corner, goal)
    return _ended_before(legs, goal, move.distance)


def _without_repeats(route: tuple[Position, ...]) -> tuple[Position, ...]:
    return route[:1] + tuple(b for a, b in pairwise(route) if dist(a, b) > SAME)


def _corner(stops: tuple[Position, ...]) -> str | None:
    if len(stops) < 3:
        return None
    first, second = _direction(stops[0], stops[1]), _direction(stops[1], stops[2])
    if (first, second) == ("upright", "level"):
        return "VERTICAL_FIRST"
    if (first, second) == ("level", "upright"):
        return "HORIZONTAL_FIRST"
    return None


def _direction(start: Position, end: Position) -> str:
    if hypot(end[0] - start[0], end[1] - start[1]) <= SAME:
        return "upright"
    return "level" if abs(end[2] - start[2]) <= SAME else "sloped"


def _corner_of(trajectory: str, here: Position, goal: Position) -> Position | None:
    if trajectory == "VERTICAL_FIRST":
        return (here[0], here[1], goal[2])
    if trajectory == "HORIZONTAL_FIRST":
        return (goal[0], goal[1], here[2])
    return None


def _ended_before(legs: tuple[Position, ...], goal: Position, distance: float) -> tuple[Position, ...]:
    # Along an upright and a level leg in a row the distance to the goal only ever falls, so the
    # first leg that comes near enough is the last one flown.
    if distance <= 0.0:
        return legs
    flown = [legs[0]]
    for start, end in pairwise(legs):
        if dist(end, goal) <= distance:
            return (*flown, _near_enough(start, end, goal, distance))
        flown.append(end)
    return tuple(flown)


def _near_enough(start: Position, end: Position, goal: Position, distance: float) -> Position:
    if dist(start, goal) <= distance:
        return start
    remaining = dist(end, goal)
    # The leg ends at the goal, or at a corner straight beside it: Pythagoras gives what is left of
    # the leg where the goal is exactly `distance` away.
    return before_target(start, end, (distance**2 - remaining**2) ** 0.5)
