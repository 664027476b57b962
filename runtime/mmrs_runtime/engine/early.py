"""Orders that come while robots of a run in real time get ready."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

from ..faults import ORDERED, STOPPED
from ..vehicle import Vehicle
from .orders import ANSWER, ENDINGS, HOLD, RESUME, STOP, Order

if TYPE_CHECKING:
    from .live import Venture


class EarlyOrders:
    """Orders that come before anything moves, and while all robots stand on the ground.

    Attributes:
        held: robots that are not to begin.
    """

    def __init__(self, venture: Venture, robots: Mapping[str, Vehicle]) -> None:
        self.held: set[str] = set()
        self._venture, self._robots = venture, robots
        self._open: list[Order] = []
        self._later: list[Order] = []
        self._ended: dict[str, Order] = {}

    def look(self, unready: Collection[str]) -> None:
        """Confirm to whom that is ready, and stays, that it does; once all are to end, nothing begins.

        Args:
            unready: robots whose vehicles are not known to stay where they are.

        Raises:
            KeyboardInterrupt: if every robot was ordered to end its program.
        """
        for order in self._venture.orders.taken():
            self._take(order)
        for order in self._open:
            for id in order.open:
                if id not in unready or self._rests(id):
                    order.confirm(id)
        self._open = [order for order in self._open if order.open]
        if self._ended.keys() >= set(self._venture.connect):
            self._venture.say("stopped before anything moved")
            for order in self._open:
                for id in order.open:
                    order.confirm(id)
            self._record_ends()
            raise KeyboardInterrupt

    def _record_ends(self) -> None:
        """Log that orders have ended the programs; an interrupted run leaves no entry."""
        for id, order in self._ended.items():
            if id in self._venture.connect and not order.interrupt:
                self._venture.fail(id, STOPPED if order.kind == STOP else ORDERED)

    def pass_on(self) -> None:
        """Hand the orders that remain, and the answers, to the engine before later orders."""
        held = tuple(sorted(self.held))
        first = (Order(HOLD, held),) if held else ()
        self._venture.orders.put_back((*first, *self._later))

    def give_up(self, why: str) -> None:
        """Refuse orders that will not be obeyed any more."""
        for order in (*self._open, *self._later):
            for id in order.open:
                order.refuse(id, why)

    def _take(self, order: Order) -> None:
        for id in set(order.robots) - set(self._venture.connect):
            order.refuse(id, "no such robot here")
        if order.kind == RESUME:
            self._let_go(order)
            return
        if order.kind == HOLD:
            self.held.update(order.open)
        else:
            self._later.append(order)
        if order.kind in ENDINGS:
            self._ended.update(dict.fromkeys(order.open, order))
            self._take_back(order.open, "something else was ordered since")
        if order.kind != ANSWER:
            self._open.append(order)

    def _rests(self, id: str) -> bool:
        """Return whether a vehicle is seen to have its motors off, known to be the robot's or not."""
        robot = self._robots.get(id)
        return robot is not None and robot.told().get("armed") is False

    def _let_go(self, order: Order) -> None:
        for id in order.open:
            if id not in self.held:
                order.refuse(id, "it is not held")
            else:
                self._take_back((id,), "it is ordered to continue")
                order.confirm(id)

    def _take_back(self, robots: Collection[str], why: str) -> None:
        """Release held robots."""
        self.held.difference_update(robots)
        for order in self._open:
            for id in set(robots) & set(order.open) if order.kind == HOLD else ():
                order.refuse(id, why)
