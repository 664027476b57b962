"""What autopilots do with classes of vehicles, as values: all that the driver does differently for them."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from typing import Any

from .ardupilot import ARDUCOPTER, ARDUPILOT, ARDUROVER, ARDUSUB
from .autopilot import Autopilot, Keeping, never
from .profile import Profiles, VehicleProfile
from .px4 import PX4, PX4_MULTICOPTER, PX4_ROVER, PX4_SUB

__all__ = [
    "ARDUCOPTER",
    "ARDUPILOT",
    "ARDUROVER",
    "ARDUSUB",
    "GENERIC",
    "PROFILES",
    "PX4",
    "PX4_MULTICOPTER",
    "PX4_ROVER",
    "PX4_SUB",
    "Autopilot",
    "Profiles",
    "VehicleProfile",
    "imported",
    "on_autopilot",
    "profile_for",
]

PROFILES: Profiles = {
    each.name: each for each in (ARDUCOPTER, ARDUROVER, ARDUSUB, PX4_MULTICOPTER, PX4_ROVER, PX4_SUB)
}
"""Those of this plug-in."""

GENERIC = replace(
    ARDUPILOT,
    name="generic",
    title="an unknown autopilot",
    number=0,
    streamed={},
    keeping=Keeping(),
    must_report_checks=never,
    needs={},
    capacities=(),
    refusals=(*ARDUPILOT.refusals, *PX4.refusals),
    announcements={
        event: (*parts, *PX4.announcements[event]) for event, parts in ARDUPILOT.announcements.items()
    },
)
"""What is taken for granted of an autopilot that no profile knows."""


def profile_for(vehicle: str, source: str = "") -> VehicleProfile:
    """Return the profile of a class of vehicle, with ArduPilot where there are several.

    Args:
        vehicle: class of vehicle, as `VehicleProfile.vehicle` names it.
        source: ``module:name`` of a profile of a plug-in; empty: it is one of this plug-in.

    Raises:
        ValueError: there is none.
    """
    if source:
        found = imported(source)
        if not isinstance(found, VehicleProfile):
            raise ValueError(f"{source}: not a vehicle profile")
        return found
    known = next((each for each in PROFILES.values() if each.vehicle == vehicle), None)
    if known is None:
        raise ValueError(f"vehicle '{vehicle}': no profile drives it without a plug-in")
    return known


def on_autopilot(profile: VehicleProfile, number: int) -> VehicleProfile:
    """Return the profile of the same class of vehicle for the autopilot that a heartbeat reports.

    Args:
        profile: of the class of vehicle.
        number: of MAV_AUTOPILOT.

    Returns:
        `profile` itself where its class is not known with that autopilot.
    """
    if number == profile.autopilot.number:
        return profile
    siblings = [each for each in PROFILES.values() if each.vehicle == profile.vehicle]
    found = next((each for each in siblings if each.autopilot.number == number), None)
    if found is not None or number in (ARDUPILOT.number, PX4.number):
        return found or profile
    return replace(siblings[0], autopilot=GENERIC) if siblings else profile


def imported(source: str) -> Any:
    """Return what ``module:name`` names.

    Raises:
        ValueError: there is no such thing, such as where a plug-in is not installed.
    """
    module, _, name = source.partition(":")
    try:
        return getattr(import_module(module), name)
    except (ImportError, AttributeError, ValueError) as error:
        raise ValueError(f"{source}: cannot be imported: {error}") from error
