"""How the robots of a run obey orders, and when each has confirmed that it does."""

from __future__ import annotations

from collections.abc import Sequence

from ..faults import ORDERED, STOPPED
from ..orders.orders import ANSWER, BATTERY_CHANGED, ENDINGS, HOLD, RESUME, RETURN, STOP, Order, Orders
from ..policies import NOTHING
from ..vehicle import Fault, LinkLost
from .clocks import RunClock
from .life import Life
from .responses import HaltProgress
from .situation import Stage


class OrderHandler:
    """Passes orders on to robots."""

    def __init__(self, robots: Sequence[Life], orders: Orders, clock: RunClock) -> None:
        """Obey these orders."""
        self._robots = {robot.id: robot for robot in robots}
        self._orders, self._clock = orders, clock
        self._open: list[Order] = []
        self._waiting: list[tuple[Order, str]] = []

    @property
    def busy(self) -> bool:
        """Return whether an order waits, or has still to be seen to be obeyed."""
        return bool(self._open)

    @property
    def at_work(self) -> bool:
        """Return whether an order has still to be begun, or to be seen to be obeyed."""
        return bool(self._open or self._waiting)

    def obey(self) -> tuple[str, ...]:
        """Pass orders on to robots, and check which are obeyed; return the robots to be looked at."""
        for order in self._orders.taken():
            self._open.append(order)
            self._waiting += ((order, id) for id in order.robots)
        begun = self._begin_all()
        for order in self._open:
            self._look(order)
        self._open = [order for order in self._open if not order.settled.is_set()]
        return begun

    def stopped(self, id: str, stopping: bool, trouble: Fault | None) -> None:
        """Report the outcome to the orders that ended a robot's program."""
        for order in self._open:
            began = (order, id) not in self._waiting
            if id in order.responses and id in order.open and began and not stopping:
                if why := str(trouble) if trouble is not None else self._undone(order, id):
                    order.refuse(id, why)
                else:
                    order.confirm(id)

    def give_up(self) -> None:
        """Refuse all open orders: the run has ended."""
        self._orders.close("the run has ended")
        for order in self._open:
            for id in order.open:
                order.refuse(id, "the run has ended")

    def _begin_all(self) -> tuple[str, ...]:
        """Begin to obey whatever need not wait, a robot's orders one after another; return the robots."""
        begun: list[str] = []
        busy = {id for _, id in self._waiting if self._in_doubt(id)}
        for order, id in tuple(self._waiting):
            if id in busy or self._must_wait(order, id):
                busy.add(id)
            else:
                begun.append(id)
                self._waiting.remove((order, id))
                self._begin(order, id)
        return tuple(id for id in begun if id in self._robots)

    def _must_wait(self, order: Order, id: str) -> bool:
        """Return whether it is not known yet what there is to be ended, or something ends right now."""
        robot = self._robots.get(id)
        return robot is not None and (
            robot.ordered is not None or (order.kind in ENDINGS and robot.is_unknown())
        )

    def _overtake(self, robot: Life, by: Order, *kinds: str) -> None:
        """Refuse what a robot was ordered before and was not seen to do, since it now does something else."""
        for order in self._open:
            began = (order, robot.id) not in self._waiting
            if order is not by and order.kind in kinds and robot.id in order.open and began:
                order.refuse(robot.id, f"{by.kind} was ordered since")

    def _in_doubt(self, id: str) -> bool:
        robot = self._robots.get(id)
        if robot is None or robot.is_absent:
            return False
        return robot.vehicle.in_doubt(self._clock.now())

    def _begin(self, order: Order, id: str) -> None:
        robot = self._robots.get(id)
        if robot is None:
            order.refuse(id, "no such robot here")
        elif robot.is_absent:
            order.refuse(id, f"it did not get ready: {robot.halt.fault}")
        elif order.kind == ANSWER:
            self._answer(order, robot)
        elif order.kind == BATTERY_CHANGED:
            self._change_battery(order, robot)
        elif order.kind == HOLD and robot.halt.response != NOTHING:
            self._hold(order, robot)
        elif robot.halt.response == NOTHING:
            order.refuse(id, "a pilot has taken over")
        elif order.kind == RESUME:
            self._resume(order, robot)
        elif robot.point.is_final:
            self._stop_again(order, robot)
        elif self._stands(robot):
            self._obey_on_the_ground(order, robot)
        else:
            self._overtake(robot, order, HOLD, RESUME)
            which = STOPPED if order.kind == STOP else ORDERED
            order.responses[id] = self._orders.response(order.kind)
            robot.end_by(Fault(which, f"order to {order.kind}"), order.responses[id])

    def _answer(self, order: Order, robot: Life) -> None:
        ended = "its program has ended" if robot.point.is_final else ""
        if why := ended or robot.questions.give(order.question, order.answer):
            order.refuse(robot.id, why)
        else:
            order.confirm(robot.id)

    def _change_battery(self, order: Order, robot: Life) -> None:
        """Make a robot that stands disarmed count its batteries as changed."""
        if robot.point.is_final:
            order.refuse(robot.id, "its program has ended")
        elif not robot.rests:
            order.refuse(robot.id, "it is not seen to be disarmed")
        else:
            robot.vehicle.change_battery(self._clock.now())

    def _hold(self, order: Order, robot: Life) -> None:
        if robot.point.is_final:
            self._stop_again(order, robot)
        elif self._stands(robot):
            self._obey_on_the_ground(order, robot)
        elif robot.suspended:
            self._stop(order, robot)
        elif not robot.vehicle.pauses:
            order.refuse(robot.id, "its vehicle cannot pause")
        else:
            self._overtake(robot, order, RESUME)
            robot.hold()

    def _resume(self, order: Order, robot: Life) -> None:
        if robot.halt.before_hold:
            self._stop(order, robot)
        elif robot.point.is_final:
            order.refuse(robot.id, "its program has ended")
        elif robot.suspended and robot.halt.stopping:
            order.refuse(robot.id, f"has still to do {robot.halt.response}")
        elif robot.suspended:
            self._recover(order, robot)
        elif robot.held and robot.vehicle.pauses:
            self._overtake(robot, order, HOLD)
            robot.go_on()
        else:
            order.refuse(robot.id, "it is not held")

    def _stands(self, robot: Life) -> bool:
        """Return whether it came down for its battery, and is there."""
        if not robot.suspended or robot.halt.stopping or robot.is_watched():
            return False
        return robot.halt.is_down or robot.rests

    def _obey_on_the_ground(self, order: Order, robot: Life) -> None:
        """Apply an order to a robot that waits for its battery: a response, or the end of the wait."""
        why = _taken(robot) if order.kind != STOP else ""
        if order.kind == RETURN:
            why = why or robot.away()
        if why:
            order.refuse(robot.id, why)
            return
        robot.halt.released = robot.halt.released or order.kind == STOP
        order.confirm(robot.id)

    def _recover(self, order: Order, robot: Life) -> None:
        """Resume a robot whose program was broken off, unless its battery was not changed."""
        try:
            why = _taken(robot) or robot.hindrance()
        except LinkLost as error:
            why = str(error)
        if why:
            order.refuse(robot.id, why)
        else:
            robot.recover()

    def _stop_again(self, order: Order, robot: Life) -> None:
        """Stop a robot whose program has ended by a fault in another way, if it still responds at all."""
        busy = robot.halt.fault is not None and (robot.halt.stopping or robot.is_watched())
        robot.halt.released = robot.halt.released or order.kind == STOP
        if not busy:
            order.refuse(robot.id, "its program has ended")
        elif not robot.vehicle.reachable(self._clock.now()):
            order.refuse(robot.id, "its link is lost")
        else:
            self._stop(order, robot)

    def _stop(self, order: Order, robot: Life) -> None:
        """Change a robot's response to what has ended its program; `resume` returns to the former one."""
        halt = robot.halt
        held_anyway = order.kind == HOLD and halt.response == "HOLD"
        if order.kind == HOLD:
            halt.hold()
        elif order.kind == RESUME:
            halt.go_on()
        else:
            halt.respond(self._orders.response(order.kind))
        order.responses[robot.id] = halt.response
        try:
            robot.vehicle.respond(halt.response, self._clock.now())
        except LinkLost as error:
            order.refuse(robot.id, str(error))
            return
        halt.released = order.kind == STOP or (halt.released and held_anyway)
        if self._clock.passes_by_itself:
            halt.begin()

    def _look(self, order: Order) -> None:
        now = self._clock.now()
        for id in order.open:
            robot = self._robots.get(id)
            if robot is None or self._confirm_rest(order, robot) or (order, id) in self._waiting:
                continue
            if order.kind == BATTERY_CHANGED:
                self._see_change(order, robot, now)
            elif id in order.responses:
                self._look_at_response(order, robot, now)
            elif robot.halt.fault is not None:
                order.refuse(id, f"something has happened since: {robot.halt.fault}")
            elif order.kind == HOLD:
                self._see_halt(order, robot, now)
            elif self._goes_on(robot, now):
                order.confirm(id)

    def _see_change(self, order: Order, robot: Life, now: float) -> None:
        """Report whether a robot's batteries count as changed, once that is known."""
        if (why := robot.vehicle.battery_change(now)) is None:
            return
        if why:
            order.refuse(robot.id, why)
        else:
            order.confirm(robot.id)

    def _see_halt(self, order: Order, robot: Life, now: float) -> None:
        if robot.held:
            robot.hold()
        if robot.vehicle.paused(now):
            order.confirm(robot.id)

    def _confirm_rest(self, order: Order, robot: Life) -> bool:
        """Confirm to a robot that is getting ready, and is to stay where it is, that it is disarmed."""
        rests = robot.is_preparing and order.kind in (HOLD, *ENDINGS) and robot.rests
        if rests:
            order.confirm(robot.id)
        return rests

    def _look_at_response(self, order: Order, robot: Life, now: float) -> None:
        if robot.ordered is not None:
            return
        if robot.halt.response != order.responses[robot.id]:
            order.refuse(robot.id, _since(robot))
        elif not robot.halt.stopping:
            self._settle(order, robot)
        elif robot.vehicle.obeys(now):
            order.confirm(robot.id)

    def _settle(self, order: Order, robot: Life) -> None:
        """Answer an order to a robot that is not awaited: its word is taken, or it is out of reach."""
        if self._clock.passes_by_itself:
            order.refuse(robot.id, "its link is lost")
        else:
            order.confirm(robot.id)

    def _goes_on(self, robot: Life, now: float) -> bool:
        """Return whether a robot that was ordered to continue was seen to."""
        if robot.vehicle.paused(now):
            return False
        return robot.stage is not Stage.RECOVERING or robot.vehicle.moves(now)

    def _undone(self, order: Order, id: str) -> str:
        """Return why a robot that has stopped has not done what was ordered; empty where it has."""
        robot = self._robots[id]
        if robot.halt.response != order.responses[id]:
            return _since(robot)
        return robot.vehicle.undone(self._clock.now())


def _taken(robot: Life) -> str:
    """Return that a robot that had landed disarmed is armed now; empty where it is not."""
    rested = robot.halt.progress is HaltProgress.AT_REST
    return "it is armed: the vehicle is under external control" if rested and not robot.rests else ""


def _since(robot: Life) -> str:
    """Return in words what a robot does instead of what it was ordered."""
    if robot.halt.response == NOTHING:
        return "a pilot has taken over"
    return f"something else has happened since: {robot.halt.response or 'it continues'}"
