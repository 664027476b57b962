"""How long vehicles with profiles of this plug-in take, for plans, checks and simulations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from mmrs_core.contributions.timing import VehicleTiming
from mmrs_core.scene import RobotType
from mmrs_mavlink.plugin.vehicles import autopilot_of
from mmrs_mavlink.profiles import PROFILES
from mmrs_mavlink.steps.energy import CHARGING_FACTOR
from mmrs_runtime.timing import AutopilotTiming


def timings() -> Iterator[VehicleTiming]:
    """Yield the timing of each class of vehicle."""
    for vehicle in dict.fromkeys(word for each in PROFILES.values() for word in each.words):
        yield VehicleTiming(vehicle, partial(_timing_of, vehicle))


def _timing_of(vehicle: str, type: RobotType) -> AutopilotTiming:
    """Return the timing with the autopilot that the type names, else with ArduPilot."""
    named = autopilot_of(type, {})
    fitting = [each for each in PROFILES.values() if vehicle in each.words]
    profile = next((each for each in fitting if each.autopilot.name == named), fitting[0])
    step = replace(profile.pacing.step, still=profile.still)
    return replace(profile.pacing, step=step, charging=CHARGING_FACTOR)
