"""The clocks of runs: simulated time, which jumps, and real time, which passes."""

from __future__ import annotations

import time
from contextlib import suppress
from math import inf
from queue import Empty, SimpleQueue
from typing import Protocol

from ..clock import SIGNAL_SECONDS
from ..clock import Clock as RobotClock


class RunClock(Protocol):
    """The time of a run."""

    @property
    def passes_by_itself(self) -> bool:
        """Return whether time passes on its own, so that waiting for unforeseen events makes sense."""
        ...

    def now(self) -> float:
        """Return the seconds since the run began."""
        ...

    def sleep_until(self, time: float) -> None:
        """Return when that time has come, or earlier if `wake` is called."""
        ...

    def wake(self) -> None:
        """End the present or next sleep at once; from any thread."""
        ...


class SimulatedClock:
    """A clock that stands still until it is advanced; time costs nothing."""

    passes_by_itself = False

    def __init__(self) -> None:
        self._now = 0.0

    def now(self) -> float:
        """Return the simulated seconds since the run began."""
        return self._now

    def sleep_until(self, time: float) -> None:
        """Jump to that time; a time that has passed changes nothing."""
        self._now = max(self._now, time)

    def wake(self) -> None:
        """Return at once: simulated time has no sleepers."""


class RealClock:
    """Counts seconds of the run by the monotonic clock, which cannot be set.

    Attributes:
        speedup: seconds of the run that pass in a second, for vehicles that are simulated.
    """

    passes_by_itself = True

    def __init__(self, speedup: float = 1.0, start: float = 0.0) -> None:
        """Begin at `start` seconds of the run.

        Raises:
            ValueError: if time would stand still or go back.
        """
        if not 0.0 < speedup < inf:
            raise ValueError(f"speed-up {speedup} is not a positive number")
        self.speedup = speedup
        self._start, self._zero = start, time.monotonic()
        self._wakes: SimpleQueue[None] = SimpleQueue()

    def now(self) -> float:
        """Return the seconds since the run began."""
        return self._start + (time.monotonic() - self._zero) * self.speedup

    def sleep_until(self, time: float) -> None:
        """Return when that time has come, or as soon as `wake` is called."""
        while not self._is_woken((time - self.now()) / self.speedup):
            if self.now() >= time:
                return

    def _is_woken(self, left: float) -> bool:
        """Return whether the sleeper was woken within that time, `SIGNAL_SECONDS` at most."""
        try:
            self._wakes.get(timeout=min(max(left, 0.0), SIGNAL_SECONDS))
        except Empty:
            return False
        with suppress(Empty):
            while True:
                self._wakes.get_nowait()
        return True

    def wake(self) -> None:
        """End the present sleep, or else the next one; from any thread or signal handler."""
        self._wakes.put(None)


class FollowingClock(RobotClock):
    """The clock of what a robot runs on, showing the time of a run."""

    def __init__(self, clock: RunClock) -> None:
        """Follow that clock."""
        super().__init__(float(getattr(clock, "speedup", 1.0)))
        self.followed = clock

    def now(self) -> float:
        """Return the seconds since the run began."""
        return self.followed.now()
