"""Whether it is still the same vehicle that speaks, by the time since it was switched on."""

from __future__ import annotations

LATE_MILLISECONDS = 5_000
"""Largest age of a message relative to one that came before it, on a poor link."""

CONFIRMED = 3
"""How many messages from another start there must be before it is believed."""

WRAP = 2**32
"""Milliseconds, 49.7 days, after which a vehicle's time is counted from 0 again."""

AROUND_WRAP = 600_000
"""Milliseconds before and after that in which a vehicle whose clock begins again has not restarted."""


class Identity:
    """Detects restarts of a vehicle, and two vehicles with the same system id.

    Attributes:
        starts: how often the vehicle was seen to restart.
        twin: why there must be two vehicles; empty while there is one.
    """

    def __init__(self, late_milliseconds: float = LATE_MILLISECONDS) -> None:
        """Create for a vehicle without messages yet."""
        self.starts = 0
        self.twin = ""
        self._late = late_milliseconds
        self._newest = 0.0
        self._other = 0.0
        self._behind = 0
        self._between = 0

    def booted(self, milliseconds: float) -> None:
        """Take note of the time since the vehicle's start, as one of its messages says it."""
        milliseconds = self._counted_on(milliseconds)
        if milliseconds >= self._newest - self._late:
            self._newest = max(self._newest, milliseconds)
            self._between += self._behind > 0
            if self._behind >= CONFIRMED and self._between >= CONFIRMED:
                self.twin = "messages from two different starts take turns"
            return
        if self._behind and milliseconds < self._other:
            return
        self._other, self._behind = milliseconds, self._behind + 1
        if self._behind >= CONFIRMED and not self._between:
            self._begin_anew(milliseconds)

    def _counted_on(self, milliseconds: float) -> float:
        """Return the time since the start where it may have been counted from 0 again, once or more."""
        turns, before = divmod(self._newest, WRAP)
        if before >= WRAP - AROUND_WRAP and milliseconds < AROUND_WRAP:
            turns += 1
        elif turns and before < AROUND_WRAP and milliseconds >= WRAP - AROUND_WRAP:
            turns -= 1
        return milliseconds + turns * WRAP

    def _begin_anew(self, milliseconds: float) -> None:
        self.starts += 1
        self._newest, self._other, self._behind = milliseconds, 0.0, 0
