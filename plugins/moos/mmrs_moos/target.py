"""The target moos: each robot's helm (pHelmIvP), in MOOS-IvP's behaviour files.

A file holds steps; the variable ``MMRS_STEP`` holds the current one. Its waypoints are metres
east and north of the behaviour's origin, which must be that of the vehicle's MOOS mission, too. The format
is that of https://oceanai.mit.edu/ivpman/. These files were never run by a helm: their reader in the
tests was written from that manual.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import files as files_of
from pathlib import Path

from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.context import RobotContext, require_home
from mmrs_core.generation.plan_moves import context_of
from mmrs_core.scene import Frame
from mmrs_moos.behaviours import behaviours_of
from mmrs_moos.capabilities import CAPABILITIES
from mmrs_moos.refusals import VEHICLES, nodes_of, refusals
from mmrs_moos.steps import Step, Variables, course_of, variables_for
from mmrs_moos.words import text


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield ``<robot>.bhv``.

    Raises:
        UnsupportedError: a robot has no home, or flies.
    """
    nodes = nodes_of(input)
    for robot in input.program.robots:
        require_home(robot)
        context = context_of(robot, input, VEHICLES)
        if context.flies:
            raise UnsupportedError(f"robot '{robot.id}': flies")
        variables = variables_for(context, input, nodes)
        yield FileSpec(
            f"{nodes[robot.id]}.bhv",
            "helm.bhv.jinja",
            _view(context, variables, input.program.frame),
            asks=tuple(_asks(variables)),
        )


def _view(context: RobotContext, variables: Variables, frame: Frame) -> dict[str, object]:
    steps = course_of(context, variables).steps
    return {
        "robot": context.robot.id,
        "origin": None if frame.is_local else [frame.latitude, frame.longitude, frame.crs],
        "deepest": max((step.depth for step in steps), default=0.0),
        "begins": steps[0].id if steps else "",
        "slots": sorted(variables.slots.values()),
        "steps": [_shown(step, context) for step in steps],
    }


def _shown(step: Step, context: RobotContext) -> dict[str, object]:
    move = step.move
    return {
        "traced": TracedStep(f"step {step.id}", context.robot.id, move.id, move.task, move.rule),
        "move": move.id,
        "task": move.task,
        "behaviours": [
            {"type": each.type, "parameters": each.parameters} for each in behaviours_of(step, context)
        ],
    }


def _asks(variables: Variables) -> Iterator[str]:
    for condition, variable in variables.conditions.items():
        yield f"post {variable} as true or false: whether '{condition}' holds"


MOOS = Target(
    name="moos",
    description="behaviour files (.bhv) for the IvP helm of MOOS-IvP, one of each robot",
    templates=Path(str(files_of("mmrs_moos"))) / "templates" / "moos",
    files=files,
    refusals=refusals,
    filters={"bhv": text},
    capabilities=CAPABILITIES,
    tried_with="water",
)
