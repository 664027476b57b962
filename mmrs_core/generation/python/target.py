"""Controllers in Python: a program for each robot, one for the fleet, and what they need where they run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from mmrs_core.behaviour.earth import at_a_pole
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.context import RobotContext, homeless, require_home
from mmrs_core.generation.deployment import deployment_of
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.python.driver import PythonDriver
from mmrs_core.generation.python.moves import action_losses, losses_of
from mmrs_core.generation.python.program import deciding, robot_view, seeking, trace_of
from mmrs_core.generation.safety import policies_of
from mmrs_core.scene import Policy
from mmrs_runtime.conditions import is_standard

FINDING_ITS_WAY = frozenset({"RETURN", "EMERGENCY_AREA"})

OF_PROGRAMS: Mapping[str, str] = {
    "Behaviour.name": "in descriptions and messages",
    "Behaviour.minimumSeparation": "is for the planner and the checks",
    "Behaviour.acceptedUnknowns": "is for the checks",
    "Behaviour.idleRobots": "are for the checks; they are not run",
    "Behaviour.reserve": "a battery with no more left is low",
    "Behaviour.robots": "a controller each, and one for the fleet",
    "Robot.id": "name of the controller and of its logs",
    "Robot.slots": "kept by the controller, served to others",
    "Target.name": "is informative",
    "Start, Stop": "beginning and end of the program",
    "GoTo.distance": "the robot stops short of the position",
    "Recharge": "stays until the battery is full, and at least so long",
    "Move.name": "in logs and messages",
    "Move.task": "in logs and comments",
    "Move.rule": "in comments",
    "MoveTransition.fluid": "continues without a stop",
    "MoveTransition.to": "steps in any order",
    "MoveTransition.policies": "before those of the robot",
    "Choice.conditionIdentifier": "a function of yours in conditions.py",
    "Choice by a standard condition": "known to the runtime",
    "UnicastNotify": "acknowledged command to the slot's owner",
    "MulticastNotify": "acknowledged commands to the slots' owners",
    "BroadcastNotify": "acknowledged commands to the slots' owners",
    "Notify.active": "takes the slot back",
    "Move.preActions": "done before the movement",
    "Move.postActions": "done after the movement",
}
"""How programs in Python express elements of behaviours, whatever they drive."""


@dataclass(frozen=True, slots=True)
class ModuleView:
    """The module of one robot's controller as the templates see it."""

    name: str
    robot: str
    trace: TracedStep


def python_target(driver: PythonDriver[Any]) -> Target:
    """Return the target that writes programs for the vehicles of a driver.

    A folder holds a module ``robot_NAME.py`` for each robot, ``fleet.py``, a README, ``requirements.txt``
    with wheels, a systemd unit, and ``conditions.py`` and ``objects.py`` where the robots ask for them.
    """
    return Target(
        name=driver.name,
        description=driver.description,
        templates=driver.templates,
        files=partial(_files, driver=driver),
        refusals=partial(_refusals, driver=driver),
        capabilities={**OF_PROGRAMS, **driver.capabilities},
        tried_with=driver.tried_with,
        wirings=driver.wirings,
    )


def _files(input: TargetInput, driver: PythonDriver[Any]) -> Iterator[FileSpec]:
    """Yield one controller a robot that the driver drives, the fleet, and what they need.

    Raises:
        UnsupportedError: it drives none of them, or a robot has no home.
    """
    unknown = {robot.id: driver.undriven(robot, input) for robot in input.program.robots}
    robots = [robot for robot in input.program.robots if not unknown[robot.id]]
    if not robots:
        raise UnsupportedError(f"{driver.name} drives none of the robots", tuple(unknown.values()))
    for robot in robots:
        require_home(robot)
    stems = file_stems([robot.id for robot in robots], hyphens=False)
    modules = [f"robot_{stems[robot.id]}" for robot in robots]
    for robot, module in zip(robots, modules, strict=True):
        yield from driver.files(module, driver.context(robot, input), input)
        view = {"robot": robot_view(robot, input, driver), "module": driver.module}
        yield FileSpec(f"{module}.py", "robot.py.jinja", view, trace=trace_of(robot))
    yield from _shared(input, robots, modules, driver)


def _shared(
    input: TargetInput, robots: Sequence[RobotProgram], modules: Sequence[str], driver: PythonDriver[Any]
) -> Iterator[FileSpec]:
    """Yield what the controllers share: fleet, README, needs, and what people are asked for."""
    conditions, objects = deciding(robots), seeking(robots)
    alone = len(input.program.robots) == 1  # and meets nobody on a bus
    needs = deployment_of("mmrs-runtime" if alone else "mmrs-runtime[bus]", *driver.requires)
    mission = input.program.name
    common = {
        "mission": mission,
        "module": driver.module,
        "modules": [
            ModuleView(module, robot.id, TracedStep("controller", robot.id, ""))
            for module, robot in zip(modules, robots, strict=True)
        ],
        "conditions": conditions,
        "standard_conditions": [name for name in conditions if is_standard(name)],
        "own_conditions": [name for name in conditions if not is_standard(name)],
        "objects": objects,
        "libraries": needs.libraries,
        "bus": "eclipse-zenoh" in needs.libraries,
    }
    yield FileSpec("fleet.py", "fleet.py.jinja", common)
    yield FileSpec("README.md", "README.md.jinja", common)
    if conditions:
        asks = tuple(f"when '{name}' holds" for name in conditions if not is_standard(name))
        yield FileSpec("conditions.py", "conditions.py.jinja", common, once=True, asks=asks)
    if objects:
        asks = tuple(f"how '{name}' is found" for name in objects)
        yield FileSpec("objects.py", "objects.py.jinja", common, once=True, asks=asks)
    yield from needs.files(mission, modules)


def _refusals(input: TargetInput, driver: PythonDriver[Any]) -> Iterator[str]:
    """Yield what no controller can do."""
    several = len(input.program.robots) > 1
    for robot in input.program.robots:
        if why := driver.undriven(robot, input):
            yield f"{why}: --allow-lossy leaves it out beside others" if several else why
        else:
            yield from _refused(robot, input, driver)


def _refused(robot: RobotProgram, input: TargetInput, driver: PythonDriver[Any]) -> Iterator[str]:
    context = driver.context(robot, input)
    yield from at_a_pole(context.frame)
    if robot.home is None:
        yield homeless(robot)
    yield from driver.refusals(context, input)
    for policy in policies_of(robot, input):
        yield from _unanswerable(policy, f"robot '{robot.id}'", context, driver)
    for index, move in enumerate(robot.moves):
        yield from losses_of(move, context, driver)
        yield from action_losses(move, context, driver)
        transition = robot.transitions.get(index)
        for policy in transition.policies if transition is not None else ():
            yield from _unanswerable(policy, context.label(move), context, driver)


def _unanswerable(
    policy: Policy, where: str, context: RobotContext, driver: PythonDriver[Any]
) -> Iterator[str]:
    """Yield why a vehicle cannot answer an event as it is to."""
    why = driver.unanswerable(policy, context)
    if not why and policy.event == "POSITION_LOST" and policy.response in FINDING_ITS_WAY:
        why = f"without its position, the robot cannot respond with {policy.response}"
    if why:
        yield f"{where}: policy {policy.event}: {why}"
