"""Which robots are to be looked at, and when: by their place in the program, the first one first."""

from __future__ import annotations

from heapq import heappop, heappush
from math import inf
from typing import NamedTuple


class Until(NamedTuple):
    """What a life yields: it is resumed at that time, or as soon as there is news for it."""

    deadline: float = inf


class EventQueue:
    """Numbers that are due now, each once and in their order, and the times at which others will be.

    A time that no longer counts stays where it is until it comes, and is passed over then.
    """

    def __init__(self, count: int) -> None:
        """Begin with so many, all due now."""
        self._due = list(range(count))
        self._is_due = [True] * count
        self._later: list[tuple[float, int]] = []
        self._times = [inf] * count

    @property
    def is_due(self) -> bool:
        """Return whether any is due now."""
        return bool(self._due)

    def put(self, number: int) -> None:
        """Make one due now; its later time stays as it is."""
        if not self._is_due[number]:
            self._is_due[number] = True
            heappush(self._due, number)

    def put_at(self, number: int, time: float) -> None:
        """Make one due at that time instead of an earlier set one; inf: never."""
        self._times[number] = time
        if time < inf:
            heappush(self._later, (time, number))

    def take(self) -> int:
        """Return the first that is due; it is due no longer."""
        number = heappop(self._due)
        self._is_due[number] = False
        return number

    @property
    def next_time(self) -> float:
        """Return when the next will be due; inf: none will."""
        while self._later and self._is_outdated(self._later[0]):
            heappop(self._later)
        return self._later[0][0] if self._later else inf

    def advance(self, now: float) -> None:
        """Make those due whose time has come."""
        while self._later and self._later[0][0] <= now:
            entry = heappop(self._later)
            if not self._is_outdated(entry):
                self.put(entry[1])

    def _is_outdated(self, entry: tuple[float, int]) -> bool:
        return self._times[entry[1]] != entry[0]
