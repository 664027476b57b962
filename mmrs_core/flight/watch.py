"""Looks, during every wait, for what should end it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence

from .ardupilot import MavlinkVehicle
from .clock import Clock
from .faults import BATTERY_LOW, LINK_LOST, Fault, Stopped
from .link import Link
from .program import Policy, Robot
from .responses import CONTINUE, policy_for

SILENCE_SECONDS = 5.0
LEAST_SILENCE = 2.0


class Watch:
    """Raises what ends a robot's program: a stop, a lost link, a low battery.

    Attributes:
        current: the policies of the wait that the robot is in.
    """

    def __init__(self, robot: Robot, clock: Clock, stop: threading.Event) -> None:
        """Watch for a stop only, until there is a vehicle."""
        self.current: Callable[[], Sequence[Policy]] = lambda: ()
        self._robot = robot
        self._clock = clock
        self._stop = stop
        self._link: Link | None = None
        self._vehicle: MavlinkVehicle | None = None
        self._relaxed = False

    def begin(self, link: Link, vehicle: MavlinkVehicle) -> None:
        """Watch link and battery, too."""
        self._link, self._vehicle = link, vehicle

    def relax(self) -> None:
        """Watch the link only: the robot is already ending its program."""
        self._relaxed = True

    def check(self) -> None:
        """Raise what should end a wait.

        Raises:
            Fault: something should.
        """
        if self._stop.is_set() and not self._relaxed:
            raise Stopped()
        if self._link is None or self._vehicle is None:
            return
        self._check_link(self._link)
        if self._relaxed or not self._vehicle.running_low(self._robot.reserve):
            return
        if policy_for(BATTERY_LOW, self._robot, self.current()).response != CONTINUE:
            raise Fault(BATTERY_LOW, f"less than {self._robot.reserve:.0%} of the energy is left")

    def _check_link(self, link: Link) -> None:
        policy = policy_for(LINK_LOST, self._robot, self.current())
        limit = SILENCE_SECONDS if policy.after is None else policy.after
        silent = link.silent_for()
        if silent > self._clock.patience(limit, LEAST_SILENCE) and policy.response != CONTINUE:
            why = f" ({link.trouble})" if link.trouble else ""
            raise Fault(LINK_LOST, f"the vehicle has been silent for {silent:.0f} s{why}")
