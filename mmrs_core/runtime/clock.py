"""The clock of simulated runs."""

from __future__ import annotations


class SimulatedClock:
    """A clock that stands still until it is told to go on; time costs nothing."""

    def __init__(self) -> None:
        self._now = 0.0

    def now(self) -> float:
        """Return the simulated seconds since the run began."""
        return self._now

    def sleep_until(self, time: float) -> None:
        """Jump to that time; a time that has passed changes nothing."""
        self._now = max(self._now, time)
