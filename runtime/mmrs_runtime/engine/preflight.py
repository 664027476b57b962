"""Preflight: orders before anything moves, and robots that do not get ready.

Nothing begins without all robots; logs and black boxes then record why.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TYPE_CHECKING

from ..faults import LINK_LOST, ORDERED, PEER_LOST, STOPPED
from ..orders.orders import ANSWER, BATTERY_CHANGED, ENDINGS, HOLD, RESUME, STOP, Order
from ..policies import NOTHING
from ..vehicle import Fault, Vehicle

if TYPE_CHECKING:
    from .live import LiveRun


class NotReadyError(Exception):  # the word that people read
    """Robots do not get ready; says why of each. Attributes: `faults` by robot."""

    def __init__(self, faults: Mapping[str, Fault]) -> None:
        lines = (f"robot '{id}': does not get ready: {reason_of(found)}" for id, found in faults.items())
        super().__init__("; ".join(lines))
        self.faults = faults

    @property
    def link_lost(self) -> bool:
        """Return whether the link to one of them was lost."""
        return any(found.which == LINK_LOST for found in self.faults.values())


def reason_of(found: Fault) -> str:
    """Return in words why a robot does not get ready."""
    return found.reason or found.which


def record(
    robots: Mapping[str, Vehicle], faults: Mapping[str, Fault], fail: Callable[[str, str], None]
) -> None:
    """Record in logs which programs have ended, and in black boxes why none begins.

    A vehicle that never sent a message may be there the next time: no log records that its program has ended.

    Args:
        robots: all that were to begin.
        faults: by robot that does not get ready.
        fail: logs that a robot's program has ended, by which fault.
    """
    for id, found in faults.items():
        robot = robots[id]
        note(robot, found.which, reason_of(found))
        if found.which != LINK_LOST or robot.status():
            fail(id, found.which)
    missing = ", ".join(f"'{id}'" for id in faults)
    note_alone((robot for id, robot in robots.items() if id not in faults), f"{missing} did not get ready")


def note_alone(robots: Iterable[Vehicle], why: str) -> None:
    """Record in black boxes that robots have not begun, since others are not ready."""
    for robot in robots:
        note(robot, PEER_LOST, f"has not begun: {why}")


def note(robot: Vehicle, what: str, why: str) -> None:
    """Record in a robot's black box why it receives no command."""
    robot.note("decision", {"what": what, "why": why, "response": NOTHING})


class EarlyOrders:
    """Orders that come before anything moves, and while all robots stand on the ground.

    Attributes:
        held: robots that are not to begin.
    """

    def __init__(self, live_run: LiveRun, robots: Mapping[str, Vehicle]) -> None:
        self.held: set[str] = set()
        self._live_run, self._robots = live_run, robots
        self._open: list[Order] = []
        self._later: list[Order] = []
        self._ended: dict[str, Order] = {}

    def look(self, unsettled: Collection[str]) -> None:
        """Confirm to whom that is ready, and stays, that it does; once all are to end, nothing begins.

        Args:
            unsettled: robots whose vehicles are not known to stay where they are.

        Raises:
            KeyboardInterrupt: if every robot was ordered to end its program.
        """
        for order in self._live_run.orders.taken():
            self._take(order)
        for order in self._open:
            for id in order.open:
                if id not in unsettled or self._rests(id):
                    order.confirm(id)
        self._open = [order for order in self._open if order.open]
        if self._ended.keys() >= set(self._live_run.connect):
            self._live_run.say("stopped before anything moved")
            for order in self._open:
                for id in order.open:
                    order.confirm(id)
            self._record_ends()
            raise KeyboardInterrupt

    def _record_ends(self) -> None:
        """Log that orders have ended the programs; an interrupted run leaves no entry."""
        for id, order in self._ended.items():
            if id in self._live_run.connect and not order.interrupt:
                self._live_run.fail(id, STOPPED if order.kind == STOP else ORDERED)

    def pass_on(self) -> None:
        """Hand the orders that remain, and the answers, to the engine before later orders."""
        held = tuple(sorted(self.held))
        first = (Order(HOLD, held),) if held else ()
        self._live_run.orders.put_back((*first, *self._later))

    def give_up(self, why: str) -> None:
        """Refuse orders that will not be obeyed any more."""
        for order in (*self._open, *self._later):
            for id in order.open:
                order.refuse(id, why)

    def _take(self, order: Order) -> None:
        for id in set(order.robots) - set(self._live_run.connect):
            order.refuse(id, "no such robot here")
        if order.kind == RESUME:
            self._let_go(order)
            return
        if order.kind == BATTERY_CHANGED:
            for id in order.open:
                order.refuse(id, "it has not begun: its battery is compared when it gets ready")
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
        return robot is not None and robot.status().get("armed") is False

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
