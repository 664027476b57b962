"""Time as the vehicles see it: a simulated vehicle may run faster than real time."""

from __future__ import annotations

import time


class Clock:
    """Seconds of the run, counted from its creation."""

    def __init__(self, speedup: float = 1.0) -> None:
        """Start at zero; `speedup` seconds of the run pass in a second of real time."""
        self.speedup = speedup
        self._zero = time.monotonic()

    def now(self) -> float:
        """Return the seconds since the run began."""
        return (time.monotonic() - self._zero) * self.speedup

    def real(self, seconds: float) -> float:
        """Return how many real seconds so many seconds of the run are."""
        return max(0.0, seconds) / self.speedup

    def patience(self, seconds: float, least: float = 0.5) -> float:
        """Return a time-out in seconds of the run that is at least `least` real seconds.

        Networks and processes do not become faster when a simulation does.
        """
        return max(seconds, least * self.speedup)
