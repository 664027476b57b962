"""Possible positions of a vehicle that is still in the air: on its last leg, or on its run.

It flies the rest of a run to its end without further commands.
"""

from __future__ import annotations

from collections.abc import Callable

from mmrs_runtime.controllers.geodesy import at_height, ends_of

from ..program import GoTo, Land, Place, Robot, TakeOff

OFF_ITS_WAY = 5.0
"""Metres that a robot may be from the path of its program to continue in the air."""

ALIKE = 0.1
"""Metres by which one leg must be nearer than another to count as that: of two, the later one is meant."""


def way_ahead(robot: Robot, move: str, here: Place, locate: Callable[[GoTo], Place]) -> tuple[Place, ...]:
    """Return the ends of the legs that a vehicle may be on without another command of its program.

    Args:
        robot: whose program it is.
        move: that was in progress.
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
