"""Time as the vehicles see it: a simulated vehicle may run faster than real time."""

from __future__ import annotations

import time

SIGNAL_SECONDS = 0.5
"""Real seconds that a main thread waits at most before it handles a signal that did not end its wait.

One that comes just before a thread waits, or to another thread, does not.
"""


class Clock:
    """Seconds of the run."""

    def __init__(self, speedup: float = 1.0, start: float = 0.0) -> None:
        """Start to count.

        Args:
            speedup: seconds of the run that pass in a second of real time.
            start: seconds of the run that have passed already.
        """
        self.speedup = speedup
        self._start = start
        self._zero = time.monotonic()

    def now(self) -> float:
        """Return the seconds since the run began; jumps of the clock on the wall do not count."""
        return self._start + (time.monotonic() - self._zero) * self.speedup

    def real(self, seconds: float) -> float:
        """Return the real seconds of some seconds of the run."""
        return max(0.0, seconds) / self.speedup

    def patience(self, seconds: float, least: float = 0.5) -> float:
        """Return a time-out in seconds of the run that is at least `least` real seconds.

        Networks and processes do not become faster when a simulation does.
        """
        return max(seconds, least * self.speedup)
