"""Runs a behaviour in real time: logs, orders, interrupts, and what became of it."""

from __future__ import annotations

import re
import signal
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType

import typer

from mmrs_core.behaviour.log import SUFFIX, LogWriter, log_name, read_log, read_logs
from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import Outcome, replay
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.cli.behaviours import Loaded
from mmrs_core.cli.bus_faults import bus_faults
from mmrs_core.cli.buses import BusWishes, begin_all, bus_for
from mmrs_core.cli.figures import clock
from mmrs_core.cli.interruption import INTERRUPTED
from mmrs_core.cli.journey import Workshop
from mmrs_core.cli.observing import Observer
from mmrs_core.cli.orders_heard import hear_orders
from mmrs_core.cli.output import counted, say, tell, unfailing
from mmrs_core.errors import InvalidModelError, LinkLostError
from mmrs_core.flight.records.blackbox import black_box_path, last_time
from mmrs_core.pipeline import conditions_for, inputs_of, run_live
from mmrs_core.runtime.clock import RealClock
from mmrs_core.runtime.live import Venture
from mmrs_core.runtime.obedience import STOPPED
from mmrs_core.runtime.orders import STOP, Orders
from mmrs_core.runtime.resuming import over_by
from mmrs_core.runtime.terms import Ending

ON_STOP = {"hold": "HOLD", "return": "RETURN", "land": "LAND"}
FAILED = 1
_SERIAL = re.compile(r"/|COM\d+", re.IGNORECASE)
"""How names of serial devices begin."""

_CAME_DOWN = {
    "RETURN": "came home",
    "EMERGENCY_AREA": "went to an emergency area",
    "LAND": "landed where it was",
    "SURFACE": "came up where it was",
}


@dataclass(frozen=True, slots=True)
class Wishes:
    """What the command line asks for.

    Attributes:
        folder: of the logs.
        options: of the backend.
        links: as in ``--connect``.
        robots: those that this process runs; none: all.
        patience: seconds to wait for the order to resume once nobody else works.
        assume: fixed answers, by condition.
        bus: what there is to say of the bus.
    """

    folder: Path
    backend: str = "mavlink"
    options: Mapping[str, str] = field(default_factory=dict)
    links: tuple[str, ...] = ()
    robots: tuple[str, ...] = ()
    resume: bool = False
    run: str = "run-0"
    speedup: float = 1.0
    on_stop: str = "hold"
    patience: float = 0.0
    assume: Mapping[str, bool] = field(default_factory=dict)
    bus: BusWishes = field(default_factory=BusWishes)


@dataclass(frozen=True, slots=True)
class Result:
    """What became of a run."""

    ending: Ending
    logs: tuple[Path, ...]

    @property
    def exit_code(self) -> int:
        """Return what the shell gets."""
        faults = {self.ending.faults[robot].which for robot in self.ending.responses}
        if "LINK_LOST" in faults or self.ending.unconfirmed:
            return LinkLostError.exit_code
        if STOPPED in faults:
            return INTERRUPTED
        return 0 if self.ending.outcome is Outcome.SUCCESS else FAILED

    def as_json(self) -> Mapping[str, object]:
        """Return all of it as JSON has it."""
        return {"ending": self.ending, "logs": self.logs}

    def say(self) -> None:
        """Print it for people."""
        ending = self.ending
        say(f"{ending.outcome.value} after {clock(ending.time)}, {ending.steps} steps")
        for robot, fault in ending.faults.items():
            word = "broken off" if robot in ending.suspended else "fault"
            say(f"  {word} of '{robot}': {fault}")
        for robot in ending.suspended:
            way = _CAME_DOWN.get(ending.responses[robot])
            changes = way is not None and ending.faults[robot].which == "BATTERY_LOW"
            why = f"{way} for its battery" if changes else "has not gone on"
            say(f"  '{robot}' {why}; --resume goes on where it stopped")
        for waiting in ending.waiting:
            say(f"  {waiting}")
        for robot in ending.unconfirmed:
            say(f"  '{robot}' has not confirmed that it stopped")
        for log in self.logs:
            say(f"written: {log}")


def carry_out(workshop: Workshop, loaded: Loaded, wishes: Wishes) -> Result:
    """Carry a behaviour out; return what became of it.

    Raises:
        typer.BadParameter: if an option makes no sense.
        LinkLostError: if a robot does not answer at first.
        UnsupportedError: if the backend cannot do what the behaviour holds.
    """
    program = loaded.program
    here = _robots(program, wishes.robots)
    links = _links(wishes.links, here)
    _check_mavlink(wishes, links, here)
    resumed = _resumed(program, wishes, here)
    run = resumed[0].run if resumed else wishes.run
    orders = Orders(_on_stop(wishes.on_stop))
    with ExitStack() as stack:
        clock = RealClock(wishes.speedup, _end_of(resumed, wishes.folder))
        wrap = bus_faults(wishes.options.get("inject", ""), program, wishes.bus.shared, clock, stack)
        given = resumed if wishes.resume else None
        bus = bus_for(program, here, run, wishes.folder, wishes.bus, given, wrap)
        stack.callback(bus.close)
        writer = stack.enter_context(LogWriter(wishes.folder, resumed=wishes.resume))
        observer = Observer(workshop, writer, program)
        venture = Venture(
            program,
            inputs_of(program, loaded.place, workshop.contributions, options=wishes.options, robots=here),
            bus,
            conditions_for(program, workshop.contributions, wishes.assume, asks=True),
            clock=clock,
            orders=orders,
            run=run,
            folder=wishes.folder,
            links=links,
            resumed=resumed,
            patience=wishes.patience,
            meet=begin_all(bus, program, _unbegun(here, resumed), run, wishes.bus.sync),
            observe=observer.observe,
            say=tell,
        )
        stack.enter_context(hear_orders(wishes.folder, run, here, orders, observer.status))
        stack.enter_context(_stopping(orders, here))
        stack.enter_context(unfailing())
        ending = _collected(run_live(venture, wishes.backend, workshop.contributions), program)
    names = [wishes.folder / log_name(robot) for robot in here]
    return Result(ending, tuple(path for path in names if path.exists()))


def _collected(steps: Generator[StepRecord, None, Ending], program: Program) -> Ending:
    kinds = {(robot.id, move.id): move for robot in program.robots for move in robot.moves}
    while True:
        try:
            record = next(steps)
        except StopIteration as stop:
            ending: Ending = stop.value
            return ending
        if record.label == "begin":
            move = kinds[record.robot, record.move]
            serves = f" for task '{move.task}'" if move.task else ""
            tell(f"{clock(record.time)} '{record.robot}': {move.kind} '{move.id}'{serves}")


def _robots(program: Program, wanted: tuple[str, ...]) -> tuple[str, ...]:
    known = tuple(robot.id for robot in program.robots)
    for robot in wanted:
        if robot not in known:
            raise typer.BadParameter(f"--robot {robot}: not in the behaviour, which has {', '.join(known)}")
    return tuple(robot for robot in known if not wanted or robot in wanted)


def _unbegun(robots: tuple[str, ...], resumed: tuple[StepRecord, ...]) -> list[str]:
    begun = {record.robot for record in resumed}
    return [robot for robot in robots if robot not in begun]


def _on_stop(word: str) -> str:
    if word not in ON_STOP:
        raise typer.BadParameter(f"--on-stop {word}: is none of {', '.join(ON_STOP)}")
    return ON_STOP[word]


def _check_mavlink(wishes: Wishes, links: Mapping[str, str], robots: tuple[str, ...]) -> None:
    """Refuse links and faults that nobody can understand.

    Raises:
        typer.BadParameter: if there are any.
    """
    if wishes.backend != "mavlink":
        return
    from mmrs_core.flight.injection import injections
    from mmrs_core.flight.links.ports import address_of, split_system

    for text in links.values():
        try:
            url, _ = split_system(text)
            if address_of(url) is None and not _SERIAL.match(url):
                raise ValueError(f"{url}: is neither udpin:, udpout: or tcp:HOST:PORT nor a serial device")
        except ValueError as error:
            raise typer.BadParameter(f"--connect {error}") from error
    if inject := wishes.options.get("inject"):
        try:
            injections([inject], {robot: links.get(robot, "") for robot in robots})
        except ValueError as error:
            raise typer.BadParameter(f"--inject {error}") from error


def _links(given: tuple[str, ...], robots: tuple[str, ...]) -> dict[str, str]:
    links: dict[str, str] = {}
    for text in given:
        robot, separator, url = text.partition("=")
        if not separator and len(robots) > 1:
            raise typer.BadParameter(f"--connect {text}: which robot? say ROBOT={text}")
        if separator and robot not in robots:
            raise typer.BadParameter(f"--connect {text}: there is no robot '{robot}' here")
        links[robot if separator else robots[0]] = url if separator else text
    return links


def _resumed(program: Program, wishes: Wishes, here: tuple[str, ...]) -> tuple[StepRecord, ...]:
    """Return the steps that the robots of this process made before.

    Raises:
        typer.BadParameter: if there are logs without --resume, or none with it.
        InvalidModelError: if they are not logs of this behaviour.
    """
    found = [path for robot in here if (path := wishes.folder / log_name(robot)).exists()]
    _refuse_others(program, wishes)
    if not wishes.resume:
        if found:
            raise typer.BadParameter(f"--log {wishes.folder}: holds logs already; --resume goes on with them")
        return ()
    if not found:
        raise typer.BadParameter(f"--resume: no logs in {wishes.folder}")
    records = read_logs(found, partial=True)
    result = replay(program, records, partial=True)
    if not result.accepted and len(here) == len(program.robots):
        raise InvalidModelError(f"{wishes.folder}: not logs of this behaviour: {result.complaints[0]}")
    try:
        over = over_by(program, records)
    except ValueError as error:
        raise InvalidModelError(f"{wishes.folder}: {error}") from error
    for robot, why in over.items():
        tell(f"'{robot}': {f'its program has ended by {why}' if why else 'has come to its end'}")
    if set(over) >= set(here):
        raise typer.BadParameter(f"--resume: nothing is left to do for {', '.join(here)}")
    tell(f"goes on after {counted(len(records), 'step')} and {clock(result.duration)}")
    return records


def _end_of(records: Sequence[StepRecord], folder: Path) -> float:
    """Return how many seconds of the run have passed, as logs and black boxes tell."""
    boxes = {black_box_path(folder / log_name(record.robot)) for record in records}
    return max((*(record.time for record in records), *map(last_time, boxes)), default=0.0)


def _refuse_others(program: Program, wishes: Wishes) -> None:
    """Refuse a folder with logs of another run, or of another behaviour."""
    known = {log_name(robot.id) for robot in program.robots}
    for path in sorted(wishes.folder.glob(f"*{SUFFIX}")) if wishes.folder.is_dir() else ():
        records = read_log(path, partial=True)
        strange = path.name not in known or any(each.run != wishes.run for each in records[:1])
        if strange and not (wishes.resume and path.name in known):
            raise typer.BadParameter(f"--log {path}: is of another run; choose another folder")


@contextmanager
def _stopping(orders: Orders, robots: tuple[str, ...]) -> Iterator[None]:
    """Have interrupts stop the robots; the second one ends the waiting for them.

    A terminal that closes gives no order: robots fly on.
    """
    seen: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        seen.append(number)
        if len(seen) > 1:
            raise KeyboardInterrupt
        tell("stopping; interrupt again to end without waiting for robots, and those that pilots have")
        orders.give(STOP, robots)

    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    if hasattr(signal, "SIGHUP"):
        before[signal.SIGHUP] = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
