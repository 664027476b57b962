"""Who can be reached, who no longer, who has ended, and who is ready to begin together."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable

from .messages import Answer, Meet

LEASE_SECONDS = 1.5
"""How long a robot may be out of reach before slots are no longer kept for it."""

SETTLING_SECONDS = 1.0
"""How long a process looks whether another one runs its robots, before it joins the bus."""

DOUBLE_SECONDS = 3.0
"""How long a robot may still look as if another process ran it, which was killed on a machine of its own."""

NOTICE_SECONDS = 1.0
"""Seconds ahead at which the instant is set at least, so that all receive it and can measure."""

ROUNDS = 3
"""Round trips of the slowest robot that fit in before the instant where links are slow."""

LONGEST_ROUND = 4.0
"""Seconds between two questions of a robot that tell something of its link; it was away for longer ones."""

TWICE = "another process runs it on this bus, too"
OTHERWISE = "it is on this bus by another plan of the mission"


class Unwelcome(OSError):  # noqa: N818  # what is the matter with a robot
    """A robot that cannot take part: others do that it does not go together with."""


class Watching:
    """The robots of other processes, and all robots that have ended.

    Attributes:
        left: the robots that have ended normally, with the latest logical time of each.
    """

    def __init__(self) -> None:
        """Create without robots."""
        self.left: dict[str, int] = {}
        self._said: dict[str, int] = {}
        self._here: set[str] = set()
        self._lost_at: dict[str, float] = {}
        self._odd: dict[str, float] = {}
        self._reported: set[str] = set()

    def odd(self, robot: str, what: str, here: bool, now: float) -> None:
        """Take note that something is the matter with a robot that is there, or no longer.

        Args:
            robot: of any process.
            what: is the matter.
            here: whether it is.
            now: seconds of the node's clock.
        """
        words = f"{robot!r}: {what}"
        if here:
            self._odd.setdefault(words, now)
        else:
            self._odd.pop(words, None)
            self._reported.discard(words)

    def oddities(self) -> tuple[str, ...]:
        """Return what is the matter, in words."""
        return tuple(self._odd)

    def lasting_oddities(self, now: float) -> tuple[str, ...]:
        """Return what has been the matter for long, each once."""
        found = [
            words
            for words, since in self._odd.items()
            if words not in self._reported and now >= since + DOUBLE_SECONDS
        ]
        self._reported.update(found)
        return tuple(found)

    def next_oddity(self) -> float:
        """Return when `lasting_oddities` may have one; inf: never."""
        untold = (since for words, since in self._odd.items() if words not in self._reported)
        return min((since + DOUBLE_SECONDS for since in untold), default=float("inf"))

    def noticed(self, robot: str, here: bool, now: float) -> None:
        """Take note that a robot can be reached, or no longer."""
        if here:
            self._here.add(robot)
            self._said.pop(robot, None)
            self._lost_at.pop(robot, None)
        else:
            self._here.discard(robot)
            self._lost_at.setdefault(robot, now)

    @property
    def here(self) -> frozenset[str]:
        """Return the robots of other processes that can be reached."""
        return frozenset(self._here)

    def is_here(self, robot: str) -> bool:
        """Return whether a robot can be reached."""
        return robot in self._here

    def are_here(self, robots: Iterable[str]) -> bool:
        """Return whether any of these robots can be reached."""
        return not self._here.isdisjoint(robots)

    def is_unseen(self, robot: str) -> bool:
        """Return whether a robot was never present, and has announced its end to no robot here."""
        return not self.is_here(robot) and not self.is_gone(robot)

    def is_gone(self, robot: str) -> bool:
        """Return whether a robot has ended, or was there and can no longer be reached."""
        return self.has_ended(robot) or robot in self._lost_at

    def has_ended(self, robot: str) -> bool:
        """Return whether a robot has ended, as it says itself, or others say while it is not here."""
        return robot in self.left or robot in self._said

    def ended(self) -> dict[str, int]:
        """Return the robots that have ended, each with its latest logical time."""
        return {**self._said, **self.left}

    def hear_say(self, robot: str, lamport: int) -> bool:
        """Take note that others say that a robot has ended; return whether they are believed.

        One that is here says so itself.
        """
        if robot not in self._here:
            self._said[robot] = lamport
        return robot not in self._here

    def long_lost_at(self, robot: str) -> float | None:
        """Return when a robot is lost for long unless it comes back; None: it is not lost."""
        lost_at = self._lost_at.get(robot)
        return None if lost_at is None else lost_at + LEASE_SECONDS


def refuse_oddities(watching: Watching, settle: float, now: Callable[[], float]) -> None:
    """Return when the robots present have had no conflict for so long.

    Raises:
        Unwelcome: there is one, and it does not end.
    """
    begun = now()
    while (left := begun + settle - now()) > 0:
        time.sleep(min(left, 0.05))
    while settle and (found := watching.oddities()):
        if now() - begun > settle + DOUBLE_SECONDS:
            raise Unwelcome("; ".join(found))
        time.sleep(0.05)


class Roster:
    """What the first robot knows: who is ready, and when all begin."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        """Create without robots."""
        self._now = now
        self._ready: set[str] = set()
        self._asked: dict[str, float] = {}
        self._round: dict[str, float] = {}
        self._at = 0.0

    def answer(self, asked: Meet, gone: Callable[[str], bool] = lambda robot: False) -> Answer:
        """Record whether a robot is ready; return the time, the ready robots, and when all begin.

        Args:
            asked: by the robot.
            gone: whether a robot that was ready has ended since, or is out of reach.
        """
        now = self._now()
        if not self._at:
            self._note(asked, gone, now)
            if asked.robots and len(self._ready) >= asked.robots:
                self._at = now + self._notice()
        ready = tuple(sorted(self._ready))
        if self._at:
            return Answer("begin", time=now, at=self._at, ready=ready)
        why = f"{len(ready)} of {asked.robots} are ready: {', '.join(map(ascii, ready))}"
        return Answer("wait", time=now, why=why, ready=ready)

    def _notice(self) -> float:
        slowest = max((self._round.get(robot, 0.0) for robot in self._ready), default=0.0)
        return max(NOTICE_SECONDS, ROUNDS * slowest)

    def _note(self, asked: Meet, gone: Callable[[str], bool], now: float) -> None:
        round = now - self._asked.get(asked.id.sender, now)
        self._asked[asked.id.sender] = now
        if round <= LONGEST_ROUND:
            self._round[asked.id.sender] = round
        self._ready = {robot for robot in self._ready if not gone(robot)}
        if asked.robots:
            self._ready.add(asked.id.sender)
        else:
            self._ready.discard(asked.id.sender)
