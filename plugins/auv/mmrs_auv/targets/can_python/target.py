"""The target can-python: a controller for each vehicle, which needs nothing of this project.

A controller is a program in the words of the runtime that all controllers share, on a vehicle whose goals
go over its CAN bus. It carries wheels of that runtime, and of what it needs to speak to the vehicle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from typing import Any

from auv_vessel.sheet import Sheet, to_json
from mmrs_auv.sayable import Bus, parameter_of
from mmrs_auv.sheets import is_vehicle, sheet_of
from mmrs_auv.targets.can_python.capabilities import CAPABILITIES
from mmrs_auv.targets.places import templates_of
from mmrs_core.behaviour.program import Action, RobotProgram
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput
from mmrs_core.contributions.wiring import DeviceWiring, Unwired, Wired, Wiring
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.deployment import deployment_of
from mmrs_core.generation.escaping import Call, file_stems
from mmrs_core.scene import Device, Policy, RobotType
from mmrs_mavlink.plugin.actions import action_losses
from mmrs_mavlink.plugin.context import RobotContext, context_of, homeless, require_home, vehicleless
from mmrs_mavlink.plugin.controllers import carried, fleet_files
from mmrs_mavlink.plugin.movements import losses_of
from mmrs_mavlink.plugin.naming import with_names
from mmrs_mavlink.plugin.program import RobotView, robot_view, trace_of
from mmrs_mavlink.plugin.safety import policies_of
from mmrs_runtime.controllers.words import Robot

WIRED = "can.device"
"""A property that devices get here: their number on the bus, from 1 on."""

NO_VEHICLE = "no robot is an underwater vehicle"
FINDING_ITS_WAY = frozenset({"RETURN", "EMERGENCY_AREA"})


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield a controller and a sheet for each robot, the fleet, and all that they need.

    Raises:
        UnsupportedError: no robot is an underwater vehicle, or one of these has no home or unknown data.
    """
    local = _local(input)
    robots = tuple(robot for robot in local.program.robots if _is_vehicle(robot, input))
    if not robots:
        raise UnsupportedError(NO_VEHICLE, (NO_VEHICLE,))
    stems = file_stems([robot.id for robot in robots], hyphens=False)
    modules = [f"robot_{stems[robot.id]}" for robot in robots]
    for robot, module in zip(robots, modules, strict=True):
        sheet = to_json(_sheet(robot, input))
        said = _said(with_names(robot_view(robot, local, input.program.fingerprint)))
        view = {"robot": said, "sheet": f"{module}.json"}
        yield FileSpec(f"{module}.json", "", data=sheet.encode())
        yield FileSpec(f"{module}.py", "robot.py.jinja", view, trace=trace_of(robot))
    needs = deployment_of(*carried(len(robots))[:1], "auv-vessel")
    yield from fleet_files(replace(local.program, robots=robots), modules, needs)


def _said(view: RobotView) -> RobotView:
    """Return a robot in the words of vehicles on CAN buses."""
    known = {each.name for each in fields(Robot)}
    steps = tuple(replace(step, call=_in_words(step.call)) for step in view.steps)
    return replace(
        view,
        head=tuple(each for each in view.head if each[0] in known),
        steps=steps,
        words=tuple(word for word in view.words if word != "Travel"),
    )


def _in_words(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(_in_words(each) for each in value)
    if not isinstance(value, Call):
        return value
    positional = _in_words(value.positional)
    if value.function == "Operate":
        device, action, _, (number, parameter), seconds = positional
        positional = (device, action, int(number), parameter, seconds)
    return Call(value.function, positional, _in_words(value.named))


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield what no controller of a vehicle on a CAN bus can do."""
    local = _local(input)
    for robot in local.program.robots:
        if not _is_vehicle(robot, input):
            why = vehicleless(robot, input) or f"robot '{robot.id}': is no underwater vehicle"
            yield f"{why}: --allow-lossy leaves it out beside others"
            continue
        if robot.home is None:
            yield homeless(robot)
        try:
            sheet = _sheet(robot, input)
        except UnsupportedError as error:
            yield from (f"robot '{robot.id}': {each}" for each in error.elements or (str(error),))
        else:
            yield from _unsayable(robot, sheet, local)
        yield from _refused(robot, local)


def _is_vehicle(robot: RobotProgram, input: TargetInput) -> bool:
    type = input.types.get(robot.type_name)
    return type is not None and is_vehicle(type) and not vehicleless(robot, input)


def _refused(robot: RobotProgram, input: TargetInput) -> Iterator[str]:
    context = context_of(robot, input, geographic=False)
    for policy in policies_of(robot, input):
        yield from _impossible(policy, f"robot '{robot.id}'")
    for index, move in enumerate(robot.moves):
        yield from losses_of(move, context)
        yield from action_losses(move, context)
        transition = robot.transitions.get(index)
        for policy in transition.policies if transition is not None else ():
            yield from _impossible(policy, _label(context, index))


def _unsayable(robot: RobotProgram, sheet: Sheet, input: TargetInput) -> Iterator[str]:
    bus, context = Bus(sheet, input.program.frame.surface), context_of(robot, input, geographic=False)
    for move in robot.moves:
        yield from (f"{context.label(move)}: {each}" for each in bus.refused(move))


def _label(context: RobotContext, index: int) -> str:
    return context.label(context.robot.moves[index])


def _impossible(policy: Policy, where: str) -> Iterator[str]:
    if policy.response == "EMERGENCY_AREA":
        yield f"{where}: policy {policy.event}: no controller on a CAN bus knows a way to an emergency area"
    elif policy.event == "POSITION_LOST" and policy.response in FINDING_ITS_WAY:
        blind = f"nobody can answer it by {policy.response} without its position"
        yield f"{where}: policy {policy.event}: {blind}"


def _local(input: TargetInput) -> TargetInput:
    """Return the input in metres, with devices wired to the bus."""
    frame = replace(input.program.frame, latitude=None, longitude=None)
    types = {name: _wired(type) for name, type in input.types.items()}
    wirings = {WIRED: DeviceWiring(WIRED, "a command on the vehicle's bus", _command)}
    program = replace(input.program, frame=frame)
    return replace(input, program=program, types=types, device_actions=wirings)


def _wired(type: RobotType) -> RobotType:
    devices = {
        id: replace(device, properties={WIRED: str(number), **_mounted(device)})
        for number, (id, device) in enumerate(type.devices.items(), start=1)
    }
    return replace(type, devices=devices)


def _mounted(device: Device) -> dict[str, str]:
    return {key: value for key, value in device.properties.items() if key.startswith("mount.")}


def _command(action: Action, device: Device) -> Wiring:
    if action.name not in device.actions:
        return Unwired(f"device {device.id!r} does not support {action.name!r}")
    number = list(device.actions).index(action.name)
    return Wired(int(device.properties[WIRED]), (float(number), parameter_of(action)), 0.0)


def _sheet(robot: RobotProgram, input: TargetInput) -> Sheet:
    type = input.types.get(robot.type_name)
    if type is None:
        raise UnsupportedError(f"robot '{robot.id}': type '{robot.type_name}' is not known")
    return sheet_of(
        type,
        robot.id,
        home=require_home(robot),
        surface=input.program.frame.surface,
        payload=robot.payload,
        density=input.environment.get("waterDensity"),
    )


CAN_PYTHON = Target(
    name="can-python",
    description="standalone controllers of underwater vehicles on CAN buses, and one for the whole fleet",
    templates=templates_of("can-python"),
    files=files,
    refusals=refusals,
    capabilities=CAPABILITIES,
    tried_with="sub",
)
