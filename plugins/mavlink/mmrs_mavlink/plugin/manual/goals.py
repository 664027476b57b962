"""What moves and device actions are to a vehicle that is driven by hand."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, degrees

from mmrs_core.behaviour.program import Action, Move
from mmrs_core.generation.plan_moves import MOVES, above_surface, seconds_of, seconds_of_hold
from mmrs_core.transformation.kinds import before_target
from mmrs_mavlink.plugin.context import VehicleContext
from mmrs_mavlink.plugin.manual.autopilot import StickAutopilot
from mmrs_mavlink.plugin.manual.steering import Goal, StickSteering
from mmrs_mavlink.wiring import Wired
from mmrs_runtime import faults


def refusals(context: VehicleContext) -> Iterator[str]:
    """Yield what a robot cannot be driven to do by hand, with its moves."""
    if not context.dives:
        yield f"robot '{context.robot.id}': not an underwater vehicle"
    if context.robot.home is None:
        yield f"robot '{context.robot.id}': its home is not known, and the way is reckoned from there"
    for move in context.robot.moves:
        for why in _of_move(move, context):
            yield f"{context.label(move)}: {why}"


def _of_move(move: Move, context: VehicleContext) -> Iterator[str]:
    known = MOVES.get(move.metaclasses[0])
    if known is None:
        yield f"{move.kind} is not known to this backend"
    targets = (move.target, move.heading.target if move.heading is not None else None)
    for target in targets:
        if target is not None and target.description is not None:
            yield f"object '{target.description}', which is not located"
    if known == "go":
        if move.heading is not None:
            yield "heading on the way, which goes ahead"
        position = move.target.position if move.target is not None else None
        if position is not None and above_surface(position, context) > 0.0:
            yield f"leads {above_surface(position, context):g} m above the surface"


def goal_of(move: Move, steering: StickSteering, context: VehicleContext, depth: float) -> Goal | None:
    """Return what a move leads to; None for one that does nothing.

    Args:
        move: that is begun.
        steering: knows where the vehicle is.
        context: of the robot.
        depth: at which it is to stay, metres.
    """
    sort = MOVES.get(move.metaclasses[0])
    if sort == "go" and move.target is not None and move.target.position is not None:
        here = (steering.east, steering.north, context.zero - depth)
        place = before_target(here, move.target.position, move.distance)
        speed = context.speed(move) or 0.5
        return Goal(max(0.0, -above_surface(place, context)), place[0], place[1], speed=speed)
    if sort == "hold":
        return Goal(depth, steering.east, steering.north, seconds=seconds_of_hold(move))
    heading = move.heading
    if sort == "turn" and heading is not None and heading.target.position is not None:
        east, north, _ = heading.target.position
        bearing = degrees(atan2(east - steering.east, north - steering.north)) - heading.angle_degrees
        return Goal(depth, heading=bearing % 360.0)
    return None


def carry_out(action: Action, context: VehicleContext, autopilot: StickAutopilot) -> float:
    """Carry out a device action; return the seconds that it takes from then on.

    Raises:
        faults.FaultError: it is not wired for that, does not do it, or does not answer.
    """
    wiring = context.wiring(action)
    if not isinstance(wiring, Wired):
        raise faults.RefusedError(f"'{action.device}' is not wired for '{action.name}'")
    for number, params in ((wiring.command, wiring.params), *wiring.more):
        autopilot.do(number, *params)
    return seconds_of(action, context.type) if wiring.seconds is None else wiring.seconds
