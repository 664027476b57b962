"""The target imc: a plan for each robot, as vehicles of LSTS take it, and in readable form.

The messages are those of IMC 5.4 (https://www.lsts.pt/docs/imc/master/). ``<robot>.imc`` holds the
packet of a ``PlanSpecification``; ``<robot>.load.imc`` the same in a request to a vehicle's plan data
base (``PlanDB``, SET); ``<robot>.json`` the same for reading and scripts. These packets were never sent
to a vehicle: their reader in the tests was written from the published definitions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib.resources import files as files_of
from pathlib import Path

from mmrs_core.behaviour.earth import LOCAL
from mmrs_core.behaviour.program import DEVICE_ACTION, Action, Move, RobotProgram, Transition
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.context import RobotContext, homeless, require_home
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.plan_moves import context_of, seconds_of_hold, vehicleless
from mmrs_core.generation.plan_refusals import Wording, of_movement, of_policies, of_policy
from mmrs_imc.messages import REQUEST, SET, Message, Value, packet
from mmrs_imc.plans import LONGEST, Plan, plan_of
from mmrs_imc.wiring import set_by

CAPABILITIES: Mapping[str, str] = {
    "Behaviour.crs": "places are converted to WGS 84",
    "Behaviour.origin": "latitude and longitude in radians",
    "Behaviour.name": "in the description of the plan",
    "Behaviour.surfaceHeight": "depths count from it",
    "Behaviour.robots": "a plan each",
    "Robot: auv": "depths below the surface",
    "Robot: plain robot": "a vehicle at the surface",
    "Robot.id": "identifier of the plan, and name of the file",
    "Robot.home": "where it holds before it goes anywhere",
    "Robot.travelMode": "speed in metres per second",
    "Robot.payload": "speed, by the capability for it",
    "Context": "routes keep clear of it; plans know no areas",
    "GeoCoordinate": "latitude, longitude and depth",
    "GoTo": "Goto",
    "GoTo.distance": "a Goto short of the position",
    "GoTo.speed": "speed in metres per second",
    "HoldPosition": "StationKeeping; at the surface PopUp; rounded up to seconds",
    "Move.name": "identifier of the manoeuvre",
    "Move.task": "in the manifest",
    "Move.rule": "in the manifest",
    "MoveTransition.fluid": "manoeuvres follow each other in any case",
    "MoveTransition.to": "PlanTransition",
}

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


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield ``<robot>.imc``, ``<robot>.load.imc`` and ``<robot>.json``.

    Raises:
        UnsupportedError: the behaviour is local, a robot has no home or flies, or a plan is too long.
    """
    if input.program.frame.is_local:
        raise UnsupportedError(LOCAL)
    stems = file_stems([robot.id for robot in input.program.robots])
    for robot in input.program.robots:
        require_home(robot)
        context = context_of(robot, input, VEHICLES)
        if context.flies:
            raise UnsupportedError(f"robot '{robot.id}': flies")
        stem = stems[robot.id]
        plan = plan_of(context, input.program.name, stem)
        if not plan.maneuvers:
            raise UnsupportedError(f"robot '{robot.id}': does nothing that a manoeuvre of IMC does")
        trace = tuple(_steps(context, plan))
        yield FileSpec(f"{stem}.imc", "", data=packet(plan.message), trace=trace)
        yield FileSpec(f"{stem}.load.imc", "", data=packet(_request(stem, plan.message)))
        yield FileSpec(f"{stem}.json", "plan.json.jinja", {"plan": _shown(plan.message)})


def _steps(context: RobotContext, plan: Plan) -> Iterator[TracedStep]:
    for each in plan.maneuvers:
        move = each.move
        yield TracedStep(f"manoeuvre {each.id}", context.robot.id, move.id, move.task, move.rule)


def _request(plan_id: str, plan: Message) -> Message:
    values: dict[str, Value] = {"type": REQUEST, "op": SET, "request_id": 1, "plan_id": plan_id}
    return Message("PlanDB", {**values, "arg": plan, "info": ""})


def _shown(value: Value) -> object:
    if isinstance(value, Message):
        return {"message": value.name} | {name: _shown(each) for name, each in value.values.items()}
    return [_shown(each) for each in value] if isinstance(value, tuple) else value


IMC = Target(
    name="imc",
    description="plans for LSTS vehicles: IMC messages PlanSpecification, one of each robot",
    templates=Path(str(files_of("mmrs_imc"))) / "templates" / "imc",
    files=files,
    refusals=refusals,
    capabilities=CAPABILITIES,
    tried_with="sub",
)
