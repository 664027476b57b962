"""Whether an instrument's value may be believed: its range, its jumps, whether it is frozen, its age."""

from __future__ import annotations

from collections.abc import Sequence
from math import log

from auv_vessel.control.failsafe import STALE

LIVELY, LEAK, JUMPY, QUANTA = 4.0, 0.05, 12.0, 3.0
"""Reversals that show noise, the part of their count that each change takes away, the most that count, and
the steps of the instrument's scale by which differences have to differ for that."""

CERTAIN, FEWEST = 1e-9, 10
"""The chance of repetition by accident that is taken for none, and how many at least make it frozen."""

FORGETS = 8.0
"""Seconds after which a difference between two instruments is forgotten, where it does not grow."""


class Freeze:
    """Tells when values repeat for longer than the noise that they had permits.

    Noise shows in differences that grow and shrink in turn, by more than the instrument's scale makes them.
    How many equal values in sequence noise permits follows from how often it repeated a value so far; what
    never showed noise is never called frozen.

    Args:
        quantum: the step of the instrument's scale.
    """

    def __init__(self, quantum: float) -> None:
        self._least = QUANTA * quantum
        self._last: float | None = None
        self._difference = 0.0
        self._grew = False
        self._reversals = 0.0
        self._repeats = 0
        self._seen, self._equal = 2.0, 1.0

    def take(self, raw: float) -> bool:
        """Take the next value; return whether it is frozen."""
        if self._last is None:
            self._last = raw
            return False
        if raw == self._last:
            self._repeats += 1
            return self.frozen
        self._count()
        difference = raw - self._last
        change = difference - self._difference
        grew = change > 0.0
        self._reversals *= 1.0 - LEAK
        if abs(change) > self._least and grew != self._grew:
            self._reversals = min(JUMPY, self._reversals + 1.0)
        self._grew, self._difference, self._last = grew, difference, raw
        return False

    def _count(self) -> None:
        """Count how often a value was repeated; what was long ago counts for less."""
        self._seen += 1.0 + self._repeats
        self._equal += self._repeats
        self._repeats = 0
        if self._seen > 400.0:
            self._seen, self._equal = self._seen / 2.0, self._equal / 2.0

    @property
    def frozen(self) -> bool:
        """Whether the last values are too much alike."""
        if self._reversals < LIVELY or self._repeats < FEWEST:
            return False
        return self._repeats > log(CERTAIN) / log(min(0.99, self._equal / self._seen))


class Drift:
    """How far an instrument has drifted from the rate that another measures, over the last seconds.

    Attributes:
        difference: of both, in the unit of the instrument.
    """

    def __init__(self) -> None:
        self.difference = 0.0
        self._last: float | None = None
        self._turned = 0.0

    def advance(self, rate: float, period: float) -> None:
        """Let time go by in which the other instrument says a rate."""
        self._turned += rate * period
        self.difference *= 1.0 - period / FORGETS

    def take(self, value: float, *, circle: float | None = None) -> None:
        """Take a value of the instrument; one on a circle continues from its end to its beginning."""
        if self._last is not None:
            change = value - self._last - self._turned
            self.difference += change if circle is None else (change + circle / 2.0) % circle - circle / 2.0
        self._last, self._turned = value, 0.0

    def forget(self) -> None:
        """Restart: the other instrument gives no value."""
        self.difference, self._last, self._turned = 0.0, None, 0.0


class Channel:
    """The values of one instrument, and whether the last of them may be relied on.

    Args:
        low, high: values that it can have at all.
        quantum: the step of its scale.
        count: of numbers in each of its values.

    Attributes:
        why: the last value was not believed; empty: it was.
    """

    def __init__(self, low: float, high: float, quantum: float, count: int = 1) -> None:
        self._low, self._high = low, high
        self._freezes = [Freeze(quantum) for _ in range(count)]
        self._good: float | None = None
        self.why = "silent"

    def judge(
        self, values: Sequence[float], now: float, *, residual: float = 0.0, allowed: float = 1.0
    ) -> bool:
        """Return whether a value is plausible.

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
            self._good, self.why = now, ""
            return True
        return False

    def age(self, now: float) -> float:
        """Return seconds since the last value that may be believed; infinite if there was none."""
        return float("inf") if self._good is None else now - self._good

    def trusted(self, now: float) -> bool:
        """Return whether there was a plausible value lately."""
        return self.age(now) <= STALE
