"""What targets for vehicles of these classes know of one robot."""

from __future__ import annotations

from dataclasses import dataclass, field

from mmrs_core.behaviour.program import Action, RobotProgram
from mmrs_core.contributions.rules import Medium
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.context import RobotContext
from mmrs_core.scene import Position
from mmrs_mavlink.plugin.vehicles import ROVER, VehicleClass, uncarried, vehicle_class
from mmrs_mavlink.plugin.wiring import wiring_of
from mmrs_mavlink.wiring import Wiring, Wirings


@dataclass(frozen=True)
class VehicleContext(RobotContext):
    """One robot of a behaviour, and which vehicle carries it.

    Attributes:
        wirings: those of plug-ins.
    """

    vehicle: VehicleClass = ROVER
    wirings: Wirings = field(default_factory=dict)

    def wiring(self, action: Action) -> Wiring:
        """Return how a device action of the robot is carried out."""
        return wiring_of(action, self.type, self.wirings)


def context_of(robot: RobotProgram, input: TargetInput) -> VehicleContext:
    """Return what there is to know of a robot.

    Raises:
        UnsupportedError: no vehicle carries the robot.
    """
    type = input.types.get(robot.type_name)
    vehicle = vehicle_class(robot, type, input.robot_kinds)
    if vehicle is None:
        raise UnsupportedError(vehicleless(robot, input))
    frame = input.program.frame
    home = robot.home[2] if robot.home is not None else 0.0
    zero = frame.surface if vehicle.dives else home
    medium: Medium = "air" if vehicle.flies else "water" if vehicle.dives else "ground"
    return VehicleContext(
        robot, type, frame, zero, medium, vehicle, input.extensions.get("device_actions", {})
    )


def vehicleless(robot: RobotProgram, input: TargetInput) -> str:
    """Return why no vehicle carries a robot; empty where one does."""
    return uncarried(robot.id, input.types.get(robot.type_name), input.robot_kinds)


def neighbours_of(robot: RobotProgram, input: TargetInput) -> tuple[tuple[str, Position], ...]:
    """Return the homes on the Earth of other robots with vehicles of the same kind, by robot."""
    if input.program.frame.is_local:
        return ()
    kinds = {
        each.id: vehicle_class(each, input.types.get(each.type_name), input.robot_kinds)
        for each in input.program.robots
    }
    return tuple(
        (each.id, each.home)
        for each in input.program.robots
        if each.id != robot.id and each.home is not None and kinds[each.id] == kinds[robot.id]
    )
