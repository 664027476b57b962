"""Runs a behaviour in real time: orders, interrupts, and what became of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

import typer

from mmrs_core.behaviour.log import read_log, read_logs, recover_log
from mmrs_core.behaviour.program import FEEDBACK, Action, Program
from mmrs_core.behaviour.replay import replay
from mmrs_core.cli.behaviours import Loaded
from mmrs_core.cli.buses import bus_for
from mmrs_core.cli.observers import ObserverThread
from mmrs_core.cli.output import counted, say, tell
from mmrs_core.cli.run_options import (
    RunOptions,
    check_backends,
    links_of,
    options_of_robots,
    robots_of,
    stop_response,
)
from mmrs_core.cli.session import Session
from mmrs_core.contributions.execution import Clock
from mmrs_core.errors import InvalidModelError
from mmrs_core.pictures.figures import clock
from mmrs_core.pipeline import backend_for, conditions_for, input_of
from mmrs_core.simulation.live import live_run_for, run_live
from mmrs_core.simulation.run import inputs_of
from mmrs_runtime.bus.carriers.carrier import Carrier
from mmrs_runtime.bus.program_bus import begin_all, slots_path
from mmrs_runtime.control import Control, Status, Taken
from mmrs_runtime.engine.clocks import FollowingClock, RealClock
from mmrs_runtime.engine.live import exit_code
from mmrs_runtime.engine.resuming import over_by
from mmrs_runtime.engine.terms import Ending
from mmrs_runtime.injection import Rehearsal, injections
from mmrs_runtime.orders.orders import Orders, stopping
from mmrs_runtime.records.blackbox import black_box_path, last_time, plan_of
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import SUFFIX, StepRecord, log_name
from mmrs_runtime.screen import unfailing


@dataclass(frozen=True, slots=True)
class Result:
    """What became of a run."""

    ending: Ending
    logs: tuple[Path, ...]

    @property
    def exit_code(self) -> int:
        """Return what the shell gets."""
        return exit_code(self.ending)

    def as_json(self) -> Mapping[str, object]:
        """Return all of it as JSON has it."""
        return {"ending": self.ending, "logs": self.logs}

    def say(self) -> None:
        """Print it as text."""
        ending = self.ending
        say(f"{ending.outcome.value} after {clock(ending.time)}, {ending.steps} steps")
        for robot, fault in ending.faults.items():
            word = "broken off" if robot in ending.suspended else "fault"
            say(f"  {word} of '{robot}': {fault}")
        for robot in ending.suspended:
            unknown = robot in ending.unconfirmed
            happened = "is not known to have come down: look after it" if unknown else "has not gone on"
            happened = ending.came_down.get(robot, happened)
            say(f"  '{robot}' {happened}; --resume continues where it stopped")
        for waiting in ending.waiting:
            say(f"  {waiting}")
        for robot in ending.lost:
            say(f"  the link to '{robot}' was lost")
        for robot in (each for each in ending.unconfirmed if each not in ending.suspended):
            say(f"  '{robot}' has not confirmed that it stopped")
        for log in self.logs:
            say(f"written: {log}")


def carry_out(session: Session, loaded: Loaded, wanted: RunOptions) -> Result:
    """Carry a behaviour out; return what became of it.

    Raises:
        typer.BadParameter: if an option makes no sense.
        LinkLostError: if a robot does not answer at first.
        UsageError: if there is no such backend, or no Choice asks for what is assumed.
        UnsupportedError: if the backend cannot do what the behaviour holds.
    """
    program = loaded.program
    backend = backend_for(program, session.contributions, wanted.backend, wanted.own_backends)
    here = robots_of(program, wanted.robots)
    links = links_of(wanted.links, here, robots_of(program, ()))
    check_backends(wanted, links, here, session.contributions.vehicles)
    resumed = resumed_steps(program, wanted, here)
    run = resumed[0].run if resumed else wanted.run
    orders = Orders(stop_response(wanted.on_stop))
    options = options_of_robots(wanted, here, session.contributions.vehicles)
    conditions = conditions_for(program, session.contributions, wanted.assume, asks=True)
    with ExitStack() as stack:
        clock = RealClock(wanted.speedup, end_of(resumed, wanted.folder))
        wrap = bus_faults(wanted.options.get("inject", ""), program, wanted.bus.shared, clock, stack)
        given = resumed if wanted.resume else None
        bus = bus_for(program, here, run, wanted.folder, wanted.bus, given, wrap)
        stack.callback(bus.close)
        writer = stack.enter_context(LogWriter(wanted.folder, resumed=wanted.resume))
        observers = ObserverThread(session.observers)
        recorder = StepRecorder(observers, writer, program)
        inputs = inputs_of(input_of(program, loaded.place, session.contributions), options)
        live_run = replace(
            live_run_for(program, {id: inputs[id] for id in here}, backend, bus, conditions),
            clock=clock,
            orders=orders,
            run=run,
            folder=wanted.folder,
            links=links,
            resumed=resumed,
            patience=wanted.patience,
            meet=begin_all(bus, program.executable, here, resumed, wanted.bus.sync, tell),
            observe=_telling(recorder.record, program),
            sync=writer.sync,
            say=tell,
        )

        def status(robot: str) -> Mapping[str, object]:
            return {**live_run.status_board.status(robot), **recorder.status(robot)}

        _hear(stack, wanted.folder, run, here, orders, status)
        stack.enter_context(stopping(orders, here, tell))
        stack.enter_context(unfailing())
        stack.callback(observers.close)
        ending = run_live(live_run)
    names = [wanted.folder / log_name(robot) for robot in here]
    return Result(ending, tuple(path for path in names if path.exists()))


def _hear(
    stack: ExitStack, folder: Path, run: str, robots: tuple[str, ...], orders: Orders, status: Status
) -> None:
    try:
        stack.callback(Control(folder, run, robots, orders, status).close)
    except Taken as error:
        raise typer.BadParameter(f"--log {folder}: {error}") from error


def _telling(observe: Callable[[StepRecord], None], program: Program) -> Callable[[StepRecord], None]:
    """Return what observes steps as before, and tells people of every move that begins."""
    kinds = {(robot.id, move.id): move for robot in program.robots for move in robot.moves}

    def observe_and_print(record: StepRecord) -> None:
        observe(record)
        if record.label == "begin":
            move = kinds[record.robot, record.move]
            serves = f" for task '{move.task}'" if move.task else ""
            tell(f"{clock(record.time)} '{record.robot}': {move.kind} '{move.id}'{serves}")

    return observe_and_print


class StepRecorder:
    """Logs the steps of this process's robots, and keeps the last feedback of each."""

    def __init__(self, observers: ObserverThread, writer: LogWriter, program: Program) -> None:
        self._observers, self._writer = observers, writer
        self._actions = _actions_of(program)
        self._reported: dict[str, Mapping[str, object]] = {}

    def record(self, record: StepRecord) -> None:
        """Log a step and pass it to the observers."""
        self._writer.write(record)
        action = self._actions.get((record.robot, record.move, record.detail))
        if record.label == "act" and action is not None and action.is_a(FEEDBACK):
            self._reported[record.robot] = {"name": action.name, "content": dict(action.parameters)}
        self._observers.see_step(record)

    def status(self, robot: str) -> Mapping[str, object]:
        """Return the last feedback of a robot as ``reported``; empty before its first."""
        reported = self._reported.get(robot)
        return {} if reported is None else {"reported": reported}


def _actions_of(program: Program) -> dict[tuple[str, str, str], Action]:
    """Return all actions by robot, move, and the detail by which logs identify them."""
    return {
        (robot.id, move.id, f"{when}:{index}"): action
        for robot in program.robots
        for move in robot.moves
        for when, actions in (("pre", move.before), ("post", move.after))
        for index, action in enumerate(actions)
    }


def bus_faults(
    text: str, program: Program, shared: bool, clock: Clock, stack: ExitStack
) -> Callable[[Carrier], Carrier]:
    """Return what puts the faults of the bus in front of its carrier, and begin them at their times.

    Args:
        text: as in ``--inject``.
        program: of all robots.
        shared: whether there are robots in other processes.
        clock: of the run.
        stack: ends the faults.

    Raises:
        typer.BadParameter: if a fault makes no sense.
    """
    if "bus-" not in text:
        return lambda carrier: carrier

    robots = [robot.id for robot in program.robots]
    try:
        faults = injections([text], {robot: robot for robot in robots}, alone=not shared)
    except ValueError as error:
        raise typer.BadParameter(f"--inject {error}") from error
    rehearsal = Rehearsal(faults.of_bus(), FollowingClock(clock), lambda line: None)
    stack.callback(rehearsal.close)
    rehearsal.start()
    return lambda carrier: rehearsal.wrap_carrier(carrier, robots)


def resumed_steps(program: Program, wanted: RunOptions, here: tuple[str, ...]) -> tuple[StepRecord, ...]:
    """Return the steps that the robots of this process made before; none where nothing began then.

    Raises:
        typer.BadParameter: if there are logs without --resume, or none with it.
        InvalidModelError: if they are not logs of this behaviour.
    """
    found = [path for robot in here if (path := wanted.folder / log_name(robot)).exists()]
    _refuse_others(program, wanted)
    if not wanted.resume:
        if found:
            raise typer.BadParameter(
                f"--log {wanted.folder}: already contains logs; choose another folder,"
                " or resume that run with --resume"
            )
        return ()
    if not found:
        _refuse_unknown(wanted.folder, here)
        return ()
    for path in found:
        if plan_of(black_box_path(path)) not in ("", program.fingerprint):
            raise InvalidModelError(f"{path}: was flown by another plan of the mission")
    records = read_logs(found, partial=True)
    for damage in (each for path in found for each in recover_log(path)[1]):
        tell(f"{damage}: left out")
    result = replay(program, records, partial=True)
    if not result.accepted and len(here) == len(program.robots):
        raise InvalidModelError(f"{wanted.folder}: not logs of this behaviour: {result.complaints[0]}")
    try:
        over = over_by(program.executable, records)
    except ValueError as error:
        raise InvalidModelError(f"{wanted.folder}: {error}") from error
    for robot, why in over.items():
        ended = f"its program has ended by {why}; nothing steers it now" if why else "has come to its end"
        tell(f"'{robot}': {ended}")
    if all(record.label == "fault" and record.seq == 0 for record in records):
        raise typer.BadParameter("--resume: nothing had begun; begin again, with another --log")
    if set(over) >= set(here):
        raise typer.BadParameter(f"--resume: nothing is left to do for {', '.join(here)}")
    tell(f"continues after {counted(len(records), 'step')} and {clock(result.duration)}")
    return records


def _refuse_unknown(folder: Path, robots: Sequence[str]) -> None:
    """Refuse a folder in which nothing says that these robots were to begin; logs begin with a step."""
    logs = [folder / log_name(robot) for robot in robots]
    if not any(path.exists() for log in logs for path in (black_box_path(log), slots_path(log))):
        raise typer.BadParameter(f"--resume: no logs in {folder}")


def end_of(records: Sequence[StepRecord], folder: Path) -> float:
    """Return how many seconds of the run have passed, as logs and black boxes tell."""
    boxes = {black_box_path(folder / log_name(record.robot)) for record in records}
    return max((*(record.time for record in records), *map(last_time, boxes)), default=0.0)


def _refuse_others(program: Program, wanted: RunOptions) -> None:
    """Refuse a folder with logs of another run, or of another behaviour."""
    known = {log_name(robot.id) for robot in program.robots}
    for path in sorted(wanted.folder.glob(f"*{SUFFIX}")) if wanted.folder.is_dir() else ():
        records = read_log(path, partial=True)
        strange = path.name not in known or any(each.run != wanted.run for each in records[:1])
        if strange and not (wanted.resume and path.name in known):
            raise typer.BadParameter(f"--log {path}: is of another run; choose another folder")
