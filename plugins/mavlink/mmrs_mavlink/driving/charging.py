"""Charging: a stay until the batteries are full, or an operator confirms that they were changed."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import BATTERY_LOW, FaultError

from ..steps.energy import CHARGING_FACTOR, RECHARGE_FACTOR
from ..vehicles.vehicle import FULL, Vehicle

PAUSE_SECONDS = 1.0
MAY_MEET = "robots that keep apart by time alone may meet"
REPEATED_SECONDS = 60.0
"""Seconds after which it is said again what the robot waits for."""


class Charging:
    """One stay of a robot at its charger.

    Attributes:
        is_over: whether it has ended.
    """

    def __init__(self, vehicle: Vehicle, clock: Clock, seconds: float, say: Callable[[str], None]) -> None:
        """Stay for `seconds` at least."""
        self.is_over = False
        self._vehicle, self._clock, self._seconds, self._say = vehicle, clock, seconds, say
        self._begun = clock.now()
        self._said = -inf
        self._overdue = False
        self._answer: Callable[[str], None] | None = None
        self._why = ""

    def begin(self) -> None:
        """Count the time from now on."""
        self._begun = self._clock.now()

    def confirm(self, answer: Callable[[str], None]) -> None:
        """Count the batteries as changed, from any thread; `answer` is called with why they do not count."""
        self._answer = answer
        if self.is_over:
            self._answer_late()

    def stay(self) -> None:
        """Return once the batteries are full, or an operator has confirmed a change that counts.

        Raises:
            FaultError: they do not get full in time.
        """
        why = "it has stopped charging"
        try:
            while not (self._is_changed() or self._is_charged()):
                self._vehicle.rest(PAUSE_SECONDS)
            why = ""
        finally:
            self._why, self.is_over = why, True
            self._answer_late()

    def _answer_late(self) -> None:
        """Answer an operator who confirms a change as the stay ends, full or not."""
        answer, self._answer = self._answer, None
        if answer is not None:
            answer(self._why)

    def _is_changed(self) -> bool:
        answer, self._answer = self._answer, None
        if answer is None:
            return False
        why = self._vehicle.renew_battery()
        answer(why)
        if not why and self._clock.now() - self._begun < self._seconds:
            self._say(f"continues earlier than checks count, {self._seconds:.0f} s: {MAY_MEET}")
        return not why

    def _is_charged(self) -> bool:
        taken, left = self._clock.now() - self._begun, self._vehicle.state().energy
        if taken < self._seconds:
            return False
        if left is None:
            self._say(f"charged for {self._seconds:.0f} s; its range is unknown")
        if left is None or left >= FULL:
            return True
        longer = RECHARGE_FACTOR * self._seconds - taken
        if longer <= 0.0:
            raise FaultError(BATTERY_LOW, f"after {taken:.0f} s of charging the battery is at {left:.0%}")
        if self._clock.now() - self._said >= REPEATED_SECONDS:
            self._said = self._clock.now()
            wanted = f"waits for the battery: {left:.0%} of at least {FULL:.0%}"
            self._say(f"{wanted}, for {longer:.0f} s at most; if it was changed, order battery-changed")
        if taken > CHARGING_FACTOR * self._seconds and not self._overdue:
            self._overdue = True
            self._say(
                f"charges for longer than checks count, {CHARGING_FACTOR * self._seconds:.0f} s: {MAY_MEET}"
            )
        return False
