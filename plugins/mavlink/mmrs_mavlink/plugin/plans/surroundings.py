"""What goes with the missions of a robot: where home is, the geofence, the rally points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from mmrs_core.behaviour.earth import degrees_of, metres, sea_level_of
from mmrs_core.behaviour.program import FEEDBACK, RobotProgram
from mmrs_core.behaviour.rally_points import rally_points_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.context import require_home
from mmrs_core.generation.escaping import file_stems
from mmrs_core.scene import Point
from mmrs_mavlink.limits import Limit, limits_of
from mmrs_mavlink.plugin.context import VehicleContext, context_of
from mmrs_mavlink.plugin.controllers import travel_of
from mmrs_mavlink.plugin.escapes import escapes_of
from mmrs_mavlink.plugin.fencing import fences_of
from mmrs_mavlink.plugin.plans.flight import sorties_of
from mmrs_mavlink.plugin.plans.items import PlanItem, Row, rows_of
from mmrs_mavlink.plugin.plans.times import sortie_seconds
from mmrs_mavlink.program import Travel

Vertex: TypeAlias = tuple[float, float]
"""Latitude and longitude in degrees."""

Spot: TypeAlias = tuple[float, float, float]
"""Latitude, longitude in degrees, height in metres."""


@dataclass(frozen=True, slots=True)
class PlannedMission:
    """One sortie of a robot with the contents of its file.

    Attributes:
        stem: of its file: the robot's, and the sortie's number where it is not the first.
        home: its height is above mean sea level: 0 where that is unknown and losses are allowed;
            vehicles replace it by their own measurement.
        fence: polygons to stay out of.
        rally: heights are above home: the greatest of the sortie, which is above the obstacles along its
            path.
        seconds: expected, waits aside; None where that is unknown.
        limits: what the vehicle must be set to before its first sortie, which no mission does.
    """

    context: VehicleContext
    stem: str
    home: Spot
    rows: tuple[Row, ...]
    fence: tuple[tuple[Vertex, ...], ...]
    rally: tuple[Spot, ...]
    seconds: float | None
    limits: tuple[Limit, ...] = ()

    @property
    def asks(self) -> tuple[str, ...]:
        """Return what to set on the vehicle before it begins, in words."""
        return tuple(f"set {each.name} to {each.value:g} {each.sort}: {each.why}" for each in self.limits)

    @property
    def note(self) -> str:
        """Return how long it takes, where that is known, and whether feedback is left out, in words."""
        actions = (each for move in self.context.robot.moves for each in (*move.before, *move.after))
        silent = any(each.metaclasses[0] == FEEDBACK for each in actions)
        lasts = "" if self.seconds is None else f"{self.seconds:.0f} s as a mission, waits aside"
        return "; ".join(filter(None, (lasts, "sends no feedback" if silent else "")))


def missions_of(input: TargetInput) -> Iterator[PlannedMission]:
    """Yield one mission for each sortie of each robot.

    Raises:
        UnsupportedError: the behaviour is local, or a robot has no home.
    """
    stems = file_stems([robot.id for robot in input.program.robots])
    for robot in input.program.robots:
        context = context_of(robot, input)
        sorties, seconds = sorties_of(context), sortie_seconds(robot, input)
        for number, sortie in enumerate(sorties, start=1):
            suffix = f".sortie-{number}" if number > 1 else ""
            lasts = seconds[number - 1] if len(seconds) == len(sorties) else None
            mission = _mission(context, input, stems[robot.id] + suffix, sortie, lasts)
            yield mission if number > 1 else replace(mission, limits=tuple(_limits(context, input)))


def _mission(
    context: VehicleContext, input: TargetInput, stem: str, sortie: Sequence[PlanItem], seconds: float | None
) -> PlannedMission:
    robot = context.robot
    points = rally_points_of(robot, input.program, input.types, input.areas).points
    return PlannedMission(
        context,
        stem,
        _home(robot, context),
        rows_of(context, sortie),
        tuple(
            degrees_of(fence.ring, context.frame)
            for fence in fences_of(robot, input, escapes_of(robot, input, points))
        ),
        _rally(context, points, sortie),
        seconds,
    )


def _limits(context: VehicleContext, input: TargetInput) -> Iterator[Limit]:
    """Yield what a vehicle must be set to; the radius of a place may stand in its item."""
    profile, how = context.profile, travel_of(context, input)
    for limit in limits_of(profile, Travel(context.robot.travel_mode, **how), how["acceptance"]):
        if limit.value > 0.0 and not (profile.autopilot.missions.zero_counts and limit.name in profile.radii):
            yield limit


def _home(robot: RobotProgram, context: VehicleContext) -> Spot:
    home = require_home(robot)
    # Heights of what dives count from the surface above its home.
    zero = (home[0], home[1], context.zero) if context.dives else home
    ((latitude, longitude),) = degrees_of([(home[0], home[1])], context.frame)
    return (latitude, longitude, sea_level_of(zero, context.frame) or 0.0)


def _rally(context: VehicleContext, points: Sequence[Point], sortie: Sequence[PlanItem]) -> tuple[Spot, ...]:
    highest = max(item.position[2] for item in sortie if item.position is not None)
    up = metres(highest - context.zero)
    return tuple((*degrees, up) for degrees in degrees_of(points, context.frame))
