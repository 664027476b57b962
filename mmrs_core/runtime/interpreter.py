"""Runs behaviours: lets every robot make its steps as soon as it can, and drives its backend.

One process may run all robots of a program or some of them; notifies go over the bus. In simulated time
the run jumps from event to event of the backends, robots of one instant step in the program's order, so
that the same input gives the same steps. In real time it sleeps until something is due, or until a
backend, the bus or an order wakes it.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import dataclass, field
from heapq import heappop, heappush
from math import inf

from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import Outcome
from mmrs_core.behaviour.semantics import Phase, Step, Waiting
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.contributions.execution import (
    Backend,
    Bus,
    Clock,
    CommandId,
    Condition,
    Fault,
    Noting,
    Watched,
)
from mmrs_core.errors import LinkLostError, UnsupportedError
from mmrs_core.runtime.attention import BUS, Attention
from mmrs_core.runtime.obedience import Obedience
from mmrs_core.runtime.orders import Orders
from mmrs_core.runtime.peers import Peers
from mmrs_core.runtime.robot import HANDS_OFF, Rules, RunningRobot
from mmrs_core.scene import Policy

PACE = 0.05
"""Seconds between two looks at a backend, or a bus, that cannot say when to look again."""

Observer = Callable[[StepRecord], None]


@dataclass(frozen=True, slots=True)
class Terms:
    """What a run goes by, whatever its robots do.

    Attributes:
        run: identifier of the run.
        incarnation: differs each time that these robots are started within a run.
        observe: called with each step before it has an effect; a log, for example.
        seconds: of the run's clock, after which it is cut off.
        steps: number of them after which it is cut off, since a Choice can go round for ever.
        resumed: the steps that were made before the run was broken off, those of a robot in order.
        suspends: whether a battery that is low, and whose policy brings the robot down, breaks its program
            off without a fault, so that the run can be resumed with a full one.
        patience: seconds for which the run then waits for the order to resume once nobody else works.
        attention: through which backends wake the interpreter; None in simulated time.
        orders: what people order meanwhile.
        say: tells people what goes on.
    """

    run: str = "run-0"
    incarnation: str = "0"
    observe: Observer | None = None
    seconds: float = inf
    steps: int = 1_000_000
    resumed: tuple[StepRecord, ...] = ()
    suspends: bool = False
    patience: float = 0.0
    attention: Attention | None = None
    orders: Orders = field(default_factory=Orders)
    say: Callable[[str], None] = lambda words: None


TO_THE_END = Terms()
"""Of a run that nobody is told of and that comes to its end, unless a Choice goes round for ever."""


@dataclass(frozen=True, slots=True)
class Ending:
    """How a run ended.

    Attributes:
        outcome: INCOMPLETE where a limit cut it off.
        waiting: the robots that waited for slots that nobody can set any more, when that first
            became certain; it stays when policies then end their waits by a fault.
        faults: by robot.
        unconfirmed: robots that did not confirm that they have stopped.
        time: seconds of the run's clock.
        steps: how many were made.
        suspended: robots whose programs were broken off, to be resumed with a full battery.
        responses: to faults, by robot.
    """

    outcome: Outcome
    waiting: tuple[Waiting, ...]
    faults: Mapping[str, Fault]
    unconfirmed: tuple[str, ...]
    time: float
    steps: int
    suspended: tuple[str, ...] = ()
    responses: Mapping[str, str] = field(default_factory=dict)


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
    _refuse_unknown(program, backends, conditions)
    robots = []
    for robot in program.robots:
        if robot.id in backends:
            live = terms.attention is not None
            rules = Rules(conditions, (policies or {}).get(robot.id, ()), terms.suspends, terse=live)
            robots.append(RunningRobot(robot, backends[robot.id], bus, rules))
            robots[-1].restore(record for record in terms.resumed if record.robot == robot.id)
    return _Run(program, robots, bus, clock, terms).go()


def _refuse_unknown(
    program: Program, backends: Mapping[str, Backend], conditions: Mapping[str, Condition]
) -> None:
    known = {robot.id for robot in program.robots}
    for id in backends:
        if id not in known:
            raise ValueError(f"robot '{id}': not in the behaviour")
    unknown = [
        f"robot '{robot.id}', after move '{robot.moves[source].id}': condition '{transition.condition}'"
        for robot in program.robots
        if robot.id in backends
        for source, transition in sorted(robot.transitions.items())
        if transition.condition is not None and transition.condition not in conditions
    ]
    if unknown:
        raise UnsupportedError(f"{len(unknown)} choices have conditions that nobody decides", unknown)


class _Run:
    def __init__(
        self, program: Program, robots: list[RunningRobot], bus: Bus, clock: Clock, terms: Terms
    ) -> None:
        self._robots, self._bus, self._clock, self._terms = robots, bus, clock, terms
        self._by_id = {robot.id: order for order, robot in enumerate(robots)}
        self._whole = len(robots) == len(program.robots)
        self._peers = Peers(program, self._by_id, bus)
        self._obedience = Obedience(robots, terms.orders, clock)
        self._made = 0
        self._ready = list(range(len(robots)))
        self._wakes: list[tuple[float, int]] = []
        self._deadlock: tuple[Waiting, ...] = ()
        self._unconfirmed: list[str] = []
        self._idle_since: float | None = None
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
                self._look_after_stopping()
                if not self._deadlock and self._is_quiet():
                    self._deadlock = self._waiting()
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
        for robot in self._robots:
            if robot.point.is_final:
                self._peers.retire(robot.id, failed=robot.point.phase is Phase.FAILED)
                self._bus.leave(robot.id)
            elif robot.number > 0:
                robot.recover(self._clock.now())

    def _obey(self) -> None:
        for robot in self._obedience.obey():
            heappush(self._ready, self._by_id[robot])

    def _settled(self) -> Iterator[StepRecord]:
        """Make every step that is due now, the program's first robot first."""
        while self._ready and self._made < self._terms.steps:
            order = heappop(self._ready)
            while self._ready and self._ready[0] == order:
                heappop(self._ready)
            robot = self._robots[order]
            yield from self._advanced(robot)
            robot.wake = self._wake_time(robot)
            if robot.wake < inf:
                heappush(self._wakes, (robot.wake, order))

    def _advanced(self, robot: RunningRobot) -> Iterator[StepRecord]:
        while not robot.point.is_final and self._made < self._terms.steps:
            was_suspended = robot.suspended
            step = robot.due(self._clock.now(), self._peers)
            if robot.suspended and not was_suspended:
                self._tell_decision(robot, robot.fault or Fault("BATTERY_LOW"))
                self._stop(robot, robot.response)
            if step is None or not self._order(robot, step):
                return
            yield from self._make(robot, step)

    def _order(self, robot: RunningRobot, step: Step) -> bool:
        """Give a robot the logical time of a step; False: it cannot be made yet."""
        least = 0
        if step.sets:
            if robot.delivery is None:
                id = CommandId(self._terms.run, robot.id, self._terms.incarnation, robot.number)
                robot.delivery = self._bus.prepare(id, step.sets, step.active)
            if robot.delivery.lamport is None:
                return False
            least = robot.delivery.lamport
        waits = robot.awaited() if step.label in ("take", "choose") else ()
        clocks = (self._bus.state(slot).lamport for slot in waits)
        lamport = max((robot.lamport + 1, least, *(clock + 1 for clock in clocks)))
        if waits and not self._bus.passed(waits, lamport):
            return False
        robot.lamport = lamport
        return True

    def _make(self, robot: RunningRobot, step: Step) -> Iterator[StepRecord]:
        record = self._record(robot, step)
        try:
            if self._terms.observe is not None:
                self._terms.observe(record)
        except OSError as error:
            self._lose_log(robot, error)
            return
        yield record
        robot.follow(step, self._clock.now())
        self._made += 1
        if step.sets:
            self._deliver(robot, step)
        if robot.point.is_final:
            self._retire(robot)

    def _lose_log(self, robot: RunningRobot, error: OSError) -> None:
        """End the program of a robot whose steps cannot be recorded: none may be made then."""
        if not self._clock.passes_by_itself:
            raise error
        robot.fail(Fault("LOG_FAILED", error.strerror or str(error)))
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
                heappush(self._ready, self._by_id[owner])

    def _retire(self, robot: RunningRobot) -> None:
        """Note that a robot makes no further step, and have those look that may wait for it."""
        self._peers.retire(robot.id, failed=robot.point.phase is Phase.FAILED)
        self._bus.leave(robot.id)
        if robot.point.phase is Phase.FAILED:
            self._tell_decision(robot, robot.fault or Fault("CRASHED"))
            self._stop(robot, robot.response)
        for order, other in enumerate(self._robots):
            if other.point.phase is Phase.OUT:
                heappush(self._ready, order)

    def _tell_decision(self, robot: RunningRobot, found: Fault) -> None:
        self._terms.say(f"'{robot.id}': {found}; response: {robot.response}")
        if isinstance(robot.backend, Noting):
            content = {"what": found.which, "why": found.reason, "response": robot.response}
            robot.backend.note("decision", content)

    def _look_after_stopping(self) -> None:
        """Note which robots have confirmed that they stopped, or cannot."""
        now = self._clock.now()
        for robot in self._robots:
            if robot.stopping:
                self._look_after(robot, now)

    def _look_after(self, robot: RunningRobot, now: float) -> None:
        try:
            trouble = robot.backend.fault(now)
            robot.stopping = trouble is None and not robot.backend.finished(now)
        except LinkLostError as error:
            trouble, robot.stopping = Fault("LINK_LOST", str(error)), False
        if trouble is not None and robot.overtaken_by(trouble):
            self._tell_decision(robot, trouble)
            self._stop(robot, robot.response)
            return
        if trouble is not None:
            self._terms.say(f"'{robot.id}': not known to have stopped ({robot.response}): {trouble}")
            self._unconfirmed.append(robot.id)
        elif not robot.stopping:
            done = "is left alone" if robot.response == HANDS_OFF else f"has done {robot.response}"
            self._terms.say(f"'{robot.id}': {done}")
        self._obedience.stopped(robot.id, robot.stopping, trouble)

    def _wake_time(self, robot: RunningRobot) -> float:
        now = self._clock.now()
        event = robot.next_event(now)
        if event is None or event <= now:
            event = now + PACE
        unsure = robot.delivery is not None or robot.question or robot.held
        if unsure or (not self._whole and robot.point.phase is Phase.OUT):
            event = min(event, now + PACE)
        return event

    def _next_wake(self) -> float:
        """Return when to look again; inf where nothing is foreseen."""
        if self._is_quiet() and not self._is_patient():
            return self._patience_ends()
        while self._wakes and self._robots[self._wakes[0][1]].wake != self._wakes[0][0]:
            heappop(self._wakes)
        pace = self._clock.now() + PACE if any(robot.stopping for robot in self._robots) else inf
        return min(self._wakes[0][0] if self._wakes else inf, self._patience_ends(), pace)

    def _wake(self) -> None:
        now = self._clock.now()
        while self._wakes and self._wakes[0][0] <= now:
            time, order = heappop(self._wakes)
            if self._robots[order].wake == time:
                heappush(self._ready, order)
        if self._terms.attention is not None:
            self._attend(self._terms.attention.taken())

    def _attend(self, called: frozenset[str]) -> None:
        for order, robot in enumerate(self._robots):
            affected = robot.point.phase is Phase.OUT or robot.delivery is not None
            if robot.id in called or (BUS in called and affected):
                heappush(self._ready, order)

    def _is_over(self) -> bool:
        """Return whether nothing will happen any more in real time."""
        if not self._clock.passes_by_itself:
            return False
        if any(robot.stopping or self._is_watched(robot) for robot in self._robots):
            return False
        working = [robot for robot in self._robots if not robot.point.is_final and not robot.suspended]
        if not working or (self._is_quiet() and not self._is_patient()):
            ends = self._patience_ends(begin=True)
            return ends <= self._clock.now()
        self._idle_since = None
        return False

    def _is_watched(self, robot: RunningRobot) -> bool:
        if robot.fault is None or robot.released:
            return False
        return isinstance(robot.backend, Watched) and robot.backend.watched(self._clock.now())

    def _patience_ends(self, *, begin: bool = False) -> float:
        """Return when nobody waits any longer for robots to be resumed; the past if there are none."""
        if not any(robot.suspended for robot in self._robots):
            return -inf if begin else inf
        if begin and self._idle_since is None:
            self._idle_since = self._clock.now()
        return inf if self._idle_since is None else self._idle_since + self._terms.patience

    def _is_patient(self) -> bool:
        """Return whether a wait of some robot will end by itself."""
        return any(robot.deadline < inf for robot in self._robots if robot.is_waiting)

    def _is_quiet(self) -> bool:
        """Return whether every robot is at its end or waits, so that no slot changes any more."""
        return self._whole and all(
            robot.point.is_final or robot.is_waiting or robot.suspended for robot in self._robots
        )

    def _waiting(self) -> tuple[Waiting, ...]:
        return tuple(
            Waiting(robot.id, robot.move.id, robot.lacking) for robot in self._robots if robot.lacking
        )

    def _halt(self) -> None:
        """Stop every robot that is still at work, and wait until each has confirmed it."""
        for robot in self._robots:
            if not robot.point.is_final and not robot.suspended:
                self._stop(robot, "HOLD")
        self._look_after_stopping()
        while any(robot.stopping for robot in self._robots):
            self._clock.sleep_until(self._clock.now() + PACE)
            self._look_after_stopping()
        self._obedience.give_up()

    def _stop(self, robot: RunningRobot, response: str) -> None:
        robot.response = response
        try:
            robot.backend.stop(self._clock.now(), response)
        except LinkLostError:
            self._unconfirmed.append(robot.id)
        else:
            robot.stopping = self._clock.passes_by_itself

    def _ending(self) -> Ending:
        faults = {robot.id: robot.fault for robot in self._robots if robot.fault is not None}
        suspended = tuple(robot.id for robot in self._robots if robot.suspended)
        done = all(robot.point.phase is Phase.DONE for robot in self._robots)
        if suspended or (not self._is_quiet() and not all(robot.point.is_final for robot in self._robots)):
            outcome = Outcome.INCOMPLETE
        else:
            outcome = Outcome.FAILED if faults else Outcome.SUCCESS if done else Outcome.STUCK
        unconfirmed = tuple(dict.fromkeys(self._unconfirmed))
        return Ending(outcome, self._deadlock, faults, unconfirmed, self._clock.now(), self._made, suspended)
