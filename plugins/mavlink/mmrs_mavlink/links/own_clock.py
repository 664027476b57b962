"""Whether a vehicle's own clock keeps time with that of the run: in simulations it may be sped up."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

from mmrs_runtime.clock import Clock
from mmrs_runtime.records.blackbox import BlackBox

from .identity import LATE_MILLISECONDS
from .link import GAP_SECONDS, LEAST_GAP_SECONDS, TELL_BOOT, Link, Message

MEASURED_SECONDS = 10.0
"""For how long, of the run and real, its clock is watched at least."""

TOLERATED = 0.1
"""Part by which it may run faster or slower."""


class OwnClock:
    """Observes a link, and tells once that the vehicle's clock runs at another rate than the run's.

    What it is ahead or behind by must be more than messages can be late. It is counted from the last silence
    or restart, as a vehicle that stands still, or is out of reach, says nothing of its rate.
    """

    def __init__(self, link: Link, clock: Clock, tell: Callable[[str], None], box: BlackBox | None) -> None:
        """Take the link to a vehicle, and the clock of the run; a box gets the rate as its ``clock``."""
        self._link, self._clock, self._tell, self._box = link, clock, tell, box
        self._late = max(1e-3 * LATE_MILLISECONDS, clock.speedup)
        self._first = self._newest = (0.0, -inf)
        self._told = False

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Take note of what the vehicle's clock shows."""
        sender = (self._link.system, self._link.component)
        if self._told or outgoing or message.get_type() not in TELL_BOOT:
            return
        if (message.get_srcSystem(), message.get_srcComponent()) == sender:
            self._shows(message.time_boot_ms * 1e-3, self._clock.now())

    def _shows(self, own: float, now: float) -> None:
        before, seen = self._newest
        silent = now - seen > self._clock.patience(GAP_SECONDS, LEAST_GAP_SECONDS)
        if silent or own < before - self._late:
            self._first = self._newest = (own, now)
            return
        self._newest = (max(own, before), now)
        passed, ahead = now - self._first[1], own - self._first[0] - (now - self._first[1])
        long_enough = passed >= self._clock.patience(MEASURED_SECONDS, MEASURED_SECONDS)
        if long_enough and abs(ahead) > self._late + TOLERATED * passed:
            self._say(1.0 + ahead / passed)

    def _say(self, rate: float) -> None:
        self._told = True
        if self._box is not None:
            self._box.write("clock", rate=round(rate, 3))
        self._tell(
            f"the vehicle's clock runs {rate:.2g} times as fast as the run's (warning: durations, time-outs"
            " and the times in the log do not fit it: a simulation needs --speedup"
            f" {rate * self._clock.speedup:.2g})"
        )
