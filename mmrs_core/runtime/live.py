"""Runs in real time: robots that are connected, got ready, driven, and let go of again."""

from __future__ import annotations

import threading
import uuid
from collections.abc import Callable, Collection, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.execution import Condition
from mmrs_core.contributions.vehicles import Live, VehicleFactory, VehicleInput
from mmrs_core.errors import LinkLostError
from mmrs_core.runtime.conditions import refuse_undecided
from mmrs_core.runtime.unready import Unready, note_alone, record, unready
from mmrs_runtime.clock import SIGNAL_SECONDS
from mmrs_runtime.engine.clocks import RealClock
from mmrs_runtime.engine.life import PACE
from mmrs_runtime.engine.orders import ANSWER, ENDINGS, HOLD, RESUME, STOP, Order, Orders
from mmrs_runtime.engine.resuming import over_by
from mmrs_runtime.engine.run import run
from mmrs_runtime.engine.standing import Standing
from mmrs_runtime.engine.terms import Attention, Ending, Terms
from mmrs_runtime.faults import ORDERED, STOPPED
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.slots import Slots
from mmrs_runtime.vehicle import Vehicle

GATHERING_SECONDS = 0.5
"""Real seconds for which more is waited for, once something keeps a robot from getting ready."""


@dataclass(frozen=True, slots=True)
class Venture:
    """A run in real time, before it begins.

    Attributes:
        inputs: of the backends, by robot of this process.
        bus: between all robots of the program.
        clock: of the run.
        orders: from people, who may give them as soon as this exists.
        run: identifier of the run.
        folder: of the logs; None where none are kept.
        links: how robots are reached, by robot; backends know what is usual.
        resumed: the steps made before the run was broken off.
        suspends: whether a low battery only breaks a program off.
        patience: seconds to wait for the order to resume once nobody else works.
        meet: waits for robots of other processes once those of this one are ready, calling again and
            again what it is given; returns, by robot, how well they begin together.
        observe: called with each step before it has an effect.
        say: tells people what goes on.
        standing: for people who ask how robots are.
    """

    program: Program
    inputs: Mapping[str, VehicleInput]
    bus: Slots
    conditions: Mapping[str, Condition]
    clock: RealClock = field(default_factory=RealClock)
    orders: Orders = field(default_factory=Orders)
    run: str = "run-0"
    folder: Path | None = None
    links: Mapping[str, str] = field(default_factory=dict)
    resumed: tuple[StepRecord, ...] = ()
    suspends: bool = True
    patience: float = 0.0
    meet: Callable[[Callable[[], None]], Mapping[str, str]] = lambda look: {}
    observe: Callable[[StepRecord], None] | None = None
    say: Callable[[str], None] = print
    standing: Standing = field(default_factory=Standing)

    def fail(self, robot: str, which: str) -> None:
        """Have a robot's log say that its program has ended before its first step; tell if it cannot."""
        program = self.program.robot(robot)
        start, time = program.moves[program.start].id, round(self.clock.now(), 6)
        try:
            if self.observe is not None:
                self.observe(StepRecord(self.run, robot, 0, 1, time, "fault", start, which))
        except OSError as error:
            self.say(f"'{robot}': the fault is not in the log: {error.strerror or error}")


def run_live(venture: Venture, backend: VehicleFactory) -> Ending:
    """Carry the programs out; return how that ended.

    No robot begins before all are ready; once some are under way, as in a run that is resumed, each goes
    on, or begins, as soon as it is ready itself, and one that does not get ready is left out. One whose
    program had ended before is left alone. In the end, every robot that has not come to its end has been
    stopped, all links are closed, and all orders answered.

    Raises:
        LinkLostError: if a robot does not answer at first.
        UnsupportedError: if a robot cannot do what its program holds, or options are wrong.
        MmrsError: if a robot does not get ready, and none is under way without it.
        ValueError: if the steps to resume from are not the program's.
        KeyboardInterrupt: if robots are ordered to stop before they are ready.
    """
    attention = Attention(venture.clock)
    over = over_by(venture.program.executable, venture.resumed)
    venture = replace(venture, inputs={id: each for id, each in venture.inputs.items() if id not in over})
    with ExitStack() as stack:
        stack.callback(venture.orders.close, "the run has ended")
        robots: dict[str, Vehicle] = {}
        venture.orders.vehicles = robots
        stack.callback(_let_go, robots)
        under_way = any(record.robot in venture.inputs for record in venture.resumed)
        early = None if under_way else _EarlyOrders(venture, robots)
        venture.standing.held = early.held if early is not None else ()
        try:
            _connect(robots, venture, backend, attention, early)
            venture.standing.connect(robots)
            if early is not None:
                _get_ready(robots, venture, early)
        except BaseException as error:
            if early is not None:
                early.give_up("the run has ended")
            if isinstance(error, Unready):
                record(robots, error.faults, venture.fail)
                raise unready(error.faults) from None
            raise
        refuse_undecided(venture.program, robots, venture.conditions)
        ending = run(
            venture.program.executable,
            robots,
            slots=venture.bus,
            clock=venture.clock,
            conditions=venture.conditions,
            policies={id: each.policies for id, each in venture.inputs.items()},
            terms=Terms(
                run=venture.run,
                incarnation=uuid.uuid4().hex,
                observe=venture.observe,
                resumed=venture.resumed,
                unready=under_way,
                suspends=venture.suspends,
                patience=venture.patience,
                attention=attention,
                orders=venture.orders,
                say=venture.say,
                standing=venture.standing,
            ),
        )
        if robots and set(ending.absent) == set(robots):
            raise unready({id: ending.faults[id] for id in ending.absent})
        return ending


def _connect(
    robots: dict[str, Vehicle],
    venture: Venture,
    backend: VehicleFactory,
    attention: Attention,
    early: _EarlyOrders | None,
) -> None:
    """Connect robots one after the other, and look out for orders to those that are there."""
    shared: dict[str, object] = {}
    for id, given in venture.inputs.items():
        own = [record for record in venture.resumed if record.robot == id]
        live = Live(
            clock=venture.clock,
            wake=attention.for_robot(id),
            say=_named(venture.say, id),
            run=venture.run,
            folder=venture.folder,
            resumed=bool(own),
            passed=tuple(record.move for record in own if record.label == "end"),
            begun=own[-1].move if own and own[-1].label == "begin" else "",
            links=venture.links,
            shared=shared,
            announce=venture.say,
        )
        robots[id] = backend.connect(replace(given, live=live))
        if early is not None:
            early.look(set(venture.inputs))


def _let_go(robots: Mapping[str, Vehicle]) -> None:
    """Close all robots at once: each may take seconds to know what to do when nobody talks to it.

    Raises:
        Exception: one cannot be closed; its notes tell why others cannot.
    """
    errors: list[Exception] = []

    def close(robot: Vehicle) -> None:
        try:
            robot.close()
        except Exception as error:
            errors.append(error)

    threads = [
        threading.Thread(target=close, args=(robot,), name=f"close {id}", daemon=True)
        for id, robot in robots.items()
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        while thread.is_alive():
            thread.join(SIGNAL_SECONDS)
    if errors:
        for other in errors[1:]:
            errors[0].add_note(f"also: {other!r}")
        raise errors[0]


def _named(say: Callable[[str], None], robot: str) -> Callable[[str], None]:
    return lambda words: say(f"'{robot}': {words}")


def _get_ready(robots: Mapping[str, Vehicle], venture: Venture, early: _EarlyOrders) -> None:
    clock = venture.clock
    preparing = {id: robot for id, robot in robots.items() if robot.prepare(clock.now())}
    venture.orders.called = clock.wake
    _await_ready(preparing, clock, early)
    _meet(robots, venture, early)
    early.pass_on()


def _await_ready(robots: Mapping[str, Vehicle], clock: RealClock, early: _EarlyOrders) -> None:
    """Return when all robots are ready, and nothing has gone wrong with one that was so earlier.

    Once something has, the others are waited for a moment, so that all that is wrong is told at once.
    """
    unready, told_at = set(robots), inf
    while unready:
        now = clock.now()
        for robot in robots.values():
            robot.look(now)
        faults = {id: robot.trouble for id, robot in robots.items() if robot.trouble is not None}
        told_at = min(told_at, now + GATHERING_SECONDS * clock.speedup) if faults else inf
        if faults and (now >= told_at or faults.keys() >= unready):
            raise Unready(faults)
        unready = {id for id in unready if id in faults or not robots[id].done}
        early.look(unready)
        if unready:
            clock.sleep_until(clock.now() + PACE)


def _meet(robots: Mapping[str, Vehicle], venture: Venture, early: _EarlyOrders) -> None:
    def look() -> None:
        while True:
            early.look(())
            for id, robot in robots.items():
                robot.look(venture.clock.now())
                if robot.trouble is not None:
                    raise Unready({id: robot.trouble})
            if not early.held:
                return
            venture.clock.sleep_until(venture.clock.now() + PACE)

    try:
        met = venture.meet(look)
    except LinkLostError as error:
        note_alone(robots.values(), str(error))
        raise
    for id, why in met.items():
        robots[id].note("decision", {"what": "TOGETHER", "why": why, "response": "begins"})


class _EarlyOrders:
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
        if self._ended.keys() >= set(self._venture.inputs):
            self._venture.say("stopped before anything moved")
            for order in self._open:
                for id in order.open:
                    order.confirm(id)
            self._record_ends()
            raise KeyboardInterrupt

    def _record_ends(self) -> None:
        """Have the logs say that orders have ended the programs; of an interrupted run, nothing is left."""
        for id, order in self._ended.items():
            if id in self._venture.inputs and not order.interrupt:
                self._venture.fail(id, STOPPED if order.kind == STOP else ORDERED)

    def pass_on(self) -> None:
        """Have the engine obey what was ordered, and know the answers, before what was ordered since."""
        held = tuple(sorted(self.held))
        first = (Order(HOLD, held),) if held else ()
        self._venture.orders.put_back((*first, *self._later))

    def give_up(self, why: str) -> None:
        """Refuse what nobody will obey any more."""
        for order in (*self._open, *self._later):
            for id in order.open:
                order.refuse(id, why)

    def _take(self, order: Order) -> None:
        for id in set(order.robots) - set(self._venture.inputs):
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
                self._take_back((id,), "it is to go on")
                order.confirm(id)

    def _take_back(self, robots: Collection[str], why: str) -> None:
        """Have robots be held no longer."""
        self.held.difference_update(robots)
        for order in self._open:
            for id in set(robots) & set(order.open) if order.kind == HOLD else ():
                order.refuse(id, why)
