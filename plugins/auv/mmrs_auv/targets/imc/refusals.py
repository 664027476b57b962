"""What plans of IMC cannot express."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_auv.targets.imc.plans import LONGEST, plan_of
from mmrs_auv.targets.imc.wiring import set_by
from mmrs_auv.targets.moves import MOVES, above_surface, seconds_of_hold
from mmrs_core.behaviour.program import Action, Move, RobotProgram, Target, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.mavlink.actions import DEVICE_ACTION
from mmrs_core.mavlink.context import RobotContext, context_of, homeless
from mmrs_core.scene import Policy


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield each thing that plans cannot express, with robot and move."""
    if input.program.frame.is_local:
        yield "behaviour: is local, its origin has no latitude and longitude"
    for robot in input.program.robots:
        yield from _of_robot(robot, input)


def _of_robot(robot: RobotProgram, input: TargetInput) -> Iterator[str]:
    if robot.home is None:
        yield homeless(robot)
    context = context_of(robot, input, geographic=False)
    if context.vehicle.flies:
        yield f"robot '{robot.id}': flies, and heights of these plans count down from the water surface"
    elif not plan_of(context, input.program.name, robot.id).maneuvers:
        yield f"robot '{robot.id}': does nothing that a manoeuvre of IMC does"
    of_type = context.type.policies if context.type is not None else ()
    for policy in dict.fromkeys((*robot.policies, *of_type)):
        yield f"robot '{robot.id}': {_described(policy)}"
    for index, move in enumerate(robot.moves):
        for why in _of_move(move, context):
            yield f"{context.label(move)}: {why}"
        transition = robot.transitions.get(index)
        for why in _of_transition(transition) if transition is not None else ():
            yield f"{context.label(move)}: {why}"


def _of_move(move: Move, context: RobotContext) -> Iterator[str]:
    known = MOVES.get(move.metaclasses[0])
    if known is None:
        yield f"{move.kind} is not known to this target"
    if known == "go" and context.speed(move) is None:
        yield "its speed is not known, because its robot type is not given"
    if known == "turn":
        yield "turns on the spot, which no manoeuvre of IMC does"
    elif move.heading is not None:
        yield "heading on the way, which vehicles may leave unheeded"
    if seconds_of_hold(move) > LONGEST:
        yield f"holds for {seconds_of_hold(move):g} s, of {LONGEST:,} at most"
    target = move.target
    if target is not None:
        yield from _of_target(target, context)
    for action in (*move.before, *move.after):
        yield from _of_action(action, context)


def _of_target(target: Target, context: RobotContext) -> Iterator[str]:
    if target.description is not None:
        yield f"object '{target.description}', which a plan cannot have looked for"
    if target.position is not None and not context.vehicle.flies:
        above = above_surface(target.position, context)
        if above > 1e-6:
            yield f"leads {above:g} m above the surface"


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
        yield _described(policy)


def _described(policy: Policy) -> str:
    after = "" if policy.after is None else f" after {policy.after:g} s"
    return f"policy {policy.event}{after}: {policy.response}, which only settings of the vehicle can do"
