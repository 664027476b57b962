"""The target moos: each robot's helm (pHelmIvP), in MOOS-IvP's behaviour files.

A file holds steps; the variable ``MMRS_STEP`` holds the current one. Its waypoints are metres
east and north of the behaviour's origin, which must be that of the vehicle's MOOS mission, too. The format
is that of https://oceanai.mit.edu/ivpman/. These files were never run by a helm: their reader in the
tests was written from that manual.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib.resources import files as files_of
from pathlib import Path

from mmrs_core.behaviour.program import Move, RobotProgram
from mmrs_core.behaviour.walk import in_order, successors
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.context import RobotContext, homeless, require_home
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.plan_moves import context_of, vehicleless
from mmrs_core.generation.plan_refusals import Wording, of_movement, of_policies, of_policy
from mmrs_core.scene import Frame
from mmrs_moos.behaviours import behaviours_of
from mmrs_moos.steps import Step, Variables, course_of, posts_of, variables_for
from mmrs_moos.words import text

CAPABILITIES: Mapping[str, str] = {
    "Behaviour.crs": "in a comment: the vehicle's mission has an origin of its own",
    "Behaviour.origin": "in a comment: the vehicle's mission must have the same",
    "Behaviour.origin absent: a local behaviour": "metres east and north of the origin",
    "Behaviour.surfaceHeight": "depths count from it",
    "Behaviour.robots": "a file each",
    "Robot: auv": "BHV_ConstantDepth beside all that moves it",
    "Robot: plain robot": "a vehicle at the surface",
    "Robot.id": "name of the file and of its community",
    "Robot.home": "where it begins",
    "Robot.travelMode": "speed and capture radius",
    "Robot.payload": "speed, by the capability for it",
    "Robot.slots": "variables, initially false",
    "Context": "routes keep clear of it; the helm knows no areas",
    "GeoCoordinate": "metres east and north of the origin, and depth",
    "RelativeCoordinate": "metres east and north of the origin, and depth",
    "Start, Stop": "MMRS_STEP at first, and MMRS_DONE at last",
    "GoTo": "BHV_Waypoint; sloping paths in pieces, within a metre of the straight line",
    "GoTo.distance": "a waypoint short of the position",
    "GoTo.speed": "speed",
    "HoldPosition": "BHV_StationKeep and BHV_Timer",
    "Move.name": "names of its behaviours",
    "Move.task": "in comments",
    "Move.rule": "in the manifest",
    "MoveTransition.waitFor": "conditions on the slots' variables",
    "MoveTransition.fluid": "a helm passes waypoints as its capture radius says",
    "Choice": "a variable of yours is true or false",
    "Feedback": "an endflag: MMRS_FEEDBACK",
    "UnicastNotify": "an endflag: NODE_MESSAGE_LOCAL (uFldMessageHandler), sent once, unacknowledged",
    "MulticastNotify": "endflags: NODE_MESSAGE_LOCAL (uFldMessageHandler), sent once, unacknowledged",
    "BroadcastNotify": "endflags: NODE_MESSAGE_LOCAL (uFldMessageHandler), sent once, unacknowledged",
    "Notify.active": "the same with false",
}

VEHICLES = ("ground", "rover", "sub")
"""Classes of vehicles that these plans are for."""

WORDING = Wording(
    turn="which no behaviour of a helm does",
    heading="where a helm looks ahead",
    object="which a helm cannot have looked for",
    policy="behaviours of yours",
)


def nodes_of(input: TargetInput) -> dict[str, str]:
    """Return the name of each robot's community, which names its file, too."""
    return file_stems([robot.id for robot in input.program.robots])


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield each thing that behaviour files cannot express, with robot and move."""
    nodes = nodes_of(input)
    for robot in input.program.robots:
        yield from _of_robot(robot, input, nodes)


def _of_robot(robot: RobotProgram, input: TargetInput, nodes: Mapping[str, str]) -> Iterator[str]:
    if robot.home is None:
        yield homeless(robot)
    if unknown := vehicleless(robot, input, VEHICLES):
        yield unknown
        return
    context = context_of(robot, input, VEHICLES)
    if context.flies:
        yield f"robot '{robot.id}': flies, and depths of a helm count down from the water surface"
        return
    variables = variables_for(context, input, nodes)
    yield from of_policies(robot, context, WORDING)
    for index, move in enumerate(robot.moves):
        for why in _of_move(move, context, variables):
            yield f"{context.label(move)}: {why}"
        transition = robot.transitions.get(index)
        for policy in transition.policies if transition is not None else ():
            yield f"{context.label(move)}: {of_policy(policy, WORDING)}"
    yield from _rings(robot, context)
    for move, why in course_of(context, variables).faults:
        yield f"{context.label(move)}: {why}"


def _of_move(move: Move, context: RobotContext, variables: Variables) -> Iterator[str]:
    yield from of_movement(move, context, WORDING)
    for action in (*move.before, *move.after):
        posts = posts_of(action, context.type, variables)
        if isinstance(posts, str):
            yield posts


def _rings(robot: RobotProgram, context: RobotContext) -> Iterator[str]:
    """Yield which moves lead back to one from which they come."""
    ways, place = successors(robot), {move: number for number, move in enumerate(in_order(robot))}
    for index, number in place.items():
        for way in ways[index]:
            if place[way] <= number:
                again = robot.moves[way].id
                yield f"{context.label(robot.moves[index])}: '{again}' comes round again, which no helm does"


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
    tried_with="sub",
)
