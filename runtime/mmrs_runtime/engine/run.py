"""A run: the robots of a program in one process, from their present points to whatever end.

There is one thread. Robots that are due are resumed in the program's order, as long as any is; then the
clock advances to the next time at which one will be due. Simulated time jumps there, so that the same input
gives the same steps; real time passes, until an event comes from a vehicle, the bus, or the operator.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import partial
from math import inf

from ..policies import NOTHING, Policy
from ..program import Program
from ..records.disk import Kept
from ..records.steps import StepRecord
from ..semantics import Outcome, Phase, Waiting
from ..slots import Slots
from ..vehicle import Condition, Fault, Vehicle
from .clocks import RunClock
from .event_queue import EventQueue
from .life import PACE, Life
from .order_handling import OrderHandler
from .resuming import over_by
from .stopping import WATCH_PACE, Stopping
from .terms import BUS, TO_THE_END, Ending, Terms
from .waits import Peers

UNKNOWN_SECONDS = 600.0
"""Simulated seconds without any other event after which an unknown condition counts as never known."""


def run(
    program: Program,
    vehicles: Mapping[str, Vehicle],
    *,
    slots: Slots,
    clock: RunClock,
    conditions: Mapping[str, Condition],
    policies: Mapping[str, tuple[Policy, ...]] | None = None,
    terms: Terms = TO_THE_END,
) -> Ending:
    """Run the programs of the robots that have a vehicle; return how that ended.

    A notify is observed before it is delivered. Whatever ends the run, every robot that has not come to its
    end has then been stopped.

    Args:
        program: of all robots, those of other processes included.
        vehicles: by robot.
        slots: of all robots.
        clock: simulated or real.
        conditions: by identifier; all that choices of these robots ask for.
        policies: by robot: those of its type and kind, which come after the program's own.
        terms: observers, and limits that cut the run off.

    Raises:
        ValueError: a vehicle is for a robot that the program does not have, a condition is missing, or the
            steps to resume from are not the program's.
    """
    for id in vehicles:
        if id not in program.by_id:
            raise ValueError(f"robot '{id}': not in the behaviour")
    for robot in program.robots:
        for name in robot.conditions if robot.id in vehicles else ():
            if name not in conditions:
                raise ValueError(f"robot '{robot.id}': no function decides condition '{name}'")
    return Run(program, vehicles, slots, clock, conditions, policies or {}, terms).go()


class Run:
    """A run in progress, as its robots see it."""

    def __init__(
        self,
        program: Program,
        vehicles: Mapping[str, Vehicle],
        slots: Slots,
        clock: RunClock,
        conditions: Mapping[str, Condition],
        policies: Mapping[str, tuple[Policy, ...]],
        terms: Terms,
    ) -> None:
        self.slots, self.clock, self.conditions, self.terms = slots, clock, conditions, terms
        here = [robot for robot in program.robots if robot.id in vehicles]
        self._lives = [
            Life(robot, vehicles[robot.id], self, policies.get(robot.id, ()), live=clock.passes_by_itself)
            for robot in here
        ]
        for life in self._lives:
            life.restore(record for record in terms.resumed if record.robot == life.id)
        over = over_by(program, terms.resumed) if terms.resumed else {}
        self._over = {id: why for id, why in over.items() if id not in vehicles}
        self._numbers = {life.id: number for number, life in enumerate(self._lives)}
        self.whole = len(self._lives) + len(self._over) == len(program.robots)
        self.peers = Peers(program, {*self._numbers, *self._over}, slots)
        self._order_handler = OrderHandler(self._lives, terms.orders, clock)
        self.stopping = Stopping(self._lives, clock, self._order_handler, self.say)
        self._made, self._stepped = 0, 0.0
        self._queue = EventQueue(len(self._lives))
        self._resume = [life.go().__next__ for life in self._lives]
        self._restless = len(self._lives)
        self._quiet = [False] * len(self._lives)
        self._suspended: set[int] = set()
        self._deadlock: tuple[Waiting, ...] = ()
        self._idle_since: float | None = None
        self._reported = ""
        terms.status_board.begin(self._lives)
        if terms.attention is not None:
            attention = terms.attention
            for life in self._lives:
                life.vehicle.post = partial(attention.call, life.id)
            slots.on_change(lambda: attention.call(BUS))
            terms.orders.called = clock.wake

    def go(self) -> Ending:
        """Carry everything out."""
        try:
            self._take_up()
            while True:
                self.obey()
                self._settle()
                self._note_deadlock()
                if self.is_full or self._is_over():
                    break
                until = self._next_wake()
                if until > self.terms.seconds or (until == inf and not self.clock.passes_by_itself):
                    break
                if self._is_undecidable():
                    self._deadlock = self._waiting()
                    break
                self.clock.sleep_until(until)
                self._wake()
        finally:
            self._halt()
        return self._ending()

    # What lives ask for.

    def made(self, record: StepRecord) -> None:
        """Record a step, which is made then.

        Raises:
            OSError: it cannot be.
        """
        try:
            if self.terms.observe is not None:
                self.terms.observe(record)
        except OSError:
            self._made += 1 if record.label == "fault" else 0
            raise
        self._made += 1
        self._stepped = record.time

    def keep(self, record: StepRecord) -> None:
        """Record a step in place of one that could not be, if that is possible."""
        if self.terms.observe is not None:
            with suppress(OSError):
                self.terms.observe(record)

    def sync(self, robot: str, kept: Kept) -> None:
        """Write a robot's steps to the disk, and call `kept` then, if they are kept at all."""
        try:
            if self.terms.sync is not None:
                self.terms.sync(robot, kept)
            else:
                kept(None)
        except OSError as error:
            kept(error)

    @property
    def is_full(self) -> bool:
        """Return whether no further step may be made."""
        return self._made >= self.terms.steps

    def notified(self, owners: Iterable[str]) -> None:
        """Wake those of these robots that are here, to look at their slots."""
        for owner in owners:
            if owner in self._numbers:
                self._queue.put(self._numbers[owner])

    def dismiss(self, life: Life, *, failed: bool) -> None:
        """Note that a robot makes no further step, and have those look that may wait for it."""
        owners = self.peers.retire(life.id, failed=failed)
        self.slots.leave(life.id)
        self.notified(owner for owner in owners if self._is_out(owner))

    def leave_alone(self, life: Life, found: Fault) -> None:
        """Record that a robot did not get ready, and may not be the program's."""
        reason = found.reason or found.which
        self.say(life, f"does not get ready: {reason}")
        life.decided(found.which, reason, NOTHING)
        self.dismiss(life, failed=True)

    def obey(self) -> None:
        """Pass orders on to robots, and check which are obeyed."""
        if self.terms.orders.waiting or self._order_handler.at_work:
            self.notified(self._order_handler.obey())

    def say(self, life: Life, words: str) -> None:
        """Report something about a robot to the operator."""
        self.terms.say(f"'{life.id}': {words}")

    # How it goes on.

    def _take_up(self) -> None:
        """Bring robots of a run that was broken off back to where they were."""
        for id, why in self._over.items():
            self.peers.retire(id, failed=bool(why))
            self.slots.leave(id)
        for life in self._lives:
            life.begin(prepare=self.terms.unready)

    def _settle(self) -> None:
        """Resume every robot that is due now, the program's first one first."""
        queue, resume = self._queue, self._resume
        while queue.is_due and not self.is_full:
            number = queue.take()
            try:
                queue.put_at(number, resume[number]().deadline)
            except StopIteration:
                queue.put_at(number, inf)
            life = self._lives[number]
            if life.suspended is not (number in self._suspended):
                self._suspended ^= {number}
            if life.is_quiet is self._quiet[number]:
                continue
            self._quiet[number] = not self._quiet[number]
            self._restless += -1 if self._quiet[number] else 1

    def _wake(self) -> None:
        self._queue.advance(self.clock.now())
        for who, event in self.terms.attention.taken() if self.terms.attention is not None else ():
            if who == BUS:
                self._attend_bus()
            elif who in self._numbers:
                self._lives[self._numbers[who]].vehicle.hear(event)
                self._queue.put(self._numbers[who])

    def _attend_bus(self) -> None:
        for number, life in enumerate(self._lives):
            if life.sending or life.point.phase is Phase.OUT or self.slots.trouble(life.id):
                self._queue.put(number)

    def _next_wake(self) -> float:
        """Return when to look again; inf where nothing is foreseen."""
        looks = min(self._patience_ends(), self._next_look_around())
        if self._is_quiet() and not self.clock.passes_by_itself and not self._is_patient():
            return looks
        return min(self._queue.next_time, looks)

    def _next_look_around(self) -> float:
        """Return when to look again at robots that have stopped, or have still to be seen to obey."""
        if not self.clock.passes_by_itself:
            return inf
        if self.stopping.busy or self._order_handler.busy:
            return self.clock.now() + PACE
        return self.clock.now() + WATCH_PACE if self.stopping.watching else inf

    # How it ends.

    def _is_over(self) -> bool:
        """Return whether nothing will happen any more in real time."""
        if not self.clock.passes_by_itself or self.stopping.busy or self.stopping.watching:
            return False
        if all(life.point.is_final or life.suspended for life in self._lives):
            return self._patience_ends(begin=True) <= self.clock.now()
        self._idle_since = None
        return self._is_quiet() and not (self._is_patient() or self._awaits_orders())

    def _awaits_orders(self) -> bool:
        """Return whether only people can change anything, and robots must not be left alone until they do."""
        if not any(life.may_be_resumed or life.may_move() for life in self._lives):
            return False
        waiting = "; ".join(map(str, self._waiting()))
        if waiting != self._reported:
            self._reported = waiting
            self.terms.say(f"nothing continues without an order: {waiting}")
        return True

    def _patience_ends(self, *, begin: bool = False) -> float:
        """Return when the wait for robots to be resumed ends; the past if there are none."""
        if not any(not self._lives[number].halt.released for number in self._suspended):
            return -inf if begin else inf
        if begin and self._idle_since is None:
            self._idle_since = self.clock.now()
        return inf if self._idle_since is None else self._idle_since + self.terms.patience

    def _note_deadlock(self) -> None:
        """Keep the waiting robots once it is certain that their slots will never be set."""
        if not self._deadlock and self._is_quiet() and not any(life.may_be_resumed for life in self._lives):
            self._deadlock = self._waiting()

    def _is_undecidable(self) -> bool:
        """Return whether simulated robots wait for unknown conditions, and nothing else happens."""
        if self.clock.passes_by_itself or self.clock.now() < self._stepped + UNKNOWN_SECONDS:
            return False
        asked = any(life.wait.question for life in self._lives)
        return asked and all(life.point.is_final or life.waits_for_ever for life in self._lives)

    def _is_patient(self) -> bool:
        """Return whether a wait of some robot ends at a known time."""
        return any(life.wait.deadline < inf for life in self._lives if life.is_waiting)

    def _is_quiet(self) -> bool:
        """Return whether every robot is at its end or waits, so that no slot changes any more."""
        return self.whole and not self._restless

    def _is_out(self, robot: str) -> bool:
        return robot in self._numbers and self._lives[self._numbers[robot]].point.phase is Phase.OUT

    def _waiting(self) -> tuple[Waiting, ...]:
        named = ((life, life.wait.lacking or (life.wait.question,)) for life in self._lives)
        return tuple(Waiting(life.id, life.point.move, names) for life, names in named if any(names))

    def _halt(self) -> None:
        """Stop every robot that is still at work, and wait until each has confirmed it."""
        for life in self._lives:
            if not (life.point.is_final or life.suspended or life.is_preparing):
                self.stopping.stop(life, "HOLD")
        self._look_after_all()
        while self.stopping.busy:
            self.clock.sleep_until(self.clock.now() + PACE)
            self._wake()
            self._look_after_all()
        self._order_handler.give_up()

    def _look_after_all(self) -> None:
        for life in self._lives:
            self.stopping.look_after(life)

    def _ending(self) -> Ending:
        lives = self._lives
        faults = {id: Fault(why) for id, why in self._over.items() if why}
        faults |= {life.id: life.halt.fault for life in lives if life.halt.fault is not None}
        suspended = tuple(life.id for life in lives if life.suspended)
        done = all(life.point.phase is Phase.DONE for life in lives)
        if suspended or (not self._is_quiet() and not all(life.point.is_final for life in lives)):
            outcome = Outcome.INCOMPLETE
        else:
            outcome = Outcome.FAILED if faults else Outcome.SUCCESS if done else Outcome.STUCK
        came_down = self.stopping.came_down
        return Ending(
            outcome,
            self._deadlock,
            faults,
            self.stopping.unconfirmed,
            self.clock.now(),
            self._made,
            suspended,
            {life.id: life.halt.response for life in lives if life.halt.fault is not None},
            {id: words for id, words in came_down.items() if id in suspended},
            tuple(life.id for life in lives if life.is_absent),
            self.stopping.lost,
        )
