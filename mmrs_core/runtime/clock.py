"""Clocks of runs: one that jumps, one that follows the world."""

from __future__ import annotations

import time


class SimulatedClock:
    """A clock that stands still until it is told to go on; time costs nothing."""

    def __init__(self, start: float = 0.0) -> None:
        self._now = start

    def now(self) -> float:
        """Return the simulated seconds since the run began."""
        return self._now

    def sleep_until(self, time: float) -> None:
        """Jump to that time; a time that has passed changes nothing."""
        self._now = max(self._now, time)


class RealClock:
    """The world's time since the clock was made, which never goes back."""

    def __init__(self, rate: float = 1.0) -> None:
        """Begin at zero.

        Args:
            rate: seconds of the run's clock in one second of the world; above 1 to watch a
                simulation at more than its own pace.

        Raises:
            ValueError: if the rate is not above zero.
        """
        if rate <= 0:
            raise ValueError(f"rate {rate:g}: not above zero")
        self._rate = rate
        self._start = time.monotonic()

    def now(self) -> float:
        """Return the seconds since the run began."""
        return (time.monotonic() - self._start) * self._rate

    def sleep_until(self, time_: float) -> None:
        """Sleep until that time."""
        while (left := time_ - self.now()) > 0:
            time.sleep(left / self._rate)
