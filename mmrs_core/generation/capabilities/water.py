"""Probes as an underwater vehicle has them, for targets that are for nothing that flies."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core.behaviour.program import BEHAVIOUR, Move, MoveTarget, RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.capabilities.probes import KINDS, MULTICOPTER, Probe, kind_of, move
from mmrs_core.scene import Position

OF_THE_AIR = ("multicopter", "TakeOff", "Land", "GoTo.trajectory", "Robot: a ")
"""Beginnings of names of elements that only flying robots have, or that are about robot kinds."""


def under_water(probe: Probe) -> Probe:
    """Return a probe in which an underwater vehicle goes as deep as the drone went high.

    One about drones, or about another kind of vehicle, stays as it is.
    """
    if probe.element.startswith(OF_THE_AIR) or "copter" in f"{probe.group} {probe.element}":
        return probe
    return replace(probe, given=_dived(probe.given), without=_dived(probe.without))


def _dived(input: TargetInput) -> TargetInput:
    copter, swimmer = KINDS["copter"][0], kind_of("sub")
    types = {
        name: replace(swimmer, devices=type.devices) if type.metaclasses == copter else type
        for name, type in input.types.items()
    }
    robots = tuple(_swimming(robot) for robot in input.program.robots)
    return replace(input, program=replace(input.program, robots=robots), types=types)


def _swimming(robot: RobotProgram) -> RobotProgram:
    return replace(robot, moves=tuple(_swum(each) for each in robot.moves))


def _swum(made: Move) -> Move:
    """Return a move under water; one of the air becomes a hold of no duration, so that numbers stay."""
    uri, kind = made.metaclasses[0]
    if uri != MULTICOPTER:
        return replace(made, target=_below(made.target))
    if kind != "GoTo":
        return move(made.id, "HoldPosition", BEHAVIOUR, duration=0.0)
    return replace(made, metaclasses=made.metaclasses[1:], attributes={}, target=_below(made.target))


def _below(target: MoveTarget | None) -> MoveTarget | None:
    if target is None or target.position is None:
        return target
    east, north, up = target.position
    deep: Position = (east, north, -abs(up))
    return replace(target, position=deep)
