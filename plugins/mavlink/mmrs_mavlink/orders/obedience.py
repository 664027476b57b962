"""Obeys orders in the middle of whatever a robot waits for."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import ORDERED, STOPPED, Fault, Stopped
from mmrs_runtime.orders.orders import ENDINGS, HOLD, RESUME, STOP, Inbox, Receipt

from ..vehicles import modes
from ..vehicles.vehicle import Vehicle

OVERTAKEN = "something else was ordered since"
GLANCE_SECONDS = 0.1
"""Real seconds between two looks into the inbox while the robot is held."""


class Again(Exception):  # noqa: N818  # no error: what was interrupted is to be done once more
    """The robot was held in the middle of a movement, and may now go on."""


class Ordered(Fault):
    """Somebody has ordered the robot to end its program.

    Attributes:
        receipt: of the order, which is to be confirmed when the vehicle obeys.
    """

    def __init__(self, receipt: Receipt) -> None:
        name = receipt.order.name
        super().__init__(STOPPED if name == STOP else ORDERED, f"{name} was ordered")
        self.receipt = receipt

    @property
    def response(self) -> str:
        """Return the response that was ordered; empty for a stop, which is as the robot was started."""
        return "" if self.receipt.order.name == STOP else self.receipt.order.name.upper()


class Obedience:
    """Takes orders from a robot's inbox, in the robot's own thread.

    A hold is obeyed inside the wait that it meets: the vehicle halts, the hold is confirmed, and the
    wait goes on after `resume`; a movement is then begun again. All other orders end the program. Whatever
    it takes from the inbox is answered: when the vehicle is seen to obey, when something else is ordered
    or happens before, or when it is closed.

    Attributes:
        ended: whether the program has ended, so that it cannot go on.
        held_for: seconds for which the robot was held so far, halting and going on included.
        hands_off: whether orders are looked at elsewhere, since the vehicle may not be told anything.
    """

    def __init__(self, inbox: Inbox, clock: Clock, stop: threading.Event, say: Callable[[str], None]) -> None:
        """Obey nobody yet: there is no vehicle; `stop` ends a hold, too."""
        self.ended = False
        self.hands_off = False
        self.held_for = 0.0
        self._inbox = inbox
        self._clock = clock
        self._stop = stop
        self._say = say
        self._vehicle: Vehicle | None = None
        self._early: list[Receipt] = []
        self._rests: Callable[[], bool] = lambda: False
        self._pending: Receipt | None = None
        self._obeyed: Callable[[], bool] = lambda: False
        self._held = False
        self._moving = False

    def begin(self, vehicle: Vehicle | None, rests: Callable[[], bool] = lambda: False) -> None:
        """Obey with a vehicle; None: there is none that may be told anything.

        Args:
            vehicle: of the robot.
            rests: whether what will be its vehicle is seen to have its motors off meanwhile.
        """
        self._vehicle, self._rests = vehicle, rests

    @property
    def has_vehicle(self) -> bool:
        """Return whether there is a vehicle that may be told something."""
        return self._vehicle is not None

    @property
    def held(self) -> bool:
        """Return whether it is held, or will be as soon as there is a vehicle; any thread may ask."""
        return self._held or bool(self._early)

    def check(self) -> None:
        """Obey what was ordered since.

        Raises:
            Ordered: the program is to end.
            Again: a movement was interrupted, and is to be begun again.
        """
        self._confirm_what_is_seen()
        if self._held or self.hands_off:
            return
        if self._early and self._vehicle is None and self._rests():
            for each in self._early:
                each.confirm("its motors are off, and stay so")
        if self._early and self._vehicle is not None:
            early, self._early = self._early, []
            self._hold(*early)
        if (receipt := self._inbox.take()) is not None:
            self._obey(receipt)

    def repeat(self, movement: Callable[[], None]) -> None:
        """Carry out a movement, and again each time that the robot was held in the middle of it."""
        while True:
            try:
                with self._in_movement():
                    movement()
                return
            except Again:
                continue

    def regain(self) -> None:
        """Have the vehicle go on with what it has left by itself.

        Raises:
            Again: a movement was interrupted, and is to be begun again.
        """
        if self._vehicle is None:
            return
        if self._moving and not self._held:
            self._vehicle.take_back()
            raise Again
        self._vehicle.regain()

    def expect(self, receipt: Receipt, obeyed: Callable[[], bool]) -> None:
        """Confirm an order as soon as the vehicle is seen to obey it; refuse the one before it."""
        if self._pending is not None and self._pending is not receipt:
            self._pending.refuse(OVERTAKEN)
        self._pending, self._obeyed = receipt, obeyed

    def conclude(self, undone: str = "") -> None:
        """Confirm the order that was expected: all is done, and was seen; or refuse it, as `undone` says."""
        pending, self._pending = self._pending, None
        if pending is not None and undone:
            pending.refuse(undone)
        elif pending is not None:
            pending.confirm()

    def overtake(self, by: Fault) -> None:
        """Refuse the order that was expected, as it is overtaken, unless that is what has happened."""
        if self._pending is not None and not (isinstance(by, Ordered) and by.receipt is self._pending):
            self.conclude(str(by))

    def awaits_resume(self, why_not: Callable[[str], str]) -> Receipt | None:
        """Return the order by which a robot on the ground is to go on, having looked into the inbox once.

        Args:
            why_not: tells what still keeps it from what was ordered; empty where nothing does.

        Raises:
            Ordered: nobody is to wait for it any longer.
        """
        receipt = self._inbox.take()
        if receipt is None:
            return None
        name = receipt.order.name
        if name == STOP:
            raise self._ends(receipt)
        if why := why_not(name):
            receipt.refuse(why)
        elif name == RESUME:
            return receipt
        else:
            receipt.confirm("it stands on the ground")
        return None

    def close(self, why: str) -> None:
        """Refuse what was taken and will not be obeyed any more."""
        self._forget_early(why)
        self.conclude(why)

    def refuse_all(self, why: str) -> None:
        """Refuse what was ordered since."""
        while (receipt := self._inbox.take()) is not None:
            receipt.refuse(why)

    @property
    def _over(self) -> bool:
        return self.ended and not self._moving

    def _obey(self, receipt: Receipt) -> None:
        name = receipt.order.name
        if name == HOLD:
            self._hold(receipt)
        elif name in ENDINGS:
            self._forget_early(OVERTAKEN)
            raise self._ends(receipt)
        elif name != RESUME:
            receipt.refuse("nobody here obeys that")
        elif self._early:
            self._forget_early("it is to go on")
            receipt.confirm("it goes on once there is a vehicle")
        else:
            receipt.refuse("its program has ended" if self._over else "it is not held")

    def _ends(self, receipt: Receipt) -> Ordered:
        """Return that an order ends the program; who carries it out knows how it is seen to be obeyed."""
        self.expect(receipt, lambda: False)
        return Ordered(receipt)

    def _forget_early(self, why: str) -> None:
        while self._early:
            self._early.pop().refuse(why)

    def _hold(self, receipt: Receipt, *others: Receipt) -> None:
        """Halt until something else is ordered; without a vehicle, as soon as there is one."""
        vehicle = self._vehicle
        if vehicle is None:
            self._say("will hold as soon as there is a vehicle")
            self._early.append(receipt)
            return
        self._held, moving, begun = True, self._moving, self._clock.now()
        taken = [receipt, *others]
        try:
            self._halt(vehicle, taken)
            if self._over:
                return
            self._say("is held; waits for an order")
            taken.append(self._await_resume(vehicle))
            self._go_on(vehicle, taken[-1])
        finally:
            self._held = False
            self.held_for += self._clock.now() - begun
            for each in taken:
                each.refuse("something else has happened")
        if moving:
            raise Again

    def _halt(self, vehicle: Vehicle, receipts: Sequence[Receipt]) -> None:
        """Have the vehicle halt, and confirm the orders to."""
        evidence = vehicle.evidence()
        self.expect(receipts[0], lambda: evidence.in_mode(modes.HOLD))
        vehicle.hold()
        for each in receipts:
            each.confirm()

    def _go_on(self, vehicle: Vehicle, receipt: Receipt) -> None:
        """Have the vehicle be steered again, and confirm the order to."""
        vehicle.carry_on()
        receipt.confirm()
        self._say("goes on")

    def _await_resume(self, vehicle: Vehicle) -> Receipt:
        """Return the order to go on; a stop ends the waiting unless it came before the hold."""
        stopped = self._stop.is_set()
        while stopped or not self._stop.is_set():
            vehicle.rest(GLANCE_SECONDS * self._clock.speedup)
            receipt = self._inbox.take()
            if receipt is None:
                continue
            if receipt.order.name == HOLD:
                receipt.confirm("it was held already")
            elif receipt.order.name == RESUME:
                return receipt
            else:
                raise self._ends(receipt)
        raise Stopped()

    def _confirm_what_is_seen(self) -> None:
        if (pending := self._pending) is not None and self._obeyed():
            self._pending = None
            pending.confirm()

    @contextmanager
    def _in_movement(self) -> Iterator[None]:
        before, self._moving = self._moving, True
        try:
            yield
        finally:
            self._moving = before
