"""What missions of vehicles that dive ask for: heights count from the water surface, down."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import Position
from mmrs_mavlink.plugin.context import VehicleContext, context_of


def zero_of(context: VehicleContext, home: Position) -> Position:
    """Return where the heights of a mission count from: home, or the surface above it."""
    return (home[0], home[1], context.zero) if context.dives else home


def above_water(robot: RobotProgram, input: TargetInput) -> Iterator[str]:
    """Yield what leads a vehicle that dives out of the water."""
    context = context_of(robot, input)
    for move in robot.moves if context.dives else ():
        position = move.target.position if move.target is not None else None
        if position is not None and context.height(position) > 0.0:
            above = context.height(position)
            yield f"{context.label(move)}: leads {above:g} m above the surface, which the vehicle skips"
