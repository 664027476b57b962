"""What protects a vehicle beside its program: fence, places for emergencies, policies."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import inf

from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.behaviour.policies import AFTER, in_precedence
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.rules import robot_kind_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.geometry.clearance import shrink
from mmrs_core.scene import (
    Area,
    AreaUse,
    Point,
    Policy,
    Position,
    RobotType,
)


def areas_of(robot: RobotProgram, input: TargetInput) -> tuple[Area, ...]:
    """Return the areas that concern a robot."""
    return tuple(area for area in input.areas if area.concerns(robot.type_name))


def refuges(areas: Iterable[Area], clearance: float) -> tuple[Point, ...]:
    """Return a point in each emergency area that keeps its distance to the edge, where there is one."""
    points = (
        _inside(shrink(area.shell, area.safety_distance + clearance))
        for area in areas
        if area.use is AreaUse.EMERGENCY
    )
    return tuple(point for point in points if point is not None)


def clearance_of(type: RobotType | None, position_error: float) -> float:
    """Return the metres that a robot needs on every side; the safety distance of areas comes on top."""
    return position_error + (type.half_diagonal if type is not None else 0.0)


def escape_from(
    position: Position, points: Sequence[Point], areas: Iterable[Area], clearance: float
) -> Position | None:
    """Return the nearest of the points that a level, straight leg reaches safely; None if none does."""
    obstacles = [
        (Polygon(area.shell), area.safety_distance + clearance)
        for area in areas
        if area.use is not AreaUse.EMERGENCY and _matters(area, position[2], clearance)
    ]
    here = (position[0], position[1])
    for point in sorted(points, key=lambda p: (p[0] - here[0]) ** 2 + (p[1] - here[1]) ** 2):
        leg = LineString([here, point])
        if all(leg.distance(shape) >= kept for shape, kept in obstacles):
            return (*point, position[2])
    return None


def policies_of(robot: RobotProgram, input: TargetInput) -> tuple[Policy, ...]:
    """Return one policy for each event: the robot's (which hold the mission's), the type's, or the kind's.

    Those of single waits go before all of them and stay with their transitions.
    """
    type = input.types.get(robot.type_name)
    kind = robot_kind_of(type, input.robot_kinds) if type is not None else None
    of_type, of_kind = type.policies if type else (), kind.policies if kind else {}
    found: dict[str, Policy] = {}
    for policy in in_precedence((), robot.policies, of_type, of_kind):
        found.setdefault(policy.event, explicit(policy))
    return tuple(found.values())


def explicit(policy: Policy) -> Policy:
    """Return the policy with the seconds that the fault must last, where there are any."""
    after = AFTER.get(policy.event) if policy.after is None else policy.after
    return replace(policy, after=None if after == inf else after)


def _matters(area: Area, height: float, clearance: float) -> bool:
    return area.low - area.safety_distance - clearance <= height


def _inside(shape: BaseGeometry) -> Point | None:
    parts = [part for part in getattr(shape, "geoms", [shape]) if not part.is_empty]
    if not parts:
        return None
    point = max(parts, key=lambda part: float(part.area)).representative_point()
    return (float(point.x), float(point.y))
