"""The target imc: a plan for each robot, as vehicles of LSTS take it, and in readable form.

The messages are those of IMC 5.4 (https://www.lsts.pt/docs/imc/master/). ``<robot>.imc`` holds the
packet of a ``PlanSpecification``; ``<robot>.load.imc`` the same in a request to a vehicle's plan data
base (``PlanDB``, SET); ``<robot>.json`` the same for reading and scripts. These packets were never sent
to a vehicle: their reader in the tests was written from the published definitions.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import files as files_of
from pathlib import Path

from mmrs_core.behaviour.earth import LOCAL
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.context import RobotContext, require_home
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.plan_moves import context_of
from mmrs_imc.capabilities import CAPABILITIES
from mmrs_imc.messages import REQUEST, SET, Message, Value
from mmrs_imc.packing import packet
from mmrs_imc.plans import Plan, plan_of
from mmrs_imc.refusals import VEHICLES, refusals


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
    tried_with="water",
)
