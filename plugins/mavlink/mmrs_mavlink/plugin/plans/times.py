"""How long vehicles take for their missions, and whether their batteries last for that."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import inf

from mmrs_core.behaviour.program import BEHAVIOUR, RobotProgram
from mmrs_core.behaviour.travel import capability_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.timing import as_uploaded
from mmrs_core.generation.planned_moves import kinematics_of, planned_moves

RECHARGE = (BEHAVIOUR, "Recharge")


def sortie_seconds(robot: RobotProgram, input: TargetInput) -> tuple[float | None, ...]:
    """Return how long each sortie of a robot takes as a mission, waits aside; None: that is unknown.

    Missions take longer than the same moves one by one, with the holds and the jerk of the autopilot.
    """
    uploaded = replace(input, robot_kinds=as_uploaded(input.robot_kinds))
    sorties: list[float | None] = [0.0]
    for each in planned_moves(robot, uploaded):
        if robot.moves[each.index].is_a(RECHARGE):
            sorties.append(0.0)
            continue
        so_far, seconds = sorties[-1], each.seconds
        sorties[-1] = None if so_far is None or seconds is None else so_far + seconds.expected
    return tuple(sorties)


def too_long(robot: RobotProgram, input: TargetInput) -> Iterator[str]:
    """Yield each sortie that takes longer as a mission than the robot's batteries last, less the reserve."""
    type = input.types.get(robot.type_name)
    capability = capability_of(robot, type) if type is not None else None
    kinematics = kinematics_of(robot, input)
    if capability is None or kinematics is None:
        return
    lasts = (capability.lifetime or inf) * (1.0 - input.program.reserve) / kinematics.draw
    for number, seconds in enumerate(sortie_seconds(robot, input), start=1):
        if seconds is not None and seconds > lasts:
            yield (
                f"robot '{robot.id}': takes {seconds:.0f} s for sortie {number} as a mission; its batteries"
                f" last {lasts:.0f} s less the reserve; 'mmrs run' and controllers are quicker, move by move"
            )
