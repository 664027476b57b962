"""The target mavlink-python: standalone controllers on top of pymavlink."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_core.generation.deployment import Deployment, deployment_of
from mmrs_core.generation.escaping import file_stems
from mmrs_core.mavlink.earth import at_a_pole, degrees_of
from mmrs_core.mavlink.vehicles import PX4, autopilot_of
from mmrs_core.scene import Policy
from mmrs_mavlink.options import FIRST_PORT, PORT_STEP
from mmrs_mavlink.plugin.actions import action_losses
from mmrs_mavlink.plugin.capabilities import OF_CONTROLLERS
from mmrs_mavlink.plugin.context import RobotContext, context_of, homeless, require_home, vehicleless
from mmrs_mavlink.plugin.fencing import fence_faults
from mmrs_mavlink.plugin.movements import losses_of
from mmrs_mavlink.plugin.naming import command_name, with_names
from mmrs_mavlink.plugin.places import templates_of
from mmrs_mavlink.plugin.program import deciding, robot_view, seeking, trace_of
from mmrs_mavlink.plugin.safety import areas_of, policies_of
from mmrs_runtime.conditions import is_standard

FINDING_ITS_WAY = frozenset({"RETURN", "EMERGENCY_AREA"})


@dataclass(frozen=True, slots=True)
class ModuleView:
    """The module of one robot's controller as the templates see it."""

    name: str
    robot: str
    trace: TracedStep


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield one controller a robot, the fleet, the conditions where there are any, and what they need.

    Raises:
        UnsupportedError: a robot has no home.
    """
    robots = input.program.robots
    for robot in robots:
        require_home(robot)
    stems = file_stems([robot.id for robot in robots], hyphens=False)
    modules = [f"robot_{stems[robot.id]}" for robot in robots]
    for robot, module in zip(robots, modules, strict=True):
        view = {"robot": with_names(robot_view(robot, input), command_name)}
        yield FileSpec(f"{module}.py", "robot.py.jinja", view, trace=trace_of(robot))
    needs = deployment_of(*carried(len(robots)))
    yield from fleet_files(input.program, modules, needs, tuple(_rehearsal(input)))


def carried(robots: int) -> tuple[str, ...]:
    """Return the distributions that controllers of so many robots carry: one alone meets nobody on a bus."""
    bus, driver = ("mmrs-runtime[bus]" if robots > 1 else "mmrs-runtime"), "mmrs-mavlink"
    return bus, driver


def _rehearsal(input: TargetInput) -> Iterator[str]:
    """Yield the arguments of a simulated vehicle for each robot: where its controller expects one.

    A local behaviour has no place on the Earth, and its robots count from wherever their vehicles are.
    """
    frame = input.program.frame
    for number, robot in enumerate(input.program.robots):
        context = context_of(robot, input, geographic=False)
        given = (
            f"--port {FIRST_PORT + PORT_STEP * number} --system {number + 1} --kind {context.vehicle.name}"
        )
        if autopilot_of(context.type) == PX4:
            given += f" --firmware {PX4}"
        if not frame.is_local:
            ((latitude, longitude),) = degrees_of([require_home(robot)[:2]], frame)
            given += f" --home={latitude:.7f},{longitude:.7f}"
        yield given


def fleet_files(
    program: Program, modules: Sequence[str], needs: Deployment, rehearsal: Sequence[str] = ()
) -> Iterator[FileSpec]:
    """Yield what controllers of a mission share: fleet, README, needs, and what people are asked for.

    Args:
        program: of the mission.
        modules: names of the controllers, in the order of its robots.
        needs: what has to be installed where they run.
        rehearsal: arguments of the simulated vehicle of each robot.
    """
    conditions, objects = deciding(program), seeking(program)
    common = {
        "mission": program.name,
        "modules": [
            ModuleView(module, robot.id, TracedStep("controller", robot.id, ""))
            for module, robot in zip(modules, program.robots, strict=True)
        ],
        "conditions": conditions,
        "standard_conditions": [name for name in conditions if is_standard(name)],
        "own_conditions": [name for name in conditions if not is_standard(name)],
        "objects": objects,
        "rehearsal": rehearsal,
        "local": program.frame.is_local,
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
    yield from needs.files(program.name, modules)


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield what no controller can do."""
    yield from at_a_pole(input.program.frame)
    for robot in input.program.robots:
        if unknown := vehicleless(robot, input):
            yield unknown
            continue
        yield from _refused(robot, input)


def _refused(robot: RobotProgram, input: TargetInput) -> Iterator[str]:
    if robot.home is None:
        yield homeless(robot)
    if not input.program.frame.is_local:
        yield from fence_faults(robot, areas_of(robot, input))
    context = context_of(robot, input, geographic=False)
    for policy in policies_of(robot, input):
        yield from _impossible(policy, f"robot '{robot.id}'", context)
    for index, move in enumerate(robot.moves):
        yield from losses_of(move, context)
        yield from action_losses(move, context)
        transition = robot.transitions.get(index)
        for policy in transition.policies if transition is not None else ():
            yield from _impossible(policy, context.label(move), context)


def _impossible(policy: Policy, where: str, context: RobotContext) -> Iterator[str]:
    """Yield what a vehicle is to do when something goes wrong, and cannot do, or not by itself."""
    vehicle, event, response = context.vehicle, policy.event, policy.response
    if event == "LINK_LOST" and response not in vehicle.alone:
        yield f"{where}: policy {event}: no {vehicle.name} does {response} by itself"
    elif response not in vehicle.responses:
        yield f"{where}: policy {event}: no {vehicle.name} can answer it by {response}"
    elif event == "POSITION_LOST" and response in FINDING_ITS_WAY:
        yield f"{where}: policy {event}: without its position, nobody can answer it by {response}"


MAVLINK_PYTHON = Target(
    name="mavlink-python",
    description="standalone pymavlink controllers, one for each robot and one for the whole fleet",
    templates=templates_of("mavlink-python"),
    files=files,
    refusals=refusals,
    capabilities=OF_CONTROLLERS,
)
