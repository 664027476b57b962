"""Runs behaviours: lets every robot make its steps as soon as it can, and drives its backend.

One process may run all robots of a program or some of them; notifies go over the bus. In simulated time
the run jumps from event to event of the backends, robots of one instant step in the program's order, so
that the same input gives the same steps. In real time it sleeps until something is due, or until a
backend, the bus or an order wakes it.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import inf

from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import Outcome
from mmrs_core.behaviour.semantics import Phase, Step, Waiting
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.buses import Bus, CommandId
from mmrs_core.contributions.execution import Clock, Condition, Fault
from mmrs_core.runtime.agenda import Agenda
from mmrs_core.runtime.attention import BUS
from mmrs_core.runtime.finding import finds_of, names_told, teach
from mmrs_core.runtime.obedience import Obedience
from mmrs_core.runtime.peers import Peers
from mmrs_core.runtime.resuming import over_by
from mmrs_core.runtime.robot import RunningRobot
from mmrs_core.runtime.rules import Rules, refuse_unknown
from mmrs_core.runtime.stopping import Stopping
from mmrs_core.runtime.terms import TO_THE_END, Ending, Terms
from mmrs_core.runtime.unready import note, reason_of
from mmrs_core.scene import Policy
from mmrs_runtime.faults import LOG_FAILED
from mmrs_runtime.records.steps import StepRecord

PACE = 0.05
"""Seconds between two looks at a backend, or a bus, that cannot say when to look again."""

WATCH_PACE = 0.5
"""Seconds between two looks at a robot that has stopped in a way that somebody must watch."""


def interpret(
    program: Program,
    backends: Mapping[str, Backend],
    *,
    bus: Bus,
    clock: Clock,
    conditions: Mapping[str, Condition],
    policies: Mapping[str, tuple[Policy, ...]] | None = None,
    terms: Terms = TO_THE_END,
) -> Generator[StepRecord, None, Ending]:
    """Yield the steps of the robots that have a backend; return how the run ended.

    A notify is yielded, and observed, before it is delivered. When the generator ends or is closed,
    every robot that has not come to its end has been stopped.

    Args:
        program: of all robots, those of other processes included.
        backends: by robot.
        conditions: by identifier; all that Choices of these robots name.
        policies: by robot: those of its type and kind, which go after the program's own.
        terms: who is told, and what cuts the run off.

    Raises:
        ValueError: if a backend is for a robot that the program does not have, or the steps to resume from
            are not the program's.
        UnsupportedError: if a condition is unknown; lists all of them.
    """
    refuse_unknown(program, backends, conditions)
    robots = []
    for robot in program.robots:
        if robot.id in backends:
            live = terms.attention is not None
            rules = Rules(
                conditions,
                (policies or {}).get(robot.id, ()),
                terms.suspends,
                program.reserve,
                live,
                terms.say,
                partial(names_told, robot.id, bus),
            )
            robots.append(RunningRobot(robot, backends[robot.id], bus, rules))
            robots[-1].restore(record for record in terms.resumed if record.robot == robot.id)
    terms.standing.begin(robots)
    over = {id: why for id, why in over_by(program, terms.resumed).items() if id not in backends}
    return _Run(program, robots, bus, clock, terms, over).go()


class _Run:
    def __init__(
        self,
        program: Program,
        robots: list[RunningRobot],
        bus: Bus,
        clock: Clock,
        terms: Terms,
        over: Mapping[str, str],
    ) -> None:
        self._robots, self._bus, self._clock, self._terms = robots, bus, clock, terms
        self._by_id = {robot.id: order for order, robot in enumerate(robots)}
        self._over = over
        self._whole = len(robots) + len(over) == len(program.robots)
        self._peers = Peers(program, {*self._by_id, *over}, bus)
        self._obedience = Obedience(robots, terms.orders, clock)
        self._stopping = Stopping(robots, clock, self._obedience, terms.say)
        self._made = 0
        self._agenda = Agenda(len(robots))
        self._deadlock: tuple[Waiting, ...] = ()
        self._idle_since: float | None = None
        self._told = ""
        if terms.attention is not None:
            attention = terms.attention
            bus.on_change(lambda: attention.call(BUS))
            terms.orders.called = clock.wake

    def go(self) -> Generator[StepRecord, None, Ending]:
        try:
            self._take_up()
            while True:
                self._obey()
                yield from self._settled()
                self._stopping.look_after()
                self._note_deadlock()
                if self._made >= self._terms.steps or self._is_over():
                    break
                until = self._next_wake()
                if until > self._terms.seconds or (until == inf and not self._clock.passes_by_itself):
                    break
                self._clock.sleep_until(until)
                self._wake()
        finally:
            self._halt()
        return self._ending()

    def _take_up(self) -> None:
        """Bring robots of a run that was broken off back to where they were."""
        for id, why in self._over.items():
            self._peers.retire(id, failed=bool(why))
            self._bus.leave(id)
        for robot in self._robots:
            teach(robot.id, robot.backend, self._bus)
            if robot.point.is_final:
                self._peers.retire(robot.id, failed=robot.point.phase is Phase.FAILED)
                self._bus.leave(robot.id)
            elif self._terms.unready:
                robot.prepare(self._clock.now())
            elif robot.number > 0:
                robot.recover(self._clock.now())

    def _obey(self) -> None:
        for robot in self._obedience.obey():
            self._agenda.put(self._by_id[robot])

    def _settled(self) -> Iterator[StepRecord]:
        """Make every step that is due now, the program's first robot first."""
        while self._agenda.is_due and self._made < self._terms.steps:
            order = self._agenda.take()
            robot = self._robots[order]
            yield from self._advanced(robot)
            self._agenda.put_at(order, self._wake_time(robot))

    def _advanced(self, robot: RunningRobot) -> Iterator[StepRecord]:
        while not robot.point.is_final and self._made < self._terms.steps:
            was_suspended = robot.suspended
            robot.looked = self._clock.now()
            if robot.preparing and robot.get_ready(robot.looked):
                self._obey()  # what was to wait until it is ready goes before anything else
            step = robot.due(robot.looked, self._peers)
            if robot.suspended and not was_suspended:
                self._break_off(robot, robot.halt.fault or Fault("BATTERY_LOW"))
            if step is None or not self._order(robot, step):
                return
            yield from self._make(robot, step)

    def _order(self, robot: RunningRobot, step: Step) -> bool:
        """Give a robot the logical time of a step; False: it cannot be made yet."""
        least = 0
        if step.sets:
            if robot.notify.delivery is None:
                id = CommandId(self._terms.run, robot.id, self._terms.incarnation, robot.number)
                finds = finds_of(robot.id, robot.backend, self._bus, robot.looked)
                robot.notify.delivery = self._bus.prepare(id, step.sets, step.active, finds)
            if robot.notify.delivery.lamport is None:
                return False
            least = robot.notify.delivery.lamport
        waits = robot.awaited() if step.label in ("take", "choose") else ()
        clocks = (self._bus.state(slot).lamport for slot in waits)
        lamport = max((robot.lamport + 1, least, *(clock + 1 for clock in clocks)))
        if waits and not self._bus.passed(waits, lamport):
            return False
        if waits:
            teach(robot.id, robot.backend, self._bus)
        robot.lamport = lamport
        return True

    def _make(self, robot: RunningRobot, step: Step) -> Iterator[StepRecord]:
        record = self._record(robot, step)
        try:
            if self._terms.observe is not None:
                self._terms.observe(record)
        except OSError as error:
            if not self._clock.passes_by_itself:
                raise
            if record.label != "fault":
                self._lose_log(robot, record, error)
                return
            self._terms.say(f"'{robot.id}': the fault is not in the log: {error.strerror or error}")
        yield record
        robot.follow(step, self._clock.now())
        self._made += 1
        if step.sets:
            self._deliver(robot, step)
        if robot.point.is_final:
            self._retire(robot)

    def _lose_log(self, robot: RunningRobot, lost: StepRecord, error: OSError) -> None:
        """End the program of a robot whose step cannot be recorded: it may not be made then."""
        robot.fail(Fault(LOG_FAILED, error.strerror or str(error)))
        if self._terms.observe is not None:
            with suppress(OSError):
                self._terms.observe(replace(lost, label="fault", detail=LOG_FAILED, slot=""))
        self._retire(robot)

    def _record(self, robot: RunningRobot, step: Step) -> StepRecord:
        time = round(self._clock.now(), 6)
        return StepRecord(
            self._terms.run,
            robot.id,
            robot.take_number(),
            robot.lamport,
            time,
            step.label,
            step.move,
            step.detail,
            step.slot,
        )

    def _deliver(self, robot: RunningRobot, step: Step) -> None:
        robot.send()
        for owner, _ in step.sets:
            if owner in self._by_id:
                self._agenda.put(self._by_id[owner])

    def _break_off(self, robot: RunningRobot, found: Fault) -> None:
        """Answer what has broken a program off; a robot that did not get ready is left alone."""
        if not robot.absent:
            self._stopping.answer(robot, found)
            return
        self._terms.say(f"'{robot.id}': does not get ready: {reason_of(found)}")
        note(robot.backend, found.which, reason_of(found))
        self._dismiss(robot, failed=True)

    def _retire(self, robot: RunningRobot) -> None:
        """Note that a robot has come to its end, and answer the fault that has brought it there."""
        failed = robot.point.phase is Phase.FAILED
        self._dismiss(robot, failed=failed)
        if failed:
            self._stopping.answer(robot, robot.halt.fault or Fault("CRASHED"))

    def _dismiss(self, robot: RunningRobot, *, failed: bool) -> None:
        """Note that a robot makes no further step, and have those look that may wait for it."""
        self._peers.retire(robot.id, failed=failed)
        self._bus.leave(robot.id)
        for order, other in enumerate(self._robots):
            if other.point.phase is Phase.OUT:
                self._agenda.put(order)

    def _wake_time(self, robot: RunningRobot) -> float:
        now = self._clock.now()
        event = robot.next_event(robot.looked)
        if event is None or event <= robot.looked:
            event = now + PACE
        unsure = robot.notify.delivery is not None or robot.wait.question
        if unsure or (not self._whole and robot.point.phase is Phase.OUT):
            event = min(event, now + PACE)
        return event

    def _next_wake(self) -> float:
        """Return when to look again; inf where nothing is foreseen."""
        looks = min(self._patience_ends(), self._next_look_around())
        if self._is_quiet() and not self._is_patient() and not self._clock.passes_by_itself:
            return looks
        return min(self._agenda.next_time, looks)

    def _next_look_around(self) -> float:
        """Return when to look again at robots that have stopped, or have still to be seen to obey."""
        if not self._clock.passes_by_itself:
            return inf
        if self._stopping.busy or self._obedience.busy:
            return self._clock.now() + PACE
        return self._clock.now() + WATCH_PACE if self._stopping.watching else inf

    def _wake(self) -> None:
        self._agenda.advance(self._clock.now())
        if self._terms.attention is not None:
            self._attend(self._terms.attention.taken())

    def _attend(self, called: frozenset[str]) -> None:
        for order, robot in enumerate(self._robots):
            affected = robot.point.phase is Phase.OUT or robot.notify.delivery or self._bus.trouble(robot.id)
            if robot.id in called or (BUS in called and affected):
                self._agenda.put(order)

    def _is_over(self) -> bool:
        """Return whether nothing will happen any more in real time."""
        if not self._clock.passes_by_itself:
            return False
        if self._stopping.busy or self._stopping.watching:
            return False
        if all(robot.point.is_final or robot.suspended for robot in self._robots):
            return self._patience_ends(begin=True) <= self._clock.now()
        self._idle_since = None
        return self._is_quiet() and not (self._is_patient() or self._awaits_orders())

    def _awaits_orders(self) -> bool:
        """Return whether only people can change anything, and robots must not be left alone until they do."""
        now = self._clock.now()
        if not any(robot.may_be_resumed or robot.may_move(now) for robot in self._robots):
            return False
        waiting = "; ".join(map(str, self._waiting()))
        if waiting != self._told:
            self._told = waiting
            self._terms.say(f"nothing goes on until somebody orders something: {waiting}")
        return True

    def _patience_ends(self, *, begin: bool = False) -> float:
        """Return when nobody waits any longer for robots to be resumed; the past if there are none."""
        if not any(robot.suspended and not robot.halt.released for robot in self._robots):
            return -inf if begin else inf
        if begin and self._idle_since is None:
            self._idle_since = self._clock.now()
        return inf if self._idle_since is None else self._idle_since + self._terms.patience

    def _note_deadlock(self) -> None:
        """Keep who waits once it is certain that nobody sets what it waits for."""
        resumable = any(robot.may_be_resumed for robot in self._robots)
        if not self._deadlock and self._is_quiet() and not resumable:
            self._deadlock = self._waiting()

    def _is_patient(self) -> bool:
        """Return whether a wait of some robot will end by itself."""
        return any(robot.wait.deadline < inf for robot in self._robots if robot.is_waiting)

    def _is_quiet(self) -> bool:
        """Return whether every robot is at its end or waits, so that no slot changes any more."""
        return self._whole and all(
            robot.point.is_final or robot.is_waiting or robot.suspended for robot in self._robots
        )

    def _waiting(self) -> tuple[Waiting, ...]:
        waiting = (robot for robot in self._robots if robot.is_waiting)
        return tuple(Waiting(robot.id, robot.move.id, robot.wait.lacking) for robot in waiting)

    def _halt(self) -> None:
        """Stop every robot that is still at work, and wait until each has confirmed it."""
        for robot in self._robots:
            if not (robot.point.is_final or robot.suspended or robot.preparing):
                self._stopping.stop(robot, "HOLD")
        self._stopping.look_after()
        while self._stopping.busy:
            self._clock.sleep_until(self._clock.now() + PACE)
            self._stopping.look_after()
        self._obedience.give_up()

    def _ending(self) -> Ending:
        faults = {id: Fault(why) for id, why in self._over.items() if why}
        faults |= {robot.id: robot.halt.fault for robot in self._robots if robot.halt.fault is not None}
        suspended = tuple(robot.id for robot in self._robots if robot.suspended)
        done = all(robot.point.phase is Phase.DONE for robot in self._robots)
        if suspended or (not self._is_quiet() and not all(robot.point.is_final for robot in self._robots)):
            outcome = Outcome.INCOMPLETE
        else:
            outcome = Outcome.FAILED if faults else Outcome.SUCCESS if done else Outcome.STUCK
        unconfirmed = self._stopping.unconfirmed
        responses = {robot.id: robot.halt.response for robot in self._robots if robot.halt.fault is not None}
        return Ending(
            outcome,
            self._deadlock,
            faults,
            unconfirmed,
            self._clock.now(),
            self._made,
            suspended,
            responses,
            {id: words for id, words in self._stopping.came_down.items() if id in suspended},
            tuple(robot.id for robot in self._robots if robot.absent),
            self._stopping.lost,
        )
