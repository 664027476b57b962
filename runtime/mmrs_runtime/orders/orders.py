"""Orders of people to robots: given by any thread, obeyed by the robot's own, and confirmed by it."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ..questions import Questions

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

LONGEST_SECONDS = 1e9

ENDINGS = frozenset({RETURN, LAND, STOP})
"""Orders that end a robot's program."""


@dataclass(frozen=True, slots=True)
class OrderKind:
    """Something that a robot is to do.

    Attributes:
        name: one of `ORDERS`.
        question, answer: of ``answer``.
    """

    name: str
    question: str = ""
    answer: bool = False


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


class Receipt:
    """One order to one robot, until the robot has obeyed it.

    Attributes:
        order: its kind. robot: its receiver.
        confirmed: whether the robot has obeyed; None: not yet known. why: in words, why not, or how.
        seconds: real seconds from the order to its confirmation.
    """

    def __init__(self, robot: str, order: OrderKind, answered: Callable[[Receipt], None]) -> None:
        """Begin to count the seconds; `answered` is called once, by the thread that answers."""
        self.robot = robot
        self.order = order
        self.confirmed: bool | None = None
        self.why = ""
        self.seconds = 0.0
        self._begun = time.monotonic()
        self._answered = answered
        self._lock = threading.Lock()

    def confirm(self, how: str = "") -> None:
        """Confirm that the robot has obeyed; only the first answer counts."""
        self._answer(True, how)

    def refuse(self, why: str) -> None:
        """Refuse, with the reason; only the first answer counts."""
        self._answer(False, why)

    def _answer(self, confirmed: bool, why: str) -> None:
        with self._lock:
            if self.confirmed is not None:
                return
            self.confirmed, self.why = confirmed, why
            self.seconds = time.monotonic() - self._begun
        self._answered(self)


class Inbox:
    """The orders to one robot that it has not looked at yet.

    Attributes:
        questions: that its choices ask, which take answers at once; None: answers wait like other orders.
    """

    def __init__(
        self,
        robot: str,
        *,
        questions: Questions | None = None,
        arrived: Callable[[], None] = lambda: None,
        answered: Callable[[Receipt], None] = lambda receipt: None,
    ) -> None:
        """Begin empty.

        Args:
            robot: whose it is.
            questions: that its choices ask.
            arrived: called, from any thread, when there is something new.
            answered: called, from any thread, when an order was obeyed or refused.
        """
        self.robot = robot
        self.questions = questions
        self._arrived = arrived
        self._answered = answered
        self._waiting: deque[Receipt] = deque()
        self._closed = ""
        self._lock = threading.Lock()

    def give(self, order: OrderKind, reply: Callable[[Receipt], None] = lambda receipt: None) -> Receipt:
        """Give the robot an order; `reply` is called when it has obeyed or refused."""

        def answered(receipt: Receipt) -> None:
            self._answered(receipt)
            reply(receipt)

        receipt = Receipt(self.robot, order, answered)
        if order.name == ANSWER and self.questions is not None and not self._closed:
            if why := self.questions.give(order.question, order.answer):
                receipt.refuse(why)
            else:
                receipt.confirm()
        elif not self._keep(receipt):
            receipt.refuse(self._closed)
        self._arrived()
        return receipt

    def take(self) -> Receipt | None:
        """Return the oldest order that was not taken yet; None where there is none."""
        try:
            return self._waiting.popleft()
        except IndexError:
            return None

    def close(self, why: str) -> None:
        """Refuse all orders from now on, and those that were not taken."""
        with self._lock:
            self._closed = why
        while (receipt := self.take()) is not None:
            receipt.refuse(why)

    def _keep(self, receipt: Receipt) -> bool:
        """Put an order where the robot takes it from, unless the inbox is closed."""
        with self._lock:
            if not self._closed:
                self._waiting.append(receipt)
            return not self._closed
