"""How the robots of a run obey orders, and when each has confirmed that it does."""

from __future__ import annotations

from collections.abc import Sequence

from mmrs_core.contributions.execution import Clock, Fault, Pausable
from mmrs_core.errors import LinkLostError
from mmrs_core.runtime.orders import ANSWER, ENDINGS, HOLD, RESUME, STOP, Order, Orders
from mmrs_core.runtime.robot import RunningRobot

ORDERED, STOPPED = "ORDERED", "STOPPED"
"""Faults that end the program of a robot because somebody wants that."""


class Obedience:
    """Passes orders on to robots."""

    def __init__(
        self, robots: Sequence[RunningRobot], orders: Orders, answers: dict[str, bool], clock: Clock
    ) -> None:
        """Obey these orders; what the operator answers is added to the answers."""
        self._robots = {robot.id: robot for robot in robots}
        self._orders, self._answers, self._clock = orders, answers, clock
        self._open: list[Order] = []

    def obey(self) -> tuple[str, ...]:
        """Have robots do what was ordered, and see who has; return the robots to be looked at."""
        concerned: list[str] = []
        for order in self._orders.taken():
            self._open.append(order)
            for id in order.robots:
                concerned.append(id)
                self._begin(order, id)
        for order in self._open:
            self._look(order)
        self._open = [order for order in self._open if not order.settled.is_set()]
        return tuple(concerned)

    def stopped(self, id: str, stopping: bool, trouble: Fault | None) -> None:
        """Tell the orders that ended a robot's program what became of it."""
        for order in self._open:
            if order.kind in ENDINGS and id in order.open and not stopping:
                if trouble is None:
                    order.confirm(id)
                else:
                    order.refuse(id, str(trouble))

    def give_up(self) -> None:
        """Tell all orders that are still open that the run has ended."""
        for order in (*self._open, *self._orders.taken()):
            for id in order.open:
                order.refuse(id, "the run has ended")

    def _begin(self, order: Order, id: str) -> None:
        robot = self._robots.get(id)
        if robot is None:
            order.refuse(id, "no such robot here")
        elif order.kind == ANSWER:
            self._answers[order.question] = order.answer
            order.confirm(id)
        elif order.kind == HOLD:
            self._hold(order, robot)
        elif order.kind == RESUME:
            self._resume(order, robot)
        elif robot.point.is_final:
            self._stop_again(order, robot)
        else:
            which = STOPPED if order.kind == STOP else ORDERED
            robot.end_by(Fault(which, f"order to {order.kind}"), ENDINGS[order.kind])

    def _hold(self, order: Order, robot: RunningRobot) -> None:
        if robot.point.is_final or robot.suspended:
            order.refuse(robot.id, "its program has ended")
        elif not isinstance(robot.backend, Pausable):
            order.refuse(robot.id, "its backend cannot pause")
        else:
            robot.held = True
            robot.backend.pause(self._clock.now())

    def _resume(self, order: Order, robot: RunningRobot) -> None:
        if robot.suspended and not robot.stopping:
            robot.recover(self._clock.now())
        elif robot.held and isinstance(robot.backend, Pausable):
            robot.backend.resume(self._clock.now())
            robot.held = False
        else:
            order.refuse(robot.id, "has nothing to resume")
            return
        order.confirm(robot.id)

    def _stop_again(self, order: Order, robot: RunningRobot) -> None:
        """Have a robot whose program has ended by a fault stop in another way."""
        if robot.fault is None:
            order.refuse(robot.id, "its program has ended")
            return
        try:
            robot.backend.stop(self._clock.now(), ENDINGS[order.kind])
        except LinkLostError as error:
            order.refuse(robot.id, str(error))
        else:
            robot.response, robot.stopping = ENDINGS[order.kind], self._clock.passes_by_itself

    def _look(self, order: Order) -> None:
        for id in order.open if order.kind == HOLD else ():
            backend = self._robots[id].backend
            if isinstance(backend, Pausable) and backend.paused(self._clock.now()):
                order.confirm(id)
            elif self._robots[id].point.is_final:
                order.refuse(id, "its program has ended")
