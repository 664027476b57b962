"""Slots: variables of robots that other robots set and their owners wait for.

Waits look at the state of slots, never at events, so that a notification that comes before its wait
is not lost. All robots of one process share one order of events, which the logs keep as ``lamport``.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from typing import Protocol

Record = Callable[[int], None]
Guard = Callable[[tuple[str, ...]], None]


class Slots(Protocol):
    """What a robot needs of slots."""

    def tick(self) -> int:
        """Return the next logical time of this robot's process."""
        ...

    def notify(
        self, sender: str, slots: Iterable[tuple[str, str]], active: bool, record: Record, guard: Guard
    ) -> None:
        """Record a notification, then set the slots; return when all owners have them.

        `guard` is called again and again until then, with the owners that have not answered; it raises
        what should end the attempt.
        """
        ...

    def take(self, robot: str, names: Iterable[str], record: Record) -> bool:
        """Record that the robot goes on if all its slots of these names are active; say whether."""
        ...

    def await_change(self, seconds: float) -> None:
        """Wait until a slot may have changed, but no longer than so many real seconds."""
        ...

    def lost(self, robots: Iterable[str]) -> str | None:
        """Return one of these robots that will set no more slots, if there is one."""
        ...

    def leave(self, robot: str) -> None:
        """Tell that a robot will set no more slots."""
        ...


class LocalSlots:
    """The slots of all robots of this process."""

    def __init__(self) -> None:
        """Begin with every slot inactive."""
        self._changed = threading.Condition()
        self._active: set[tuple[str, str]] = set()
        self._left: set[str] = set()
        self._lamport = 0

    def tick(self) -> int:
        """Return the next logical time."""
        with self._changed:
            self._lamport += 1
            return self._lamport

    def notify(
        self, sender: str, slots: Iterable[tuple[str, str]], active: bool, record: Record, guard: Guard
    ) -> None:
        """Record the notification and set all slots at once."""
        with self._changed:
            record(self.tick())
            self._set(slots, active)

    def take(self, robot: str, names: Iterable[str], record: Record) -> bool:
        """Record that the robot goes on if all its slots of these names are active; say whether."""
        with self._changed:
            if not all((robot, name) in self._active for name in names):
                return False
            record(self.tick())
            return True

    def await_change(self, seconds: float) -> None:
        """Wait until a slot changes, but no longer than so many real seconds."""
        with self._changed:
            self._changed.wait(seconds)

    def lost(self, robots: Iterable[str]) -> str | None:
        """Return one of these robots that has left, if there is one."""
        with self._changed:
            return next((robot for robot in robots if robot in self._left), None)

    def leave(self, robot: str) -> None:
        """Tell that a robot will set no more slots."""
        with self._changed:
            self._left.add(robot)
            self._changed.notify_all()

    def _set(self, slots: Iterable[tuple[str, str]], active: bool) -> None:
        if active:
            self._active.update(slots)
        else:
            self._active.difference_update(slots)
        self._changed.notify_all()
