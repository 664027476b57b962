"""Speeds and margins of travel modes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mmrs_core.scene import Capability, RobotType, TravelMode

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Move, RobotProgram

SHARE_OF_LARGEST_SPEED: Mapping[str, float] = {"SAFE": 0.5, "NORMAL": 0.75, "AGGRESSIVE": 1.0}
"""Share of the largest speed at which a robot travels by default, by travel mode."""


@dataclass(frozen=True, slots=True)
class TravelMargins:
    """Distances that robots keep in a travel mode.

    Attributes:
        acceptance: metres from a place at which it counts as reached, where the mission's position
            error covers them; never less than `NEAREST`.
        radius: metres within which the vehicle itself counts the places of a run as passed, at most.
        margin: metres that the vehicle keeps from what it perceives itself, at least; 0: its owner's.
    """

    acceptance: float
    radius: float
    margin: float


NEAREST = 0.5
"""Metres at which a place counts as reached, whatever the position error."""

TRAVEL_MARGINS: Mapping[str, TravelMargins] = {
    "SAFE": TravelMargins(NEAREST, 1.0, 4.0),
    "NORMAL": TravelMargins(NEAREST, 2.0, 2.0),
    "AGGRESSIVE": TravelMargins(1.0, 2.0, 0.0),
}


def capability_of(robot: RobotProgram, type: RobotType) -> Capability | None:
    """Return how the robot moves with its payload: by the lightest listed one that is not lighter."""
    return next((each for each in type.capabilities if each.payload >= robot.payload), None)


def cruise_of(robot: RobotProgram, type: RobotType | None) -> float | None:
    """Return the default speed of a robot in metres per second; None where it is unknown."""
    capability = capability_of(robot, type) if type is not None else None
    if capability is None:
        return None
    slowest, fastest = capability.speed
    return max(slowest, SHARE_OF_LARGEST_SPEED[robot.travel_mode] * fastest)


def speed_of(move: Move, robot: RobotProgram, type: RobotType | None) -> float | None:
    """Return the commanded speed of a move in metres per second; None where it is unknown."""
    return cruise_of(robot, type) if move.speed is None else move.speed


def travel_margins_of(robot: RobotProgram, position_error: float) -> TravelMargins:
    """Return how carefully a robot travels; it goes no nearer past corners than its clearance covers."""
    acceptance = accepted(robot.travel_mode, position_error)
    return replace(TRAVEL_MARGINS[robot.travel_mode], acceptance=acceptance)


def accepted(mode: TravelMode, position_error: float) -> float:
    """Return at how many metres a place counts as reached."""
    return max(NEAREST, min(TRAVEL_MARGINS[mode].acceptance, position_error))
