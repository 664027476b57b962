"""What people order while robots run: given by any thread, obeyed by the engine, and how that is written."""

from __future__ import annotations

import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import FrameType

from ..vehicle import Vehicle

HOLD = "hold"
RESUME = "resume"
RETURN = "return"
LAND = "land"
STOP = "stop"
ANSWER = "answer"
BATTERY_CHANGED = "battery-changed"
STATUS = "status"

ORDERS = {
    HOLD: "stop moving and wait",
    RESUME: "continue after a hold or a battery change",
    RETURN: "abort the program, retrace the path and return home",
    LAND: "abort the program and land",
    STOP: "abort the program with the --on-stop response",
    ANSWER: "answer the question of a Choice",
    BATTERY_CHANGED: "confirm that the battery was changed for a full one",
    STATUS: "print the state of each robot",
}
"""What can be ordered, and what it means."""

KINDS = (HOLD, RESUME, RETURN, LAND, STOP, ANSWER, BATTERY_CHANGED)
ENDINGS: Mapping[str, str] = {RETURN: "RETURN", LAND: "LAND", STOP: "HOLD"}
"""Orders that end a robot's program, and the response that it then gives."""

LONGEST_SECONDS = 1e9


def ordered(name: str, question: str, answer: bool) -> dict[str, object]:
    """Return what was ordered, or answered to which question, as a black box has it."""
    asked = {"question": question, "says": "yes" if answer else "no"} if name == ANSWER else {}
    return {"order": name, **asked}


def is_answer(reply: Mapping[str, object], name: object) -> bool:
    """Return whether this is what a robot says to an order of that name, as JSON has it."""
    seconds = reply.get("seconds")
    timed = (
        isinstance(seconds, int | float) and not isinstance(seconds, bool) and 0 <= seconds < LONGEST_SECONDS
    )
    texts = isinstance(reply.get("why"), str) and reply.get("order") == name
    return timed and texts and isinstance(reply.get("confirmed"), bool)


@dataclass(slots=True, eq=False)
class Order:
    """An order to some robots.

    Attributes:
        kind: one of KINDS.
        robots: receivers.
        question, answer: of an answer.
        interrupt: whether it is an interrupt of the run rather than an order to the robots.
        confirmed: by robot, real seconds until its vehicle had obeyed.
        refused: by robot, why it does not obey.
        settled: set once every robot has done one or the other.
        answered: called with a robot, and why it refuses, or None: it has obeyed.
        vehicles: by robot; their black boxes record the outcome before it is reported.
        responses: by robot, the response that shows that it obeys, where its program has ended, or is to end.
    """

    kind: str
    robots: tuple[str, ...]
    question: str = ""
    answer: bool = False
    answered: Callable[[str, str | None], None] = lambda robot, why: None
    interrupt: bool = False
    confirmed: dict[str, float] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    settled: threading.Event = field(default_factory=threading.Event)
    given: float = field(default_factory=time.monotonic)
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)
    responses: dict[str, str] = field(default_factory=dict)

    @property
    def open(self) -> tuple[str, ...]:
        """Return the robots that have neither obeyed nor refused yet."""
        return tuple(robot for robot in self.robots if robot not in {*self.confirmed, *self.refused})

    def confirm(self, robot: str) -> None:
        """Note that the vehicle of a robot has obeyed."""
        if robot in self.open:
            self.confirmed[robot] = round(time.monotonic() - self.given, 4)
            self._settle(robot, None)

    def refuse(self, robot: str, why: str) -> None:
        """Note that a robot does not obey."""
        if robot in self.open:
            self.refused[robot] = why
            self._settle(robot, why)

    def _settle(self, robot: str, why: str | None) -> None:
        if (vehicle := self.vehicles.get(robot)) is not None:
            content = ordered(self.kind, self.question, self.answer)
            reported = {"confirmed": why is None, "seconds": self.confirmed.get(robot), "why": why or ""}
            vehicle.note("order", content | reported)
        self.answered(robot, why)
        if not self.open:
            self.settled.set()


class Orders:
    """The orders of a run that have been given and not been looked at.

    Attributes:
        on_stop: the response of robots that are ordered to stop, a literal of PolicyResponse.
        called: called, from any thread, when there is a new one.
        vehicles: of the robots that are there, by robot.
    """

    def __init__(self, on_stop: str = "HOLD") -> None:
        self.on_stop = on_stop
        self.called: Callable[[], None] = lambda: None
        self.vehicles: Mapping[str, Vehicle] = {}
        self._waiting: deque[Order] = deque()
        self._closed = ""

    @property
    def waiting(self) -> bool:
        """Return whether an order was given that was not taken yet."""
        return bool(self._waiting)

    def give(
        self,
        kind: str,
        robots: Iterable[str],
        *,
        question: str = "",
        answer: bool = False,
        answered: Callable[[str, str | None], None] = lambda robot, why: None,
        interrupt: bool = False,
    ) -> Order:
        """Give an order to robots, from any thread or signal handler; return it, with results as they come.

        Raises:
            ValueError: if there is no such order.
        """
        if kind not in KINDS:
            raise ValueError(f"order '{kind}': there are {', '.join(KINDS)}")
        order = Order(
            kind, tuple(dict.fromkeys(robots)), question, answer, answered, interrupt, vehicles=self.vehicles
        )
        self._waiting.append(order)
        if self._closed:
            self.close(self._closed)
        self.called()
        return order

    def put_back(self, orders: Sequence[Order]) -> None:
        """Put orders that were taken back before those that were given since."""
        self._waiting.extendleft(reversed(orders))
        self.called()

    def close(self, why: str) -> None:
        """Refuse all orders that were not taken yet, and those to come."""
        self._closed = why
        for order in self.taken():
            for robot in order.open:
                order.refuse(robot, why)

    def response(self, kind: str) -> str:
        """Return what a robot does when its program is ended by such an order."""
        return self.on_stop if kind == STOP else ENDINGS[kind]

    def taken(self) -> tuple[Order, ...]:
        """Return the orders that were given since this was asked last."""
        found: list[Order] = []
        while self._waiting:
            found.append(self._waiting.popleft())
        return tuple(found)


@contextmanager
def stopping(orders: Orders, robots: tuple[str, ...], say: Callable[[str], None]) -> Iterator[None]:
    """Stop the robots on the first interrupt; the second one ends the wait for them.

    A terminal that closes gives no order: robots continue. Outside the main thread, which alone receives
    signals, nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    seen: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        seen.append(number)
        if len(seen) > 1:
            raise KeyboardInterrupt
        orders.give(STOP, robots, interrupt=True)
        say("stopping; interrupt again to end without waiting for robots, and those that pilots have")

    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    if hasattr(signal, "SIGHUP"):
        before[signal.SIGHUP] = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
