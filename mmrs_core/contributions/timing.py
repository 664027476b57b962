"""How long vehicles take, by what drives them: plug-ins that know autopilots contribute it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import inf
from typing import TYPE_CHECKING

from mmrs_core.behaviour.travel import accepted
from mmrs_core.contributions.rules import RobotKind

if TYPE_CHECKING:
    from mmrs_core.scene import Capability, Kinematics, Name, Robot, RobotType, Scene
    from mmrs_runtime.timing import AutopilotTiming


@dataclass(frozen=True, slots=True)
class VehicleTiming:
    """How long the autopilots of one class of vehicle take, unless the robot type states it.

    Without it, robots of a kind that names the vehicle take as long as their types' limits demand.

    Attributes:
        vehicle: class of vehicle, as `RobotKind.vehicle` names it; one timing for each.
        of: how long a robot of that type takes, whose autopilot the type may name.
    """

    vehicle: str
    of: Callable[[RobotType], AutopilotTiming]


def as_driven(kind: RobotKind, timing: VehicleTiming | None) -> RobotKind:
    """Return a robot kind whose robots take as long as what drives them does; None: nothing is known."""
    if timing is None:
        return kind
    return replace(kind, kinematics=partial(_kinematics, kind.kinematics, timing))


def as_uploaded(kinds: Mapping[Name, RobotKind]) -> dict[Name, RobotKind]:
    """Return robot kinds whose robots do all that they do as a mission that was uploaded before."""
    return {
        name: replace(kind, kinematics=partial(_uploaded, kind.kinematics)) for name, kind in kinds.items()
    }


def _uploaded(of: Callable[[Robot, Scene], Kinematics], robot: Robot, scene: Scene) -> Kinematics:
    whole = of(robot, scene).in_mission()
    ends = (whole.launch, whole.recovery) if whole.launches else (0.0, 0.0)
    launch, recovery = (max(0.0, each - whole.noticing) for each in ends)
    return replace(whole, mission=None, launch=launch, recovery=recovery, guiding=0.0)


def _kinematics(
    of: Callable[[Robot, Scene], Kinematics], timing: VehicleTiming, robot: Robot, scene: Scene
) -> Kinematics:
    plain, autopilot = of(robot, scene), timing.of(robot.type)
    capability = _capability(robot)
    step = capability.timing("STEP", autopilot.step)
    uploaded = autopilot.mission or (autopilot.step if capability.leg_timings.get("MISSION") else None)
    mission = None if uploaded is None else capability.timing("MISSION", uploaded)
    landing_rate = autopilot.landing_rate if capability.landing_rate is None else capability.landing_rate
    landing_height = (
        autopilot.landing_height if capability.landing_height is None else capability.landing_height
    )
    driven = replace(
        plain,
        climb=step.climb,
        descent=step.descent,
        launch=_first(capability.launch, autopilot.launch, plain.launch),
        recovery=_first(capability.recovery, autopilot.recovery, plain.recovery),
        noticing=autopilot.noticing,
        guiding=autopilot.guiding,
        landing_rate=landing_rate,
        landing_height=landing_height if landing_rate < inf else 0.0,
        rounds=autopilot.rounds,
        accepts=min(step.acceptance, accepted(robot.travel_mode, scene.position_error)),
        turn_rate=min(plain.turn_rate, autopilot.turn_rate),
        charging=autopilot.charging,
        mission=mission,
        upright=autopilot.upright and capability.timing("", autopilot.upright),
    )
    return driven.flown_by(step)


def _capability(robot: Robot) -> Capability:
    """Return the capability for a robot's payload; that there is one, its kinematics needed."""
    return next(each for each in robot.type.capabilities if each.payload >= robot.payload)


def _first(*seconds: float | None) -> float:
    return next(each for each in seconds if each is not None)
