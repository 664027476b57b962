"""What people order while robots run: taken from any thread, obeyed by the interpreter."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

HOLD, RESUME, RETURN, LAND, STOP, ANSWER = "hold", "resume", "return", "land", "stop", "answer"
KINDS = (HOLD, RESUME, RETURN, LAND, STOP, ANSWER)
ENDINGS: Mapping[str, str] = {RETURN: "RETURN", LAND: "LAND", STOP: "HOLD"}
"""Orders that end a robot's program, and the response that it then gives."""


@dataclass(slots=True)
class Order:
    """An order to some robots.

    Attributes:
        kind: one of KINDS.
        robots: who has to obey.
        question, answer: of an answer.
        confirmed: by robot, real seconds until its vehicle had obeyed.
        refused: by robot, why it does not obey.
        settled: set once every robot has done one or the other.
    """

    kind: str
    robots: tuple[str, ...]
    question: str = ""
    answer: bool = False
    confirmed: dict[str, float] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    settled: threading.Event = field(default_factory=threading.Event)
    given: float = field(default_factory=time.monotonic)

    @property
    def open(self) -> tuple[str, ...]:
        """Return the robots that have neither obeyed nor refused yet."""
        return tuple(robot for robot in self.robots if robot not in {*self.confirmed, *self.refused})

    def confirm(self, robot: str) -> None:
        """Note that the vehicle of a robot has obeyed."""
        self.confirmed[robot] = round(time.monotonic() - self.given, 4)
        self._settle()

    def refuse(self, robot: str, why: str) -> None:
        """Note that a robot does not obey."""
        self.refused[robot] = why
        self._settle()

    def _settle(self) -> None:
        if not self.open:
            self.settled.set()


class Orders:
    """The orders of a run that have been given and not been looked at."""

    def __init__(self) -> None:
        self.called: Callable[[], None] = lambda: None
        self._waiting: deque[Order] = deque()

    def give(self, kind: str, robots: Iterable[str], *, question: str = "", answer: bool = False) -> Order:
        """Have robots obey; return the order, which tells who has; from any thread or signal handler.

        Raises:
            ValueError: if there is no such order.
        """
        if kind not in KINDS:
            raise ValueError(f"order '{kind}': there are {', '.join(KINDS)}")
        order = Order(kind, tuple(robots), question, answer)
        self._waiting.append(order)
        self.called()
        return order

    def taken(self) -> tuple[Order, ...]:
        """Return the orders that were given since this was asked last."""
        found: list[Order] = []
        while self._waiting:
            found.append(self._waiting.popleft())
        return tuple(found)
