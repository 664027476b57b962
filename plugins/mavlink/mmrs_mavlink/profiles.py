"""What one autopilot does with one class of vehicle, as values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

ARDUPILOT, PX4 = "ardupilot", "px4"
AUTOPILOTS: Mapping[str, int] = {ARDUPILOT: 3, PX4: 12}
"""Numbers of MAV_AUTOPILOT."""


@dataclass(frozen=True, slots=True)
class VehicleProfile:
    """What one autopilot does with one class of vehicle.

    Attributes:
        name: unique, such as ``arducopter``.
        vehicle: class of vehicle, as `RobotKind.vehicle` names it.
        driven_as: whose modes, failsafe parameters and telemetry the vehicle has: those of Copter, Sub or
            Rover, as this autopilot has them. The vehicle reports a MAV_TYPE of that class.
        mav_type: number of MAV_TYPE, written into plans.
        alone: responses of policies that the vehicle carries out by its own failsafe, when the link is lost.
        more: responses that it only carries out on command.
        autopilot: ``ardupilot`` or ``px4``, as the device property ``mavlink.autopilot`` names it.
        carries: further words of `RobotKind.vehicle` whose robots it carries.
    """

    name: str
    vehicle: str
    driven_as: Literal["copter", "sub", "rover"]
    mav_type: int
    alone: frozenset[str]
    more: frozenset[str] = frozenset()
    autopilot: str = ARDUPILOT
    carries: tuple[str, ...] = ()

    @property
    def responses(self) -> frozenset[str]:
        """Return the responses of policies that it carries out on command."""
        return self.alone | self.more

    @property
    def words(self) -> tuple[str, ...]:
        """Return the words of `RobotKind.vehicle` whose robots it carries."""
        return (self.vehicle, *self.carries)

    @property
    def flies(self) -> bool:
        """Return whether the vehicle takes off and lands."""
        return self.driven_as == "copter"

    @property
    def dives(self) -> bool:
        """Return whether its heights count from the water surface."""
        return self.driven_as == "sub"

    @property
    def turns(self) -> bool:
        """Return whether it turns to a heading on command."""
        return self.driven_as != "rover"


Profiles: TypeAlias = Mapping[str, VehicleProfile]
"""Profiles by name."""

_OF_COPTERS = frozenset({"CONTINUE", "RETURN", "EMERGENCY_AREA", "LAND", "HOLD"})
ARDUCOPTER = VehicleProfile("arducopter", "copter", "copter", 2, _OF_COPTERS)
PX4_MULTICOPTER = VehicleProfile("px4-multicopter", "copter", "copter", 2, _OF_COPTERS, autopilot=PX4)
ARDUSUB = VehicleProfile(
    "ardusub",
    "sub",
    "sub",
    12,
    alone=frozenset({"CONTINUE", "STOP_THRUST", "HOLD", "SURFACE", "LAND", "RETURN"}),
    more=frozenset({"EMERGENCY_AREA"}),
)
ARDUROVER = VehicleProfile(
    "ardurover",
    "rover",
    "rover",
    10,
    alone=frozenset({"CONTINUE", "RETURN", "EMERGENCY_AREA", "HOLD", "LAND", "STOP_THRUST"}),
    carries=("ground",),
)
PROFILES: Profiles = {each.name: each for each in (ARDUCOPTER, ARDUROVER, ARDUSUB, PX4_MULTICOPTER)}
"""Those of this plug-in."""
