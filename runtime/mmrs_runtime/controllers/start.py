"""What the black box of a controller says first: which vehicle, how it is reached, with what software."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from platform import python_version
from uuid import uuid4

from .words import Robot

PROCESS = uuid4().hex
"""What all robots of this process say, and no other: their times count from the same instant."""


def start_of(robot: Robot, link: str | None, *libraries: str, **more: object) -> dict[str, object]:
    """Return the first entry of a robot's black box: what is known at the start.

    Args:
        robot: whose black box it is.
        link: how it is reached; None: there is no vehicle.
        libraries: distributions that its driver uses; those that are installed are listed.
        more: further entries of its driver.
    """
    return {
        "plan": robot.plan,
        "process": PROCESS,
        "link": link,
        "vehicle": robot.vehicle,
        "home": robot.home,
        "versions": {"python": python_version(), **_installed(*libraries)},
        **more,
    }


def _installed(*distributions: str) -> dict[str, str]:
    found = {}
    for distribution in distributions:
        try:
            found[distribution] = version(distribution)
        except PackageNotFoundError:
            continue
    return found
