"""Who is ready to begin together, as the robot knows that keeps the list."""

from __future__ import annotations

import time
from collections.abc import Callable

from .words import Answer, Meet

NOTICE_SECONDS = 1.0
"""How long before the instant it is set at least, so that everybody hears of it and can measure."""

ROUNDS = 3
"""Of the slowest robot's questions fit in before the instant where links are slow."""

LONGEST_ROUND = 4.0
"""Seconds between two questions of a robot that tell something of its link; it was away for longer ones."""


class Roster:
    """What the first robot knows: who is ready, and when all begin."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        """Know of nobody."""
        self._now = now
        self._ready: set[str] = set()
        self._asked: dict[str, float] = {}
        self._round: dict[str, float] = {}
        self._at = 0.0

    def answer(self, asked: Meet, gone: Callable[[str], bool] = lambda robot: False) -> Answer:
        """Note that a robot is ready, or no longer; say what the time is, who is ready, and when all begin.

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
