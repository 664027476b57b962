"""What a robot keeps from, how far, and what it does when something goes wrong."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.behaviour.rally_points import rally_points_of
from mmrs_core.contributions.rules import RobotKind, robot_kind_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import Area, AreaUse, Name, Point, Policy, RobotType
from mmrs_runtime.policies import AFTER, ESCAPE, in_precedence


def areas_of(robot: RobotProgram, input: TargetInput) -> tuple[Area, ...]:
    """Return the areas that concern a robot."""
    return tuple(area for area in input.areas if area.concerns(robot.type_name))


def clearance_of(type: RobotType | None, position_error: float) -> float:
    """Return the metres that a robot needs on every side; the safety distance of areas comes on top."""
    return position_error + (type.half_diagonal if type is not None else 0.0)


def policies_of(robot: RobotProgram, input: TargetInput) -> tuple[Policy, ...]:
    """Return one policy for each event: the robot's (which hold the mission's), the type's, or the kind's.

    Those of single waits go before all of them and stay with their transitions.
    """
    return effective_policies(robot, input.types.get(robot.type_name), input.robot_kinds)


def effective_policies(
    robot: RobotProgram, type: RobotType | None, kinds: Mapping[Name, RobotKind]
) -> tuple[Policy, ...]:
    """Return the same for a robot of a type, None: unknown, and robot kinds by metaclass."""
    kind = robot_kind_of(type, kinds) if type is not None else None
    of_type, of_kind = type.policies if type else (), kind.policies if kind else {}
    found: dict[str, Policy] = {}
    for policy in in_precedence((), robot.policies, of_type, of_kind):
        found.setdefault(policy.event, explicit(policy))
    return tuple(found.values())


def rally_points_by_policy(
    program: Program, types: Mapping[str, RobotType], kinds: Mapping[Name, RobotKind], areas: tuple[Area, ...]
) -> tuple[dict[str, tuple[Point, ...]], dict[str, tuple[Point, ...]]]:
    """Return the rally points of the robots that a policy may lead to an emergency area, by robot.

    Then, likewise, those of other robots that emergency areas are drawn for.
    """
    asked, unasked = dict[str, tuple[Point, ...]](), dict[str, tuple[Point, ...]]()
    drawn = [area for area in areas if area.use is AreaUse.EMERGENCY]
    for robot in program.robots:
        everywhere = effective_policies(robot, types.get(robot.type_name), kinds)
        policies = [*everywhere, *(each for t in robot.transitions.values() for each in t.policies)]
        if any(each.response == ESCAPE for each in policies):
            asked[robot.id] = rally_points_of(robot, program, types, areas).points
        elif any(area.concerns(robot.type_name) for area in drawn):
            unasked[robot.id] = rally_points_of(robot, program, types, areas).points
    return asked, unasked


def explicit(policy: Policy) -> Policy:
    """Return the policy with the seconds that the fault must last, where there are any."""
    after = AFTER.get(policy.event) if policy.after is None else policy.after
    return replace(policy, after=None if after == inf else after)
