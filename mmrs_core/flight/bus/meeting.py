"""Beginning together: all robots are ready, then all begin at one instant.

The robot whose name comes first keeps the list of who is ready, and sets the instant by its clock.
The others measure by round trips how far their clocks are from that one: half of the shortest round
trip is how wrong that can be.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .words import Answer, CommandId, Meet

if TYPE_CHECKING:
    from .node import Node

NOTICE_SECONDS = 1.0
"""How long before the instant it is set, so that everybody hears of it and can measure."""

GLANCE_SECONDS = 0.05
ROUND_TRIPS = 16
SLOWEST_SECONDS = 2.0


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


class Meeting:
    """What the first robot knows: who is ready, and when all begin."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        """Know of nobody."""
        self._now = now
        self._ready: set[str] = set()
        self._at = 0.0

    def answer(self, asked: Meet) -> Answer:
        """Note that a robot is ready; say what the time is, and when all begin if that is known."""
        self._ready.add(asked.id.sender)
        now = self._now()
        if not self._at and len(self._ready) >= asked.robots:
            self._at = now + NOTICE_SECONDS
        if self._at:
            return Answer("begin", time=now, at=self._at)
        here = ", ".join(map(ascii, sorted(self._ready)))
        return Answer("wait", time=now, why=f"{len(self._ready)} of {asked.robots} are ready: {here}")


def begin_together(
    node: Node,
    robot: str,
    run: str,
    robots: Sequence[str],
    guard: Callable[[str], None],
    now: Callable[[], float] = time.monotonic,
    beside: Sequence[str] = (),
) -> Beginning:
    """Return when all robots begin, with how well this one does.

    Args:
        node: this process's end of the bus.
        robot: one of its robots, which is ready.
        run: identifier of the run.
        robots: all that begin together.
        guard: called again and again meanwhile with what is still missing; raises what should end it.
        now: the clock of the node.
        beside: further robots of this process that are ready and begin with this one.
    """
    for other in beside:
        _Asking(node, other, run, min(robots), len(set(robots)), now).report(guard)
    asking = _Asking(node, robot, run, min(robots), len(set(robots)), now)
    why = "nobody has answered yet"
    while not asking.at or (asking.trips < ROUND_TRIPS and asking.left() > GLANCE_SECONDS):
        guard(why)
        why = asking.ask() or why
        if not asking.at:
            time.sleep(GLANCE_SECONDS)
    while (left := asking.left()) > 0:
        guard("")
        time.sleep(min(left, GLANCE_SECONDS))
    return Beginning(asking.offset, asking.shortest / 2, -asking.left())


class _Asking:
    """Asks the first robot for the time, and keeps the best answer."""

    def __init__(
        self, node: Node, robot: str, run: str, first: str, robots: int, now: Callable[[], float]
    ) -> None:
        self.at = self.offset = 0.0
        self.shortest = float("inf")
        self.trips = 0
        self._node, self._first, self._now = node, first, now
        self._request = Meet(CommandId(run, robot, node.incarnation, 0), robots)

    def left(self) -> float:
        """Return the seconds until the instant, by this robot's clock."""
        return self.at - self.offset - self._now()

    def ask(self) -> str:
        """Ask once; return what is missing, if anything."""
        found: list[tuple[Answer, float]] = []
        asked = self._now()
        sender = self._request.id.sender

        def take(answer: Answer) -> None:
            found.append((answer, self._now()))

        self._node.ask_once(sender, self._first, self._request, take)
        while not found and self._now() - asked < SLOWEST_SECONDS:
            time.sleep(0.0005)
        if not found:
            return f"no answer from {self._first!a}"
        self._learn(found[0][0], asked, found[0][1])
        return found[0][0].why

    def report(self, guard: Callable[[str], None]) -> None:
        """Have it known that the robot is ready."""
        while self.shortest == float("inf"):
            guard(self.ask() or "nobody has answered yet")

    def _learn(self, answer: Answer, asked: float, heard: float) -> None:
        if answer.what == "begin":
            self.at = answer.at
            self.trips += 1
        if heard - asked < self.shortest:
            self.shortest = heard - asked
            self.offset = answer.time - (asked + heard) / 2
