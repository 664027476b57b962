"""What a black box says first: which vehicle, over which link, with what software."""

from __future__ import annotations

from importlib.metadata import version
from platform import python_version

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Link
from ..program import Robot


def start_of(robot: Robot, url: str, link: Link | None) -> dict[str, object]:
    """Return what is known of a robot at the start; `link` None: there is no vehicle."""
    beat = link.latest("HEARTBEAT") if link is not None else None
    firmware = mavlink.enums["MAV_AUTOPILOT"].get(beat.autopilot) if beat is not None else None
    return {
        "plan": robot.plan,
        "link": url if link is not None else None,
        "vehicle": robot.vehicle,
        "firmware": firmware.name.removeprefix("MAV_AUTOPILOT_") if firmware is not None else None,
        "home": robot.home,
        "system": link.system if link is not None else None,
        "versions": {"python": python_version(), "pymavlink": version("pymavlink")},
    }
