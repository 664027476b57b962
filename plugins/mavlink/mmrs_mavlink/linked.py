"""A vehicle at the end of its link."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from mmrs_runtime.clock import Clock
from mmrs_runtime.engine.connecting import Live
from mmrs_runtime.records.blackbox import BlackBox

from .links.link import Link
from .links.own_clock import OwnClock
from .links.radios import Radios
from .program import Geographic, Robot
from .records.recording import Recording
from .vehicles.mavlink_vehicle import MavlinkVehicle
from .vehicles.recognition import system_of


@dataclass(frozen=True, slots=True)
class RadioLink:
    """How a vehicle that speaks MAVLink is reached.

    Attributes:
        patience: seconds of the run to wait for its first message.
        system: of the vehicle when the run began; 0: unknown.
    """

    url: str
    link: Link
    vehicle: MavlinkVehicle
    radios: Radios
    patience: float
    system: int = 0


def reached(
    url: str,
    link: Link,
    robot: Robot,
    radios: Radios,
    live: Live,
    box: BlackBox | None,
    clock: Clock,
    *,
    acceptance: float | None,
    home_tolerance: float,
    patience: float,
) -> RadioLink:
    """Return how the vehicle of a robot at the end of an open link is reached.

    Args:
        box: keeps all that goes over the link.
        acceptance, home_tolerance: as in `MavlinkVehicle`; where a run is resumed, it may be anywhere.
        patience: real seconds to wait for its first message.
    """
    vehicle = MavlinkVehicle(
        link,
        robot.profile,
        robot.home,
        acceptance=acceptance,
        travel=robot.travel,
        home_tolerance=inf if live.resumed else home_tolerance,
        tell=live.say,
    )
    link.observe(OwnClock(link, clock, live.say, box))
    if box is not None:
        link.observe(Recording(box, clock, vehicle.state, geographic=isinstance(robot.home, Geographic)))
    path = live.box_path(robot.id)
    system = system_of(path) if live.resumed and path is not None else 0
    return RadioLink(url, link, vehicle, radios, patience * clock.speedup, system)
