"""Starting together: all robots are ready, then all begin at one instant.

The robot whose name comes first keeps the list of ready robots, and sets the instant by its clock.
The others measure by round trips how far their clocks are from that one: half of the shortest round
trip bounds the error. A robot that has waited too long is no longer ready, and names the robots that have not
come; if all begin at that very moment, it begins, too.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from .messages import Answer, Meet

if TYPE_CHECKING:
    from .node import Node

PATIENCE = 300.0
"""Real seconds that robots usually wait for each other."""

GLANCE_SECONDS = 0.05
ROUND_TRIPS = 16
SLOWEST_SECONDS = 2.0
FAREWELLS = 3
"""How often a robot that waits no longer says so at most, until it is answered."""


class Incomplete(Exception):  # noqa: N818  # what the team is
    """Not all robots that were to begin together have come in time."""


@dataclass(frozen=True, slots=True)
class Beginning:
    """How well a robot began together with the others.

    Attributes:
        offset: seconds by which the first robot's clock is ahead of this one.
        uncertainty: seconds by which that may be wrong.
        late: seconds that passed between the instant and this robot's beginning.
    """

    offset: float
    uncertainty: float
    late: float

    @property
    def skew(self) -> float:
        """Return by how many seconds at most this robot began away from the instant."""
        return self.late + self.uncertainty

    def __str__(self) -> str:
        """Return it in milliseconds, as printed."""
        return (
            f"at most {self.skew * 1e3:.1f} ms from the instant: {self.late * 1e3:.1f} ms late, by clocks"
            f" {self.offset * 1e3:.1f} ms apart, known to {self.uncertainty * 1e3:.1f} ms"
        )


def begin_together(
    node: Node,
    robot: str,
    robots: Sequence[str],
    guard: Callable[[str], None],
    now: Callable[[], float] = time.monotonic,
    beside: Sequence[str] = (),
    patience: float = PATIENCE,
) -> Beginning:
    """Return when all robots begin, with the accuracy of this one.

    Args:
        node: this process's end of the bus.
        robot: one of its robots, which is ready.
        robots: all that begin together.
        guard: called repeatedly meanwhile with what is still missing; raises what should end it.
        now: the clock of the node.
        beside: further robots of this process that are ready and begin with this one.
        patience: real seconds to wait for the others.

    Raises:
        Incomplete: not all are ready by then; names those that are not.
    """
    calls = [_Asking(node, each, robots, guard, now) for each in (robot, *beside)]
    asking = calls[0]
    _gather(calls, guard, time.monotonic() + patience)
    if not asking.at:
        raise Incomplete(f"after {patience:g} s {_absent(node, asking.missing())}")
    while asking.trips < ROUND_TRIPS and asking.left() > GLANCE_SECONDS:
        guard("")
        asking.ask()
    while (left := asking.left()) > 0:
        guard("")
        time.sleep(min(left, GLANCE_SECONDS))
    return Beginning(asking.offset, asking.shortest / 2, -asking.left())


def _gather(calls: Sequence[_Asking], guard: Callable[[str], None], until: float) -> None:
    """Announce that robots are ready, until the first of them knows the instant or time is up."""
    try:
        _call_together(calls, guard, until)
        _part(calls)
    except BaseException:
        for each in calls:
            each.leave_word()
        raise


def _call_together(calls: Sequence[_Asking], guard: Callable[[str], None], until: float) -> None:
    asking, why = calls[0], "no answer yet"
    while not asking.at and time.monotonic() < until:
        guard(why)
        why = asking.ask()
        for each in calls[1:]:
            if asking.lacks(each):
                each.ask()
        if not asking.at:
            time.sleep(GLANCE_SECONDS)


def _part(calls: Sequence[_Asking]) -> None:
    """Announce that robots are no longer ready, unless all begin."""
    asking = calls[0]
    for each in calls:
        if not asking.at and each.may_be_listed():
            each.abort()
            asking.at = asking.at or each.at


def _absent(node: Node, missing: Sequence[str]) -> str:
    words = f"{', '.join(map(ascii, missing))} {'is' if len(missing) == 1 else 'are'} not ready"
    unseen = node.unseen(missing)
    return words + (f"; never seen on the bus: {', '.join(map(ascii, unseen))}" if unseen else "")


class _Asking:
    """Asks the first robot for the time, and keeps the best answer.

    Attributes:
        at: when all begin, by the first robot's clock; 0: unknown.
        offset: seconds by which that clock is ahead, measured in a round trip of the `shortest` time.
        trips: round trips since the instant is known.
    """

    def __init__(
        self,
        node: Node,
        robot: str,
        robots: Sequence[str],
        guard: Callable[[str], None],
        now: Callable[[], float],
    ) -> None:
        self.at = self.offset = 0.0
        self.shortest = float("inf")
        self.trips = 0
        self._received = False
        self._ready: tuple[str, ...] = ()
        self._robot = robot
        self._robots, self._first = sorted(set(robots)), min(robots)
        self._node, self._guard, self._now = node, guard, now
        self._request = Meet(node.id_of(robot), len(self._robots))

    def left(self) -> float:
        """Return the seconds until the instant, by this robot's clock."""
        return self.at - self.offset - self._now()

    def lacks(self, other: _Asking) -> bool:
        """Return whether the first robot has answered, but does not know that another one is ready."""
        return bool(self._ready) and other._robot not in self._ready

    def missing(self) -> list[str]:
        """Return the robots that are not ready, or are out of reach where no list of ready robots arrives."""
        if not self._ready:
            return [each for each in self._robots if each in self._node.missing(self._robots)] or [
                self._first
            ]
        return [each for each in self._robots if each not in self._ready]

    def ask(self) -> str:
        """Ask once; return what is missing, if anything."""
        answer = self._answer_to(self._request)
        if answer is None:
            self._ready = ()
            return f"no answer from {self._first!r}"
        self._received, self._ready = True, answer.ready
        missing = ", ".join(map(ascii, self.missing()))
        return f"{answer.why}; not yet: {missing}" if answer.why and missing else answer.why

    def may_be_listed(self) -> bool:
        """Return whether the first robot may know that this one is ready; its answers may all be lost."""
        return self._received or not self._node.missing([self._first])

    def abort(self) -> None:
        """Announce that the robot waits no longer; where all begin at this very moment, it does, too."""
        for _ in range(FAREWELLS):
            if self._answer_to(replace(self._request, robots=0)) is not None:
                return

    def leave_word(self) -> None:
        """Announce that the robot waits no longer, without waiting for an answer."""
        farewell = replace(self._request, robots=0)
        self._node.ask_once(farewell.id.sender, self._first, farewell, lambda answer: None)

    def _answer_to(self, request: Meet) -> Answer | None:
        found: list[tuple[Answer, float]] = []
        answered = threading.Event()
        asked = self._now()

        def take(answer: Answer) -> None:
            found.append((answer, self._now()))
            answered.set()

        self._node.ask_once(request.id.sender, self._first, request, take)
        while not answered.wait(GLANCE_SECONDS) and self._now() - asked < SLOWEST_SECONDS:
            self._guard("")
        if not found:
            return None
        self._learn(found[0][0], asked, found[0][1])
        return found[0][0]

    def _learn(self, answer: Answer, asked: float, received: float) -> None:
        if answer.what == "begin":
            self.at = answer.at
            self.trips += 1
        if received - asked < self.shortest:
            self.shortest = received - asked
            self.offset = answer.time - (asked + received) / 2
