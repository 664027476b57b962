"""What targets for MAVLink know of one robot, gathered once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mmrs_core.behaviour.program import Action, Move, RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.wiring import Wiring, Wirings
from mmrs_core.errors import UnsupportedError
from mmrs_core.mavlink.earth import degrees_of, metres
from mmrs_core.mavlink.vehicles import VehicleClass, speed_of, uncarried, vehicle_class
from mmrs_core.mavlink.wiring import wiring_of
from mmrs_core.scene import Frame, Point, Position, RobotType


@dataclass(frozen=True, slots=True)
class RobotContext:
    """One robot of a behaviour, and where it is.

    Attributes:
        type: None where it was not given.
        zero: height of the robot's own zero above the origin, metres: its home, or the water surface.
        degrees: latitude and longitude by (east, north); empty for local behaviours.
        wirings: those of plug-ins.
    """

    robot: RobotProgram
    type: RobotType | None
    vehicle: VehicleClass
    frame: Frame
    zero: float
    degrees: Mapping[Point, tuple[float, float]]
    wirings: Wirings

    def wiring(self, action: Action) -> Wiring:
        """Return how a device action of the robot is carried out."""
        return wiring_of(action, self.type, self.wirings)

    def height(self, position: Position) -> float:
        """Return a position's height above the robot's own zero, metres."""
        return metres(position[2] - self.zero)

    def speed(self, move: Move) -> float | None:
        """Return a move's commanded speed in metres per second; None where it is not known."""
        found = speed_of(move, self.robot, self.type)
        return None if found is None else metres(found)

    def label(self, move: Move) -> str:
        """Return how messages name a move of the robot."""
        return f"robot '{self.robot.id}', move '{move.id}'"


def context_of(
    robot: RobotProgram, input: TargetInput, more: Sequence[Point] = (), *, geographic: bool
) -> RobotContext:
    """Return what there is to know of a robot.

    Args:
        robot: of the input's behaviour.
        input: the behaviour and what goes with it.
        more: further (east, north) points whose degrees are needed.
        geographic: whether degrees are needed at all.

    Raises:
        UnsupportedError: degrees are needed, and the behaviour is local; or no vehicle carries the robot.
    """
    type = input.types.get(robot.type_name)
    vehicle = vehicle_class(robot, type, input.robot_kinds)
    if vehicle is None:
        raise UnsupportedError(vehicleless(robot, input))
    points = tuple(dict.fromkeys([*_points(robot), *more])) if geographic else ()
    frame = input.program.frame
    home = robot.home[2] if robot.home is not None else 0.0
    zero = frame.surface if vehicle.dives else home
    degrees = dict(zip(points, degrees_of(points, frame), strict=True)) if geographic else {}
    return RobotContext(robot, type, vehicle, frame, zero, degrees, input.device_actions)


def vehicleless(robot: RobotProgram, input: TargetInput) -> str:
    """Return why no vehicle carries a robot; empty where one does."""
    return uncarried(robot.id, input.types.get(robot.type_name), input.robot_kinds)


def homeless(robot: RobotProgram) -> str:
    """Return what there is to say of a robot without a home."""
    return f"robot '{robot.id}': its home is not known, and heights count from there"


def require_home(robot: RobotProgram) -> Position:
    """Return a robot's home.

    Raises:
        UnsupportedError: it has none.
    """
    if robot.home is None:
        raise UnsupportedError(homeless(robot))
    return robot.home


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


def _points(robot: RobotProgram) -> list[Point]:
    positions = [robot.home]
    for move in robot.moves:
        positions.append(move.target.position if move.target else None)
        positions.append(move.heading.target.position if move.heading else None)
    return [(position[0], position[1]) for position in positions if position is not None]
