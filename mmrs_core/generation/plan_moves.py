"""What plans for vehicles of others know of moves, and of the actions of devices."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, TypeAlias

from mmrs_core.behaviour.earth import metres
from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move
from mmrs_core.scene import Name, Position, RobotType

if TYPE_CHECKING:
    from mmrs_core.mavlink.context import VehicleContext

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


def writable_speed(speed: float) -> float:
    """Return the nearest speed that means something, metres per second."""
    return min(FASTEST, max(SLOWEST, speed))


def above_surface(position: Position, context: VehicleContext) -> float:
    """Return how far a position is above the surface, metres; one of a robot that stays on it never is."""
    return metres(position[2] - context.frame.surface) if context.vehicle.dives else 0.0


def seconds_of_hold(move: Move) -> float:
    """Return how long a move holds; 0 for others."""
    found = move.attributes.get("duration") if MOVES.get(move.metaclasses[0]) == "hold" else None
    return float(found) if isinstance(found, (int, float)) else 0.0


def seconds_of(action: Action, type: RobotType | None) -> float:
    """Return how long an action of a device takes; 0 where nothing is known."""
    device = type.devices.get(action.device) if type is not None else None
    known = device.actions.get(action.name) if device is not None else None
    return known.duration if known is not None else 0.0
