"""Obeys orders in the middle of whatever a robot waits for."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ..clock import Clock
from ..faults import ORDERED, STOPPED, Fault, Stopped
from ..vehicles.vehicle import Vehicle
from .orders import HOLD, LAND, RESUME, STOP, Inbox, Receipt

GLANCE_SECONDS = 0.1
"""Real seconds between two looks into the inbox while the robot is held."""

OBEYED_IN = {
    HOLD: frozenset({"hold", "surface"}),
    LAND: frozenset({"land", "surface", "hold"}),
}
"""Modes in which a vehicle that was told so does what it was told."""


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
    wait goes on after `resume`; a movement is then begun again. All other orders end the program.

    Attributes:
        ended: whether the program has ended, so that it cannot go on.
        hands_off: whether orders are looked at elsewhere, since the vehicle may not be told anything.
    """

    def __init__(self, inbox: Inbox, clock: Clock, stop: threading.Event, say: Callable[[str], None]) -> None:
        """Obey nobody yet: there is no vehicle; `stop` ends a hold, too."""
        self.ended = False
        self.hands_off = False
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
        """Confirm an order as soon as the vehicle is seen to obey it."""
        self._pending, self._obeyed = receipt, obeyed

    def settle(self, refusal: str = "") -> None:
        """Confirm, or refuse, an order that was expected and not seen to be obeyed."""
        pending, self._pending = self._pending, None
        if pending is not None and refusal:
            pending.refuse(refusal)
        elif pending is not None:
            pending.confirm()

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
            raise Ordered(receipt)
        if why := why_not(name):
            receipt.refuse(why)
        elif name == RESUME:
            return receipt
        else:
            receipt.confirm("it stands on the ground")
        return None

    def close(self, why: str) -> None:
        """Refuse what was taken and will not be obeyed any more."""
        self.settle(why)
        self._forget_early(why)

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
        elif name != RESUME:
            self._forget_early("something else was ordered since")
            raise Ordered(receipt)
        elif self._early:
            self._forget_early("it is to go on")
            receipt.confirm("it goes on once there is a vehicle")
        else:
            receipt.refuse("its program has ended" if self._over else "it is not held")

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
        self._held, moving = True, self._moving
        try:
            evidence = vehicle.evidence()
            self.expect(receipt, lambda: evidence.in_mode(OBEYED_IN[HOLD]))
            vehicle.hold()
            self.settle()
            for other in others:
                other.confirm()
            if self._over:
                return
            self._say("is held; waits for an order")
            self.expect(self._await_resume(vehicle), lambda: False)
            vehicle.carry_on()
            self.settle()
            self._say("goes on")
        finally:
            self._held = False
            self.settle("something else has happened")
            for other in others:
                other.refuse("something else has happened")
        if moving:
            raise Again

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
                raise Ordered(receipt)
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
