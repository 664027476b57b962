"""In which order a vehicle has sent its frames, whichever of them has come first."""

from __future__ import annotations

from math import inf

from mmrs_runtime.clock import Clock

LATE_FRAMES = 64
"""How many frames of the vehicle may have overtaken one that is late."""

OVERTAKEN_SECONDS, LEAST_OVERTAKEN_SECONDS = 1.0, 0.5
"""For how long, of the run and real at least: frames are counted to 255 only, and after a gap what is new
may look as if it were late."""

FRAMES = 256


class Numbering:
    """Counts the frames of one vehicle."""

    def __init__(self, clock: Clock) -> None:
        """Create without messages; `clock` is that of the run."""
        self._clock = clock
        self._newest, self._newest_at = -1, -inf

    def number(self, seq: int) -> int:
        """Return which of the vehicle's frames one is, by its number, which is counted to 255 only."""
        now = self._clock.now()
        recent = now - self._newest_at <= self._clock.patience(OVERTAKEN_SECONDS, LEAST_OVERTAKEN_SECONDS)
        behind = (self._newest - seq) % FRAMES
        if recent and behind <= LATE_FRAMES:
            return self._newest - behind
        self._newest, self._newest_at = self._newest + FRAMES - behind, now
        return self._newest
