"""Who can be reached, who no longer, and who has ended."""

from __future__ import annotations

import time
from collections.abc import Callable

DOUBLE_SECONDS = 3.0
"""How long a robot may still look as if another process ran it, which was killed on a machine of its own."""


class Doubled(OSError):  # noqa: N818  # what is the matter with a robot
    """A robot that another process runs, too."""


class Watching:
    """What is known of the robots of other processes, and of all robots that have ended.

    Attributes:
        left: the robots that have ended.
    """

    def __init__(self, lease: float) -> None:
        """Know nobody; after `lease` seconds out of reach a robot is lost for long."""
        self.left: set[str] = set()
        self._lease = lease
        self._here: set[str] = set()
        self._lost_at: dict[str, float] = {}
        self._doubled: dict[str, float] = {}
        self._told: set[str] = set()

    def doubled(self, robot: str, here: bool, now: float) -> None:
        """Take note that a robot of this process is run by another one, too, or no longer."""
        if here:
            self._doubled.setdefault(robot, now)
        else:
            self._doubled.pop(robot, None)
            self._told.discard(robot)

    def doubles(self) -> tuple[str, ...]:
        """Return the robots of this process that another one runs, too."""
        return tuple(self._doubled)

    def lasting_doubles(self, now: float) -> tuple[str, ...]:
        """Return those that have been so for long, each once."""
        found = [
            robot
            for robot, since in self._doubled.items()
            if robot not in self._told and now >= since + DOUBLE_SECONDS
        ]
        self._told.update(found)
        return tuple(found)

    def next_double(self) -> float:
        """Return when `lasting_doubles` may have one; inf: never."""
        untold = (since for robot, since in self._doubled.items() if robot not in self._told)
        return min((since + DOUBLE_SECONDS for since in untold), default=float("inf"))

    def noticed(self, robot: str, here: bool, now: float) -> None:
        """Take note that a robot can be reached, or no longer."""
        if here:
            self._here.add(robot)
            self._lost_at.pop(robot, None)
        else:
            self._here.discard(robot)
            self._lost_at.setdefault(robot, now)

    def is_here(self, robot: str) -> bool:
        """Return whether a robot can be reached."""
        return robot in self._here

    def is_unseen(self, robot: str) -> bool:
        """Return whether a robot has never been here, and has told nobody here that it has ended."""
        return not self.is_here(robot) and not self.is_gone(robot)

    def is_gone(self, robot: str) -> bool:
        """Return whether a robot has ended, or was there and can no longer be reached."""
        return robot in self.left or robot in self._lost_at

    def long_lost_at(self, robot: str) -> float | None:
        """Return when a robot is lost for long unless it comes back; None: it is not lost."""
        lost_at = self._lost_at.get(robot)
        return None if lost_at is None else lost_at + self._lease

    def lost_for_long(self, robot: str, now: float) -> bool:
        """Return whether a robot has been out of reach for longer than the lease."""
        at = self.long_lost_at(robot)
        return at is not None and now >= at


def refuse_doubles(watching: Watching, settle: float, now: Callable[[], float]) -> None:
    """Return when nobody else has been seen for so many seconds to run robots of this process.

    Raises:
        Doubled: another process runs one of them, and goes on doing so.
    """
    begun = now()
    while (left := begun + settle - now()) > 0:
        time.sleep(min(left, 0.05))
    while settle and (there := watching.doubles()):
        if now() - begun > settle + DOUBLE_SECONDS:
            raise Doubled(f"{', '.join(map(ascii, there))}: another process runs it on this bus already")
        time.sleep(0.05)
