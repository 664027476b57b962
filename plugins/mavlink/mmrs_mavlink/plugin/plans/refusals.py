"""What missions for ground stations cannot express, whatever the format of their files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from mmrs_core.behaviour.earth import LOCAL, at_a_pole, sea_level_of
from mmrs_core.behaviour.program import DEVICE_ACTION, FEEDBACK, Action, Move, RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.context import homeless
from mmrs_core.generation.plan_refusals import policy_words
from mmrs_core.generation.python.moves import losses_of, mount_of, objects_of
from mmrs_core.generation.safety import explicit, policies_of
from mmrs_core.scene import Policy
from mmrs_mavlink.plugin.context import VehicleContext, context_of, vehicleless
from mmrs_mavlink.plugin.controllers import DRIVER
from mmrs_mavlink.plugin.headings import on_gimbal
from mmrs_mavlink.plugin.plans.flight import flown
from mmrs_mavlink.plugin.plans.items import unknown_in
from mmrs_mavlink.plugin.plans.times import too_long
from mmrs_mavlink.plugin.vehicles import autopilot_fault
from mmrs_mavlink.wiring import Sampled, Unwired


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield each thing that plans cannot express, with robot and move."""
    if input.program.frame.is_local:
        yield LOCAL
    yield from at_a_pole(input.program.frame)
    for robot in input.program.robots:
        if unknown := vehicleless(robot, input):
            yield unknown
            continue
        yield from _of_robot(robot, input)
        yield from too_long(robot, input)
        yield from _above_water(robot, input)


def _of_robot(robot: RobotProgram, input: TargetInput) -> Iterator[str]:
    if robot.home is None:
        yield homeless(robot)
    elif sea_level_of(robot.home, input.program.frame) is None and not _dives(robot, input):
        yield (
            f"robot '{robot.id}': the height of its home above mean sea level is not known; give altitudes"
            " above mean sea level, or the geoid separation"
        )
    if fault := autopilot_fault(input.types.get(robot.type_name), input.extensions):
        yield f"robot '{robot.id}': {fault}"
    for policy in _declared(robot, input):
        yield f"robot '{robot.id}': {_refused(policy)}"
    context = context_of(robot, input)
    yield from _coming_round(robot, context)
    flight = flown(context)
    yield from flight.left
    for index, move in enumerate(robot.moves):
        if index in flight.beyond:
            yield f"{context.label(move)}: comes after the end of the plan, so it is in none"
            continue
        yield from losses_of(move, context, DRIVER)
        for description in objects_of(move):
            yield f"{context.label(move)}: object '{description}', which a plan cannot have looked for"
        for action in (*move.before, *move.after):
            yield from _of_action(action, move, context)
        yield from _of_heading(move, context)
        transition = robot.transitions.get(index)
        if transition is not None and transition.waits:
            slots = ", ".join(transition.waits)
            yield f"{context.label(move)}: waits for {slots}, which only an operator can do in a plan"
        if transition is not None and transition.condition is not None:
            yield (
                f"{context.label(move)}: chooses by '{transition.condition}', so the plan ends here, and the"
                " vehicle stays here until an operator takes over"
            )
        for policy in transition.policies if transition is not None else ():
            yield f"{context.label(move)}: {_refused(explicit(policy))}"


def _above_water(robot: RobotProgram, input: TargetInput) -> Iterator[str]:
    """Yield what leads a vehicle that dives out of the water."""
    context = context_of(robot, input)
    for move in robot.moves if context.dives else ():
        position = move.target.position if move.target is not None else None
        if position is not None and context.height(position) > 0.0:
            above = context.height(position)
            yield f"{context.label(move)}: leads {above:g} m above the surface, which the vehicle skips"


def _dives(robot: RobotProgram, input: TargetInput) -> bool:
    """Return whether a robot's heights count from the surface, wherever that is above the sea."""
    return context_of(robot, input).dives


def _coming_round(robot: RobotProgram, context: VehicleContext) -> Iterator[str]:
    """Yield where the moves up to the first choice lead back to one of them."""
    index, seen = robot.start, set[int]()
    while index not in seen and (transition := robot.transitions.get(index)) is not None:
        if transition.condition is not None:
            return
        seen.add(index)
        if transition.to in seen:
            again = robot.moves[transition.to].id
            yield f"{context.label(robot.moves[index])}: '{again}' comes round again, so the plan ends here"
        index = transition.to


def _declared(robot: RobotProgram, input: TargetInput) -> tuple[Policy, ...]:
    """Return the declared policies of a robot, without the defaults of its kind."""
    return policies_of(robot, replace(input, robot_kinds={}))


def _refused(policy: Policy) -> str:
    return f"{policy_words(policy)}, which only settings of the vehicle can do"


def _of_action(action: Action, move: Move, context: VehicleContext) -> Iterator[str]:
    if action.metaclasses[0] == FEEDBACK:
        return  # nothing waits for it; the note of its file says that it is not sent
    if not action.is_a(DEVICE_ACTION):
        yield f"{context.label(move)}: action {action.metaclasses[0][1]} has no form in a plan"
        return
    wiring = context.wiring(action)
    if isinstance(wiring, Unwired):
        yield f"{context.label(move)}: action '{action.name}': {wiring.reason}"
    elif isinstance(wiring, Sampled):
        yield f"{context.label(move)}: action '{action.name}': a plan cannot record '{wiring.value}'"
    elif unknown := unknown_in(wiring, context.profile.autopilot.missions):
        shown, whose = ", ".join(map(str, unknown)), context.profile.autopilot.title
        yield f"{context.label(move)}: action '{action.name}': no mission of a {whose} has command {shown}"


def _of_heading(move: Move, context: VehicleContext) -> Iterator[str]:
    """Yield what a region of interest cannot say: it always turns the front, or a gimbal, straight to it."""
    if move.heading is None or move.target is None:
        return
    if move.heading.angle_degrees:
        yield f"{context.label(move)}: heading with an angle on the way"
    if mount_of(move.heading, context) and not on_gimbal(move.heading, context):
        yield f"{context.label(move)}: device '{move.heading.device}' does not look ahead (mount.yaw)"
