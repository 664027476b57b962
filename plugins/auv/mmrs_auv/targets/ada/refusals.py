"""What the decision centre in Ada cannot do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite

from mmrs_auv.names import VEHICLES
from mmrs_auv.sayable import parameter_of, unturnable
from mmrs_auv.sheets import action_number
from mmrs_auv.targets.ada.bus import can_be_said, depth_step_of
from mmrs_auv.targets.ada.policies import declared, obstacles_to
from mmrs_core.behaviour.program import BEHAVIOUR, DEVICE_ACTION, FEEDBACK, NOTIFY, Action, Move, RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.context import RobotContext
from mmrs_core.generation.plan_moves import MOVES, above_surface, context_of, vehicleless
from mmrs_core.generation.plan_refusals import policy_words
from mmrs_core.scene import Name

SORTS: Mapping[Name, str] = {**MOVES, (BEHAVIOUR, "Recharge"): "charge"}
"""Sorts of moves by their own metaclass."""

STEPS = 65_535
"""Depth of goals has sixteen bits."""


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield each thing that the decision centre cannot do, with robot and move."""
    for robot in input.program.robots:
        if unknown := vehicleless(robot, input, VEHICLES):
            yield f"{unknown}: --allow-lossy leaves it out beside others"
            continue
        context = context_of(robot, input, VEHICLES)
        if not context.dives:
            yield f"robot '{robot.id}': not an underwater vehicle: --allow-lossy leaves it out beside others"
            continue
        for policy in declared(robot, input):
            if why := obstacles_to(policy):
                yield f"robot '{robot.id}': {policy_words(policy)}: {why}"
        step = depth_step_of(robot, input)
        for index, move in enumerate(robot.moves):
            for why in _of_move(move, context, step):
                yield f"{context.label(move)}: {why}"
            transition = robot.transitions.get(index)
            for policy in transition.policies if transition is not None else ():
                if why := obstacles_to(policy):
                    yield f"{context.label(move)}: {policy_words(policy)}: {why}"


def is_diver(robot: RobotProgram, input: TargetInput) -> bool:
    """Return whether a robot is an underwater vehicle."""
    return not vehicleless(robot, input, VEHICLES) and context_of(robot, input, VEHICLES).dives


def of_movement(move: Move, context: RobotContext, step: float = 0.0) -> Iterator[str]:
    """Yield why a movement cannot be made at all.

    Args:
        move: of the robot.
        context: of the robot.
        step: metres of depth in a step on its bus; 0: not known.
    """
    sort = SORTS.get(move.metaclasses[0])
    if sort is None:
        yield f"{move.kind} is not known to this target"
    for name, number in _numbers(move):
        if not isfinite(number):
            yield f"its {name} is {number:g}, which is not a number"
    if sort == "turn" and (move.heading is None or move.heading.target.position is None):
        yield "the position that it turns to is unknown"
    if sort != "go":
        return
    if move.target is None or move.target.position is None:
        yield "the position of its target is unknown"
        return
    east, north, up = move.target.position
    for name, metres in (("North", north), ("East", east)):
        if not can_be_said("GoalPlace", name, metres):
            yield f"leads {metres:g} m to the {name.lower()}, farther than its bus can say"
    depth = context.frame.surface - up
    if step > 0.0 and depth > STEPS * step:
        yield f"leads {depth:g} m down, deeper than its bus can say"


def _numbers(move: Move) -> Iterator[tuple[str, float]]:
    """Yield what a move tells its vehicle, with its name."""
    duration = move.attributes.get("duration")
    if isinstance(duration, (int, float)):
        yield "duration", duration
    if move.speed is not None:
        yield "speed", move.speed
    yield "distance", move.distance
    if move.heading is not None:
        yield "angle", move.heading.angle_degrees
        yield from (("heading", number) for number in move.heading.target.position or ())
    if move.target is not None:
        yield from (("target", number) for number in move.target.position or ())
        yield "tolerance", move.target.tolerance or 0.0


def of_action(action: Action, context: RobotContext) -> Iterator[str]:
    """Yield why an action cannot be done."""
    if action.is_a(NOTIFY) or action.is_a(FEEDBACK):
        return
    if not action.is_a(DEVICE_ACTION):
        yield f"action {action.metaclasses[0][1]} is not known to this target"
        return
    number = action_number(context.type, action.device, action.name) if context.type is not None else None
    if number is None or context.type is None:
        yield f"device '{action.device}' has no action '{action.name}'"
        return
    device, parameter = list(context.type.devices).index(action.device), parameter_of(action)
    for field, reported in (("Device", float(device)), ("Action", float(number)), ("Parameter", parameter)):
        if not can_be_said("DeviceCommand", field, reported):
            yield f"{field.lower()} {reported:g} of device '{action.device}' is more than its bus can say"


def _of_move(move: Move, context: RobotContext, step: float) -> Iterator[str]:
    yield from of_movement(move, context, step)
    sort = SORTS.get(move.metaclasses[0])
    if sort == "go" and move.target is not None and move.target.position is not None:
        if above_surface(move.target.position, context) > 1e-6:
            yield f"leads {above_surface(move.target.position, context):g} m above the surface"
        if context.speed(move) is None:
            yield "its speed is not known, because its robot type is not given"
        if move.heading is not None and move.heading.target.position is None:
            yield "the position that it faces is unknown"
    if move.heading is not None:
        yield from unturnable(move.heading.device, context.type)
        if sort != "go" and sort != "turn":
            yield f"heading of a {move.kind}"
    for action in (*move.before, *move.after):
        yield from of_action(action, context)
