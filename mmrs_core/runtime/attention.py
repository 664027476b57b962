"""Who has to be looked at, as other threads point it out."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from mmrs_core.contributions.execution import Clock

BUS = ""
"""Stands for the bus, where otherwise the identifier of a robot stands."""


class Attention:
    """Collects who has news, and ends the sleep of whoever waits for it."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._called: deque[str] = deque()

    def call(self, who: str) -> None:
        """Say that a robot, or the bus, has news; from any thread or signal handler."""
        self._called.append(who)
        self._clock.wake()

    def for_robot(self, robot: str) -> Callable[[], None]:
        """Return a function that says that this robot has news."""
        return lambda: self.call(robot)

    def taken(self) -> frozenset[str]:
        """Return who has called since this was asked last."""
        found: set[str] = set()
        while self._called:
            found.add(self._called.popleft())
        return frozenset(found)
