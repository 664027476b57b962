"""The target can-python: a controller for each vehicle, which needs nothing of this project.

A controller is a program in the words of the runtime that all controllers share, on a vehicle whose goals
go over its CAN bus. It carries wheels of that runtime, and of what it needs to speak to the vehicle.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from auv_vessel.sheet import Sheet, to_json
from mmrs_auv.names import VEHICLES
from mmrs_auv.sayable import Bus, parameter_of, unturnable
from mmrs_auv.sheets import is_vehicle, sheet_of_robot
from mmrs_auv.targets.capabilities import OF_VEHICLES
from mmrs_auv.targets.places import templates_of
from mmrs_core.behaviour.program import Action, Heading, RobotProgram
from mmrs_core.contributions.targets import FileSpec, TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.context import RobotContext, require_home
from mmrs_core.generation.escaping import Call
from mmrs_core.generation.plan_moves import vehicleless
from mmrs_core.generation.python import PythonDriver, python_target
from mmrs_core.scene import Policy

CAPABILITIES: Mapping[str, str] = {
    **OF_VEHICLES,
    "Robot.home": "the vehicle's zero",
    "Robot.payload": "the vehicle's mass; speed, by the capability for it",
    "ObjectTarget": "found by what cameras tell (--detections), or by a function of yours in objects.py",
    "HoldPosition": "the last goal stays in force, timed by the controller",
    "HeadTo.heading": "a goal TURN",
    "Heading.target": "where it is expected, or found by a function of yours in objects.py",
    "MoveTransition.waitFor": "waits for slots, over the bus between robots",
    "Feedback": "printed, and in the black box",
    "LINK_LOST": "the bus is silent; a vehicle whose controller is silent holds, then comes up",
    "PEER_LOST": "the robots that could end a wait are gone",
}


class CanPython(PythonDriver[RobotContext]):
    """How programs in Python drive underwater vehicles on CAN buses: in metres from home."""

    name = "can-python"
    description = "standalone controllers of underwater vehicles on CAN buses, and one for the whole fleet"
    module = "mmrs_auv.controllers"
    requires = ("auv-vessel", "mmrs-auv")
    templates = templates_of("can-python")
    capabilities = CAPABILITIES
    tried_with = "sub"

    def undriven(self, robot: RobotProgram, input: TargetInput) -> str:
        """Return that a robot is not an underwater vehicle."""
        type = input.types.get(robot.type_name)
        if type is not None and is_vehicle(type):
            return vehicleless(robot, input, VEHICLES)
        return vehicleless(robot, input, VEHICLES) or f"robot '{robot.id}': not an underwater vehicle"

    def context(self, robot: RobotProgram, input: TargetInput) -> RobotContext:
        """Return what there is to know of a robot."""
        frame = replace(input.program.frame, latitude=None, longitude=None)
        return RobotContext(robot, input.types.get(robot.type_name), frame, frame.surface, "water")

    def vehicle(self, context: RobotContext) -> str:
        """Return ``sub``."""
        return "sub"

    def device(self, action: Action, context: RobotContext) -> Call | str:
        """Return an action by its number at the device."""
        device = context.type.devices.get(action.device) if context.type is not None else None
        known = device.actions.get(action.name) if device is not None else None
        if device is None or known is None:
            return f"device {action.device!r} does not support {action.name!r}"
        number = list(device.actions).index(action.name)
        given = (number, parameter_of(action), known.duration)
        return Call("Operate", (action.device, action.name, *given))

    def unseen(self, heading: Heading, context: RobotContext) -> Iterable[str]:
        """Return why the vehicle cannot be turned so."""
        return unturnable(heading.device, context.type)

    def unanswerable(self, policy: Policy, context: RobotContext) -> str:
        """Return that no path to an emergency area is known."""
        known = policy.response != "EMERGENCY_AREA"
        return "" if known else "no controller on a CAN bus knows a path to an emergency area"

    def refusals(self, context: RobotContext, input: TargetInput) -> Iterator[str]:
        """Yield what is wrong with the vehicle's data, or more than its bus can say."""
        robot = context.robot
        if robot.home is None:
            return
        try:
            bus = Bus(_sheet(robot, input), context.zero)
        except UnsupportedError as error:
            yield from (f"robot '{robot.id}': {each}" for each in error.elements or (str(error),))
        else:
            for move in robot.moves:
                yield from (f"{context.label(move)}: {each}" for each in bus.refused(move))

    def files(self, module: str, context: RobotContext, input: TargetInput) -> Iterator[FileSpec]:
        """Yield what the vehicle is made of."""
        yield FileSpec(f"{module}.json", "", data=to_json(_sheet(context.robot, input)).encode())


def _sheet(robot: RobotProgram, input: TargetInput) -> Sheet:
    require_home(robot)
    return sheet_of_robot(input.program, robot, input.types[robot.type_name], input.environment)


CAN_PYTHON = python_target(CanPython())
