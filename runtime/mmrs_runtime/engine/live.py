"""Runs in real time: robots that are connected, got ready, driven, and let go of again."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path

from ..bus import Incomplete
from ..faults import LINK_LOST, ORDERED, STOPPED, reason_of
from ..policies import Policy
from ..program import Program
from ..records.steps import StepRecord
from ..semantics import Outcome
from ..slots import Slots
from ..vehicle import Condition, Vehicle
from .clocks import RealClock
from .connecting import Live, let_go
from .life import PACE
from .preflight import EarlyOrders, NotReadyError, note_alone, record
from .resuming import over_by
from .run import run
from .terms import Attention, Ending, Terms

OK, FAILED, LINK, INTERRUPTED = 0, 1, 5, 130
"""Exit codes: all robots are at their ends, or some are not, or a link was lost, or people stopped them."""

GATHERING_SECONDS = 0.5
"""Real seconds for which more is waited for, once something keeps a robot from getting ready."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LiveRun(Terms):
    """A run in real time, before it begins.

    Attributes:
        connect: makes the vehicle of each robot of this process, in the order in which they are
            connected. It may raise anything, and nothing begins then.
        bus: between all robots of the program.
        conditions: by identifier; all that choices of these robots ask for.
        policies: by robot: those of its type and kind, which come after the program's own.
        clock: of the run.
        folder: of the logs; None where none are kept.
        links: how robots are reached, by robot; backends know their defaults.
        meet: waits for robots of other processes once those of this one are ready, calling
            its argument repeatedly; returns, by robot, how accurately they begin together. It raises
            `Incomplete` where they have not come.
        ready: called with the vehicles before anything moves; raises what must keep them from it.
    """

    program: Program
    connect: Mapping[str, Callable[[Live], Vehicle]]
    bus: Slots
    conditions: Mapping[str, Condition]
    policies: Mapping[str, tuple[Policy, ...]] = field(default_factory=dict)
    clock: RealClock = field(default_factory=RealClock)
    folder: Path | None = None
    links: Mapping[str, str] = field(default_factory=dict)
    meet: Callable[[Callable[[], None]], Mapping[str, str]] = lambda look: {}
    ready: Callable[[Mapping[str, Vehicle]], None] = lambda vehicles: None
    suspends: bool = True
    say: Callable[[str], None] = print

    def fail(self, robot: str, which: str) -> None:
        """Log that a robot's program has ended before its first step; report it if that fails."""
        start, time = self.program.by_id[robot].start, round(self.clock.now(), 6)

        def kept(error: OSError | None) -> None:
            if error is not None:
                self.say(f"'{robot}': the fault is not in the log: {reason_of(error)}")

        try:
            if self.observe is not None:
                self.observe(StepRecord(self.run, robot, 0, 1, time, "fault", start, which))
            if self.sync is not None:
                self.sync(robot, kept)
        except OSError as error:
            kept(error)


def run_live(live_run: LiveRun) -> Ending:
    """Run the programs; return how that ended.

    No robot begins before all are ready; once some are in motion, as in a run that is resumed, each
    continues, or begins, as soon as it is ready, and one that does not get ready is left out. One whose
    program had ended before is left alone. In the end, every robot that has not come to its end has been
    stopped, all links are closed, and all orders answered.

    Raises:
        NotReadyError: if a robot does not get ready, and none is in motion without it.
        Incomplete: if robots of other processes have not come; see `LiveRun.meet`.
        Exception: what `LiveRun.connect`, or `LiveRun.ready`, raises.
        ValueError: if the steps to resume from are not the program's.
        KeyboardInterrupt: if robots are ordered to stop before they are ready.
    """
    attention = Attention(live_run.clock)
    over = over_by(live_run.program, live_run.resumed)
    live_run = replace(
        live_run, connect={id: each for id, each in live_run.connect.items() if id not in over}
    )
    with ExitStack() as stack:
        stack.callback(live_run.orders.close, "the run has ended")
        robots: dict[str, Vehicle] = {}
        live_run.orders.vehicles = robots
        stack.callback(let_go, robots)
        under_way = any(record.robot in live_run.connect for record in live_run.resumed)
        early = None if under_way else EarlyOrders(live_run, robots)
        live_run.status_board.held = early.held if early is not None else ()
        try:
            _connect(robots, live_run, attention, early)
            live_run.status_board.connect(robots)
            if early is not None:
                _get_ready(robots, live_run, early)
        except BaseException as error:
            if early is not None:
                early.give_up("the run has ended")
            if isinstance(error, NotReadyError):
                record(robots, error.faults, live_run.fail)
            raise
        live_run.ready(robots)
        ending = run(
            live_run.program,
            robots,
            slots=live_run.bus,
            clock=live_run.clock,
            conditions=live_run.conditions,
            policies=live_run.policies,
            terms=replace(live_run, incarnation=uuid.uuid4().hex, unready=under_way, attention=attention),
        )
        if robots and set(ending.absent) == set(robots):
            raise NotReadyError({id: ending.faults[id] for id in ending.absent})
        return ending


def exit_code(ending: Ending) -> int:
    """Return what the shell gets."""
    faults = {ending.faults[robot].which for robot in ending.responses}
    if LINK_LOST in faults or ending.unconfirmed or ending.lost:
        return LINK
    if {STOPPED, ORDERED} & faults:
        return INTERRUPTED
    return OK if ending.outcome is Outcome.SUCCESS else FAILED


def _connect(
    robots: dict[str, Vehicle], live_run: LiveRun, attention: Attention, early: EarlyOrders | None
) -> None:
    """Connect robots one after the other, and look out for orders to those that are there."""
    shared: dict[str, object] = {}
    for id, connect in live_run.connect.items():
        live = Live(
            clock=live_run.clock,
            wake=attention.for_robot(id),
            say=_named(live_run.say, id),
            run=live_run.run,
            folder=live_run.folder,
            links=live_run.links,
            shared=shared,
            announce=live_run.say,
            records=tuple(record for record in live_run.resumed if record.robot == id),
        )
        robots[id] = connect(live)
        if early is not None:
            early.look(set(live_run.connect))


def _named(say: Callable[[str], None], robot: str) -> Callable[[str], None]:
    return lambda words: say(f"'{robot}': {words}")


def _get_ready(robots: Mapping[str, Vehicle], live_run: LiveRun, early: EarlyOrders) -> None:
    clock = live_run.clock
    preparing = {id: robot for id, robot in robots.items() if robot.prepare(clock.now())}
    live_run.orders.called = clock.wake
    _await_ready(preparing, clock, early)
    _meet(robots, live_run, early)
    early.pass_on()


def _await_ready(robots: Mapping[str, Vehicle], clock: RealClock, early: EarlyOrders) -> None:
    """Return when all robots are ready, and no fault has come up on one that was so earlier.

    After the first fault, wait a moment for the others, so that all faults are reported at once.
    """
    unready, told_at = set(robots), inf
    while unready:
        now = clock.now()
        for robot in robots.values():
            robot.look(now)
        faults = {id: robot.trouble for id, robot in robots.items() if robot.trouble is not None}
        told_at = min(told_at, now + GATHERING_SECONDS * clock.speedup) if faults else inf
        if faults and (now >= told_at or faults.keys() >= unready):
            raise NotReadyError(faults)
        unready = {id for id in unready if id in faults or not robots[id].done}
        early.look(unready)
        if unready:
            clock.sleep_until(clock.now() + PACE)


def _meet(robots: Mapping[str, Vehicle], live_run: LiveRun, early: EarlyOrders) -> None:
    def look() -> None:
        while True:
            early.look(())
            for id, robot in robots.items():
                robot.look(live_run.clock.now())
                if robot.trouble is not None:
                    raise NotReadyError({id: robot.trouble})
            if not early.held:
                return
            live_run.clock.sleep_until(live_run.clock.now() + PACE)

    try:
        met = live_run.meet(look)
    except Incomplete as error:
        note_alone(robots.values(), str(error))
        raise
    for id, why in met.items():
        robots[id].note("decision", {"what": "TOGETHER", "why": why, "response": "begins"})
