"""The figures that limits follow from, taken from the robot types themselves.

What the planner computed from the same models is not looked at, but both believe the same
contributions: of a robot kind's kinematics speeds, limits of height and the turning radius are used
here, of move kinds their paths and durations. Lifetime, energy and dimensions are computed here.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt
from typing import cast

from mmrs_core.behaviour.as_scene import scene_of
from mmrs_core.behaviour.program import Action, Move, RobotProgram
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.rules import MoveKind, RobotKind, most_specific, robot_kind_of
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Capability, Kinematics, Part, Position, RobotType


class MissingFigureError(Exception):
    """A figure that a check needs is unknown; the message names it, the culprit first."""


def type_of(input: CheckInput, robot: RobotProgram) -> RobotType:
    """Return the robot's type.

    Raises:
        MissingFigureError: that type is not described.
    """
    try:
        return input.types[robot.type_name]
    except KeyError:
        raise MissingFigureError(f"{robot.id}: robot type '{robot.type_name}' is not described") from None


def home_of(robot: RobotProgram) -> Position:
    """Return where the robot is at the beginning.

    Raises:
        MissingFigureError: the behaviour does not say.
    """
    if robot.home is None:
        raise MissingFigureError(f"{robot.id}: its home is not given")
    return robot.home


def capability_of(input: CheckInput, robot: RobotProgram) -> Capability:
    """Return the figures for the smallest listed payload that is not under the robot's own.

    Raises:
        MissingFigureError: no figures hold for so much payload.
    """
    listed = type_of(input, robot).capabilities
    enough = [capability for capability in listed if capability.payload >= robot.payload]
    if not enough:
        raise MissingFigureError(
            f"{robot.id}: robot type '{robot.type_name}' has no movement capability"
            f" for a payload of {robot.payload:g} kg"
        )
    return min(enough, key=lambda capability: capability.payload)


def half_diagonal_of(robot_type: RobotType) -> float:
    """Return half the diagonal of the robot's outer dimensions, metres.

    It is computed from the dimensions, where the type holds them.
    """
    size = robot_type.part.attributes.get("size")
    if not isinstance(size, Part):
        return robot_type.half_diagonal
    sides = [size.attributes.get(name) for name in ("width", "length", "height")]
    squares = [float(side) ** 2 for side in sides if isinstance(side, int | float)]
    return sqrt(sum(squares)) / 2 if len(squares) == 3 else robot_type.half_diagonal


def kind_of(input: CheckInput, robot: RobotProgram) -> RobotKind:
    """Return the kind of the robot.

    Raises:
        MissingFigureError: no plug-in provides a robot kind for that type.
    """
    kind = robot_kind_of(type_of(input, robot), input.robot_kinds)
    if kind is None:
        raise MissingFigureError(f"{robot.id}: no plug-in provides a robot kind for type '{robot.type_name}'")
    return kind


def kinematics_of(input: CheckInput, robot: RobotProgram) -> Kinematics:
    """Return the speeds and altitude limits that the robot's kind gives; it is asked once.

    Raises:
        MissingFigureError: the kind is unknown, or lacks a figure itself.
    """
    known = cast(dict[str, Kinematics], input.shared.setdefault(kinematics_of, {}))
    if robot.id not in known:
        known[robot.id] = _kinematics(input, robot)
    return known[robot.id]


def _kinematics(input: CheckInput, robot: RobotProgram) -> Kinematics:
    kind, home = kind_of(input, robot), home_of(robot)
    alone = replace(input.program, robots=(replace(robot, home=home),))
    scene = scene_of(
        alone, input.types, areas=input.areas or (), environment=input.environment, elements=input.elements
    )
    try:
        return kind.kinematics(scene.robots[0], scene)
    except InfeasibleError as error:
        raise MissingFigureError(f"{robot.id}: {error}") from None


def move_kind_of(input: CheckInput, move: Move) -> MoveKind | None:
    """Return the kind of a move; None where no plug-in provides it."""
    name = most_specific(move.metaclasses, input.move_kinds)
    return input.move_kinds[name] if name else None


def seconds_of(action: Action, robot_type: RobotType) -> float | None:
    """Return how long an action takes: nothing unless a device acts; None where the type does not say."""
    if not action.device:
        return 0.0
    device = robot_type.devices.get(action.device)
    found = device.actions.get(action.name) if device else None
    return found.duration if found else None
