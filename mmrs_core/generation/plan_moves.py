"""What plans for vehicles of others know of moves, and of the actions of devices."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Literal, TypeAlias

from mmrs_core.behaviour.earth import metres
from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move, RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation import context as robots
from mmrs_core.generation.context import RobotContext, medium_of, uncarried
from mmrs_core.scene import Name, Position, RobotType

Sort: TypeAlias = Literal["start", "stop", "go", "hold", "turn"]

MOVES: Mapping[Name, Sort] = {
    (BEHAVIOUR, "Start"): "start",
    (BEHAVIOUR, "Stop"): "stop",
    (BEHAVIOUR, "GoTo"): "go",
    (BEHAVIOUR, "HoldPosition"): "hold",
    (BEHAVIOUR, "HeadTo"): "turn",
}
"""Moves by their own metaclass: one that extends it may move otherwise, and is not known."""

SLOWEST, FASTEST = 0.01, 100.0
"""Metres per second between which speeds mean something to vehicles of others."""

DEEPEST = 11_000.0
"""Metres: no sea is deeper."""


def vehicleless(robot: RobotProgram, input: TargetInput, vehicles: Collection[str]) -> str:
    """Return why no vehicle of these classes carries a robot; empty where one does, and if it flies."""
    return "" if medium_of(robot, input) == "air" else uncarried(robot, input, vehicles)


def context_of(robot: RobotProgram, input: TargetInput, vehicles: Collection[str]) -> RobotContext:
    """Return the context of a robot.

    Raises:
        UnsupportedError: no vehicle of these classes carries it.
    """
    if why := vehicleless(robot, input, vehicles):
        raise UnsupportedError(why)
    return robots.context_of(robot, input)


def writable_speed(speed: float) -> float:
    """Return the nearest speed that means something, metres per second."""
    return min(FASTEST, max(SLOWEST, speed))


def above_surface(position: Position, context: RobotContext) -> float:
    """Return how far a position is above the surface, metres; one of a robot that stays on it never is."""
    return metres(position[2] - context.frame.surface) if context.dives else 0.0


def seconds_of_hold(move: Move) -> float:
    """Return how long a move holds; 0 for others."""
    found = move.attributes.get("duration") if MOVES.get(move.metaclasses[0]) == "hold" else None
    return float(found) if isinstance(found, (int, float)) else 0.0


def seconds_of(action: Action, type: RobotType | None) -> float:
    """Return how long an action of a device takes; 0 where nothing is known."""
    device = type.devices.get(action.device) if type is not None else None
    known = device.actions.get(action.name) if device is not None else None
    return known.duration if known is not None else 0.0
