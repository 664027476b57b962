"""Whether an instrument's value may be believed: its range, its jumps, whether it is frozen, its age."""

from __future__ import annotations

from collections.abc import Sequence
from math import log

from .failsafe import STALE

LIVELY, LEAK, JUMPY = 4.0, 0.05, 12.0
"""Reversals that show noise, the part of their count that each change takes away, and the most that count."""

CERTAIN, FEWEST = 1e-9, 10
"""The chance of repetition by accident that is taken for none, and how many at least make it frozen."""


class Freeze:
    """Tells when values repeat for longer than the noise that they had permits.

    Noise shows in differences that change their sign. How many equal values in sequence noise permits
    follows from how often it repeated a value so far; what never showed noise is never called frozen.
    """

    def __init__(self) -> None:
        self._last: float | None = None
        self._rose = False
        self._reversals = 0.0
        self._repeats = 0
        self._seen, self._equal = 2.0, 1.0

    def take(self, raw: float) -> bool:
        """Take the next value; tell whether it is frozen."""
        if self._last is None:
            self._last = raw
            return False
        if raw == self._last:
            self._repeats += 1
            return self.frozen
        self._seen += 1.0 + self._repeats
        self._equal += self._repeats
        self._repeats = 0
        if self._seen > 400.0:
            self._seen, self._equal = self._seen / 2.0, self._equal / 2.0
        rose = raw > self._last
        self._reversals = min(JUMPY, self._reversals * (1.0 - LEAK) + (rose != self._rose))
        self._rose, self._last = rose, raw
        return False

    @property
    def frozen(self) -> bool:
        """Whether the last values are too much alike."""
        if self._reversals < LIVELY or self._repeats < FEWEST:
            return False
        return self._repeats > log(CERTAIN) / log(min(0.99, self._equal / self._seen))


class Channel:
    """The values of one instrument, and whether the last of them may be relied on.

    Args:
        low, high: values that it can have at all.
        count: of numbers in each of its values.
    """

    def __init__(self, low: float, high: float, count: int = 1) -> None:
        self._low, self._high = low, high
        self._freezes = [Freeze() for _ in range(count)]
        self._good: float | None = None
        self._since: float | None = None
        self.why = "silent"

    def judge(
        self, values: Sequence[float], now: float, *, residual: float = 0.0, allowed: float = 1.0
    ) -> bool:
        """Tell whether a value may be believed.

        Args:
            values: its numbers, raw.
            residual: how far it is from what was expected. allowed: how far it may be.
        """
        frozen = [freeze.take(value) for freeze, value in zip(self._freezes, values, strict=True)]
        if not all(self._low <= value <= self._high for value in values):
            self.why = "out of range"
        elif any(frozen):
            self.why = "frozen"
        elif abs(residual) > allowed:
            self.why = "jumps"
        else:
            self._since = now if self._good is None or now - self._good > STALE else self._since
            self._good, self.why = now, ""
            return True
        return False

    def forget(self) -> None:
        """Take what was good till now for stale, as at the beginning."""
        self._good = self._since = None

    def age(self, now: float) -> float:
        """Return seconds since the last value that may be believed; infinite if there was none."""
        return float("inf") if self._good is None else now - self._good

    def trusted(self, now: float) -> bool:
        """Tell whether there was a good value lately, and good ones for as long as it takes to be sure."""
        return self.age(now) <= STALE
