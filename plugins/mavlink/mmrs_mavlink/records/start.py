"""What a black box says first: which vehicle, over which link, with what software."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from platform import python_version
from typing import TYPE_CHECKING
from uuid import uuid4

from ..program import Robot

if TYPE_CHECKING:
    from ..links.link import Link

PROCESS = uuid4().hex
"""What all robots of this process say, and no other: their times count from the same instant."""


def start_of(robot: Robot, url: str, link: Link | None) -> dict[str, object]:
    """Return what is known of a robot at the start; `link` None: there is no vehicle."""
    return {
        "plan": robot.plan,
        "process": PROCESS,
        "link": url if link is not None else None,
        "vehicle": robot.vehicle,
        "firmware": _firmware(link) if link is not None else None,
        "home": robot.home,
        "system": link.system if link is not None else None,
        "versions": {"python": python_version(), **_installed("pymavlink")},
    }


def _firmware(link: Link) -> str | None:
    from pymavlink.dialects.v20 import ardupilotmega as mavlink

    beat = link.latest("HEARTBEAT")
    firmware = mavlink.enums["MAV_AUTOPILOT"].get(beat.autopilot) if beat is not None else None
    return firmware.name.removeprefix("MAV_AUTOPILOT_") if firmware is not None else None


def _installed(distribution: str) -> dict[str, str]:
    try:
        return {distribution: version(distribution)}
    except PackageNotFoundError:
        return {}
