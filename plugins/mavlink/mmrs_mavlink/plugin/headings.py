"""What of a vehicle turns, so that a device points somewhere: the vehicle itself, or a gimbal on it."""

from __future__ import annotations

from mmrs_core.behaviour.program import Heading
from mmrs_core.generation.python.moves import properties_of
from mmrs_mavlink.plugin.context import VehicleContext

GIMBAL = "mavlink.gimbal"
NO_TURNING = f"no ground vehicle turns to a heading on command; give the device a {GIMBAL}"


def on_gimbal(heading: Heading, context: VehicleContext) -> bool:
    """Return whether the device of a heading turns on its own."""
    return GIMBAL in properties_of(heading, context)


def turns_to(heading: Heading, context: VehicleContext) -> bool:
    """Return whether the vehicle, or the device on it, turns to a heading on command.

    ArduPilot's Rover takes no heading: it ignores the yaw of position targets in GUIDED, and
    skips CONDITION_YAW in AUTO.
    """
    return context.profile.turns or on_gimbal(heading, context)


def gimbal_of(heading: Heading, context: VehicleContext) -> int:
    """Return the number of the gimbal that a heading is of; 0 where the property gives none."""
    number = properties_of(heading, context).get(GIMBAL, "")
    return int(number) if number.isdecimal() else 0
