"""A vehicle at the end of its link."""

from __future__ import annotations

from collections.abc import Callable

from mmrs_runtime.clock import Clock
from mmrs_runtime.records.blackbox import BlackBox

from .links.link import Link
from .program import Geographic, Robot
from .records.recording import Recording
from .vehicles.mavlink_vehicle import MavlinkVehicle


def at_end_of(
    link: Link,
    robot: Robot,
    acceptance: float | None,
    home_tolerance: float,
    tell: Callable[[str], None],
    box: BlackBox | None,
    clock: Clock,
) -> MavlinkVehicle:
    """Return the vehicle of a robot at the end of an open link; the box keeps all that goes over it.

    The other arguments are those of `MavlinkVehicle`.
    """
    vehicle = MavlinkVehicle(
        link,
        robot.profile,
        robot.home,
        acceptance=acceptance,
        travel=robot.travel,
        home_tolerance=home_tolerance,
        tell=tell,
    )
    if box is not None:
        link.observe(Recording(box, clock, vehicle.state, geographic=isinstance(robot.home, Geographic)))
    return vehicle
