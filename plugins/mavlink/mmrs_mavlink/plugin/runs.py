"""Finds moves that a vehicle can fly in one go, as an uploaded mission."""

from __future__ import annotations

from dataclasses import dataclass

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions import passages
from mmrs_core.contributions.passages import Passages
from mmrs_core.scene import Kinematics
from mmrs_core.scene.passing import goes_straight
from mmrs_mavlink.plugin.context import VehicleContext

CORNER_SECONDS = 1.0
"""Hold at corners. Measured on ArduCopter 4.7-dev in simulation, at cruise speed: a waypoint without a
hold was passed at 1.65 to 1.69 m, one with a hold of a second at 0.02 to 0.07 m. No test repeats this:
our own simulated vehicle cuts corners within a radius that it was given for that."""


@dataclass(frozen=True, slots=True)
class MoveRun:
    """A run: indices of its moves, and seconds to hold at the end of each."""

    moves: tuple[int, ...]
    holds: tuple[float, ...]


def runs_of(context: VehicleContext, kinematics: Kinematics | None) -> tuple[MoveRun, ...]:
    """Return the robot's runs, in the order of their first moves; none for a local behaviour.

    A vehicle that needs room to turn holds at the end of a run alone: where it stood in a corner, it could
    not turn to the next leg.

    Args:
        context: of the robot.
        kinematics: of the robot; None: not known.
    """
    if context.frame.is_local:
        return ()
    robot, type, moves = context.robot, context.type, context.moves
    if kinematics is None or kinematics.mission is None:
        found = passages.runs_of(robot, type, moves)
    else:
        found = Passages(robot, type, moves, kinematics, local=False).runs
    if kinematics is not None and kinematics.turning_radius > 0.0:
        return tuple(MoveRun(moves, (*(0.0 for _ in moves[1:]), CORNER_SECONDS)) for moves in found)
    return tuple(MoveRun(moves, _holds(context.robot, moves)) for moves in found)


def _holds(robot: RobotProgram, moves: tuple[int, ...]) -> tuple[float, ...]:
    places = [target.position for move in moves if (target := robot.moves[move].target)]
    holds = [CORNER_SECONDS] * len(places)
    for index in range(1, len(places) - 1):
        before, here, after = places[index - 1 : index + 2]
        assert before is not None
        assert here is not None
        assert after is not None
        if goes_straight(before, here, after):
            holds[index] = 0.0
    return tuple(holds)
