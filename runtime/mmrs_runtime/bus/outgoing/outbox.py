"""What one process's end of the bus has still to tell others: notifies, and news of its robots."""

from __future__ import annotations

from collections.abc import Iterable

from ..troubles import SORE_SECONDS, Net
from .errands import Errand, Message, Notice


class Outbox:
    """Holds errands until they are over. Not thread-safe: whoever has it guards it."""

    def __init__(self, net: Net) -> None:
        """Hold nothing; `net` catches what fails."""
        self._net = net
        self._errands: list[Errand | Notice] = []
        self._farewells: dict[str, Notice] = {}

    @property
    def has_farewells(self) -> bool:
        """Return whether a robot that has ended is still telling others so."""
        return bool(self._farewells)

    @property
    def due(self) -> float:
        """Return when there is something to send; inf: never."""
        return min((errand.due for errand in self._errands), default=float("inf"))

    def add(self, errand: Errand | Notice) -> None:
        """Have something sent."""
        self._errands.append(errand)

    def bid_farewell(self, robot: str, farewell: Notice) -> None:
        """Have others told that a robot has ended."""
        self._farewells[robot] = farewell
        self._errands.append(farewell)

    def take_due(self, now: float) -> list[tuple[Errand | Notice, Message]]:
        """Return what is to be sent now, each with what its answer is for."""
        return [(errand, message) for errand in self._errands for message in self._due_of(errand, now)]

    def gone(self, robot: str) -> None:
        """Take note that a robot has ended: it need not answer any more."""
        for errand in self._errands:
            errand.gone(robot)

    def back(self, robot: str, now: float) -> None:
        """Take note that a robot can be reached: it is asked at once."""
        for errand in self._errands:
            errand.back(robot, now)

    def sweep(self) -> list[str]:
        """Forget what is over; return the robots that have said farewell to everybody."""
        self._errands = [errand for errand in self._errands if not errand.is_over]
        gone = [robot for robot, notice in self._farewells.items() if notice.is_over]
        for robot in gone:
            del self._farewells[robot]
        return gone

    def _due_of(self, errand: Errand | Notice, now: float) -> Iterable[Message]:
        """Return what an errand has to send now; one that fails is left alone for a while."""
        with self._net.under("a notify on its way"):
            return errand.tick(now)
        errand.due = now + SORE_SECONDS
        return ()
