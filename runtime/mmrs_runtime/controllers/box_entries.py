"""Entries of a controller's black box: its start (vehicle, link, software), and the robot's position."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from platform import python_version
from uuid import uuid4

from ..records.blackbox import BlackBox
from .state import State
from .vocabulary import Place, Robot

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


FIX_SECONDS = 0.19
"""Least time between two fixes: five in a second, and a little for uneven sending."""


def fix(box: BlackBox, state: State, place: Place | None = None) -> None:
    """Write where a robot is; `place` where the state's is older."""
    box.write(
        "fix",
        place=place or state.place,
        speed=round(state.speed, 3),
        heading=round(state.heading, 2),
        energy=state.energy,
        mode=state.mode,
        armed=state.armed,
    )
