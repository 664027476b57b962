"""How a vehicle that is still in the air comes back to where a leg of its program begins.

It may be anywhere on the way that it came in this sortie, or ahead: on the leg that was under way when
nobody told it anything any more, or on what is left of a run, which it flies to its end by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mmrs_runtime.faults import Refused

from ..places import at_height, distance, distance_to_leg, ends_of
from ..program import GoTo, Land, Place, Robot, TakeOff

OFF_ITS_WAY = 5.0
"""Metres that a robot may be from the way of its program when it is to go on in the air."""

ALIKE = 0.1
"""Metres by which one leg must be nearer than another to count as that: of two, the later one is meant."""


def way_ahead(robot: Robot, move: str, here: Place, locate: Callable[[GoTo], Place]) -> tuple[Place, ...]:
    """Return the ends of the legs that a vehicle may be on without another word from its program.

    Args:
        robot: whose program it is.
        move: that was under way.
        here: where that move began.
        locate: finds where a movement leads to.
    """
    run = next((run.moves for run in robot.runs if move in run.moves), (move,))
    ahead: list[Place] = []
    for each in run[run.index(move) :]:
        begun, movement = ahead[-1] if ahead else here, robot.step(each).movement
        if isinstance(movement, TakeOff):
            ahead.append(at_height(begun, movement.height))
        elif isinstance(movement, Land):
            ahead.append(at_height(begun, robot.home.height))
        elif isinstance(movement, GoTo):
            ahead += ends_of(begun, locate(movement), movement.legs, movement.distance)
    return tuple(ahead)


@dataclass(frozen=True, slots=True)
class Rejoined:
    """Where a vehicle is on its way, to which places that it has passed it must go once more.

    Attributes:
        behind: how many of those it still has behind it.
        back: places ahead of the last of them, by which it comes back to that; where there are any, or it is
            there, all are behind it.
    """

    behind: int
    back: tuple[Place, ...] = ()


def rejoined(began: Place, passed: Sequence[Place], ahead: Sequence[Place], here: Place) -> Rejoined:
    """Return where a vehicle is on its way.

    Args:
        began: where its way begins, on the ground.
        passed: places passed in this sortie.
        ahead: ends of the legs after the last of them.
        here: where the vehicle is.

    Raises:
        Refused: it is not on its way.
    """
    way = [began, *passed, *ahead]
    away = [distance_to_leg(here, a, b) for a, b in pairwise(way)] or [distance(here, began)]
    nearest = max(range(len(away)), key=lambda leg: (-round(away[leg] / ALIKE), leg))
    if away[nearest] > OFF_ITS_WAY:
        raise Refused(f"the vehicle is in the air and {away[nearest]:.0f} m from the way of its program")
    last = len(passed)
    return Rejoined(nearest) if nearest < last else Rejoined(last, tuple(way[last : nearest + 1][::-1]))
