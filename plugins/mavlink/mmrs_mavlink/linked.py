"""A vehicle that is reached by MAVLink, as sessions have it; nothing else that they need knows MAVLink."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from math import inf

from mmrs_runtime.clock import Clock
from mmrs_runtime.records.blackbox import BlackBox, black_box_path
from mmrs_runtime.screen import say

from .links.link import Link
from .links.radios import Radios
from .options import Options
from .program import Geographic, Place, Robot
from .records.recording import Recording
from .vehicles.mavlink_vehicle import MavlinkVehicle
from .vehicles.recognition import recognise, system_of


@dataclass(frozen=True, slots=True)
class Linked:
    """A vehicle and the link to it."""

    link: Link
    vehicle: MavlinkVehicle

    def record(self, box: BlackBox, robot: Robot, clock: Clock) -> None:
        """Have all that goes over the link kept."""
        geographic = isinstance(robot.home, Geographic)
        self.link.observe(Recording(box, clock, self.vehicle.state, geographic=geographic))

    def recognise(self, robot: Robot, options: Options, under_way: bool, starts: Sequence[Place]) -> None:
        """Make sure that the vehicle is the robot's.

        Raises:
            Fault: it is not.
        """
        system = system_of(black_box_path(options.log / robot.log)) if options.resume else 0
        near = inf if under_way and self.vehicle.state().armed else options.tolerances.home
        recognise(self.link, self.vehicle, robot, near, starts, under_way=under_way, system=system)


def linked(
    robot: Robot, options: Options, radios: Radios, guard: Callable[[], None], stack: ExitStack
) -> Linked:
    """Return the vehicle of a robot, once it is heard.

    Raises:
        Fault: it is not, or its link cannot be opened.
    """
    link = _link(robot, options, radios, guard, stack)
    near = options.tolerances
    return at_end_of(link, robot, near.place, near.home, lambda line: say(f"{robot.id!r}: {line}"))


def at_end_of(
    link: Link, robot: Robot, acceptance: float | None, home_tolerance: float, tell: Callable[[str], None]
) -> Linked:
    """Return the vehicle of a robot at the end of an open link; arguments as those of `MavlinkVehicle`."""
    vehicle = MavlinkVehicle(
        link,
        robot.vehicle,
        robot.home,
        acceptance=acceptance,
        travel=robot.travel,
        home_tolerance=home_tolerance,
        tell=tell,
    )
    return Linked(link, vehicle)


def _link(
    robot: Robot, options: Options, radios: Radios, guard: Callable[[], None], stack: ExitStack
) -> Link:
    reach = options.reach
    url, system = reach.urls[robot.id], reach.systems[robot.id]
    link = radios.open(url, system)
    stack.callback(link.close)
    link.guard = guard
    say(f"{robot.id!r}: waits for {f'system {system}' if system else 'a vehicle'} at {url}")
    radios.meet(link, url, reach.patience * options.clock.speedup)
    return link
