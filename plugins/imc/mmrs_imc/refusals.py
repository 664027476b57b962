"""What plans of IMC cannot express."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.behaviour.earth import LOCAL
from mmrs_core.behaviour.program import DEVICE_ACTION, Action, Move, RobotProgram, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.context import RobotContext, homeless
from mmrs_core.generation.plan_moves import context_of, seconds_of_hold, vehicleless
from mmrs_core.generation.plan_refusals import Wording, of_movement, of_policies, of_policy
from mmrs_imc.plans import LONGEST, plan_of
from mmrs_imc.wiring import set_by

VEHICLES = ("ground", "rover", "sub")
"""Classes of vehicles that these plans are for."""

WORDING = Wording(
    turn="which no manoeuvre of IMC does",
    heading="which vehicles may ignore",
    object="which a plan cannot have looked for",
    policy="settings of the vehicle",
)


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield each thing that plans cannot express, with robot and move."""
    if input.program.frame.is_local:
        yield LOCAL
    for robot in input.program.robots:
        yield from _of_robot(robot, input)


def _of_robot(robot: RobotProgram, input: TargetInput) -> Iterator[str]:
    if robot.home is None:
        yield homeless(robot)
    if unknown := vehicleless(robot, input, VEHICLES):
        yield unknown
        return
    context = context_of(robot, input, VEHICLES)
    if context.flies:
        yield f"robot '{robot.id}': flies, and heights of these plans count down from the water surface"
    else:
        plan = plan_of(context, input.program.name, robot.id)
        if not plan.maneuvers:
            yield f"robot '{robot.id}': does nothing that a manoeuvre of IMC does"
        yield from (f"{context.label(move)}: {why}" for move, why in plan.faults)
    yield from of_policies(robot, context, WORDING)
    for index, move in enumerate(robot.moves):
        for why in _of_move(move, context):
            yield f"{context.label(move)}: {why}"
        transition = robot.transitions.get(index)
        for why in _of_transition(transition) if transition is not None else ():
            yield f"{context.label(move)}: {why}"


def _of_move(move: Move, context: RobotContext) -> Iterator[str]:
    yield from of_movement(move, context, WORDING)
    if seconds_of_hold(move) > LONGEST:
        yield f"holds for {seconds_of_hold(move):g} s, of {LONGEST:,} at most"
    for action in (*move.before, *move.after):
        yield from _of_action(action, context)


def _of_action(action: Action, context: RobotContext) -> Iterator[str]:
    if not action.is_a(DEVICE_ACTION):
        yield f"action {action.metaclasses[0][1]} has no form in a plan"
        return
    made = set_by(action, context.type)
    if isinstance(made, str):
        yield f"action '{action.name}': {made}"


def _of_transition(transition: Transition) -> Iterator[str]:
    if transition.waits:
        yield f"waits for {', '.join(transition.waits)}, which only an operator can do in a plan"
    if transition.condition is not None:
        yield f"chooses by '{transition.condition}', of which vehicles know nothing"
    for policy in transition.policies:
        yield of_policy(policy, WORDING)
