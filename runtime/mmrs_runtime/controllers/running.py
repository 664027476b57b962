"""Runs one robot's program, or those of several robots, from the command line."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from itertools import chain

from .. import program as runtime
from ..bus import Incomplete
from ..bus.program_bus import ProgramBus, begin_all, shared_bus, strangers_of
from ..control import Control, Taken
from ..engine.clocks import RealClock
from ..engine.connecting import Live
from ..engine.live import FAILED, INTERRUPTED, LINK, LiveRun, exit_code, run_live
from ..engine.preflight import NotReadyError
from ..engine.resuming import over_by, restore
from ..engine.terms import Ending
from ..faults import LINK_LOST, FaultError, reason_of
from ..injection import Rehearsal, noted_in
from ..orders.orders import Orders, stopping
from ..policies import NOTHING
from ..program import Move, Notify, Program, SlotId
from ..records.blackbox import BlackBox, black_box_path
from ..records.log import LogWriter, read
from ..records.steps import StepRecord
from ..screen import bear_all_characters, say, unfailing
from ..slots import LocalSlots
from ..vehicle import Vehicle
from .box_entries import start_of
from .driver import Driver, DriverInput
from .options import Options, options_of, parser_for
from .user_functions import Condition, Locator, UserFunctions
from .vocabulary import Robot


def run_controllers(
    driver: Driver,
    robots: Sequence[Robot],
    conditions: Mapping[str, Condition] | None = None,
    locators: Mapping[str, Locator] | None = None,
    arguments: Sequence[str] | None = None,
) -> int:
    """Run the programs of robots on the engine, and return the exit code.

    Args:
        driver: of their vehicles.
        robots: at least one.
        conditions: what decides Choices, by identifier.
        locators: what finds objects, by description.
        arguments: as on the command line; None: those of this process.
    """
    bear_all_characters()
    parser = parser_for(robots, driver)
    options = options_of(parser, robots, driver, arguments)
    seen = {robot.id: driver.sees(robot) for robot in robots}
    functions = UserFunctions(conditions or {}, locators or {}, seen)
    for fault in functions.faults(robots):
        parser.error(fault)
    with ExitStack() as stack:
        stack.enter_context(unfailing())
        rehearsal = Rehearsal(options.inject, options.clock, say)
        program, resumed = program_of(robots), _resumed(robots, options)
        driver.open(DriverInput(options, rehearsal, functions.locators, stack))
        bus = _slots(parser, program, robots, options, rehearsal, resumed, stack)
        writer = stack.enter_context(_log(parser, options))
        orders = Orders(options.on_stop.upper())
        ids = tuple(robot.id for robot in robots)
        assert isinstance(options.clock.followed, RealClock)
        live_run = LiveRun(
            program=program,
            connect={robot.id: partial(_connect, driver, options, rehearsal, robot) for robot in robots},
            bus=bus,
            conditions=functions.decides(robots),
            clock=options.clock.followed,
            orders=orders,
            run=options.run,
            folder=options.log,
            resumed=resumed,
            patience=options.battery_patience * options.clock.speedup,
            meet=begin_all(bus, program, ids, resumed, options.sync, say),
            observe=_telling(writer, robots),
            sync=writer.sync,
            say=say,
        )
        stack.callback(rehearsal.close)
        rehearsal.start()
        _hear(parser, options, ids, live_run, stack)
        stack.enter_context(stopping(orders, ids, say))
        return _run(live_run)


def _connect(driver: Driver, options: Options, rehearsal: Rehearsal, robot: Robot, live: Live) -> Vehicle:
    """Return a robot's vehicle; one that cannot be reached leaves its black box, which says so."""
    path, mark = black_box_path(options.log / robot.log), {"dry_run": True} if options.dry else {}
    box = BlackBox(path, live.run, robot.id, options.clock.now, mark=mark, say=live.say)
    rehearsal.record(robot.id, noted_in(box))
    try:
        return driver.connect(robot, live, box)
    except FaultError as fault:
        box.write("start", **start_of(robot, None))
        box.write("decision", what=fault.event, why=str(fault), response=NOTHING, move=robot.start)
        box.close()
        live.say(str(fault))
        raise


def _run(live_run: LiveRun) -> int:
    """Carry the programs out, and tell people how that ended; return the exit code."""
    try:
        for robot, why in over_by(live_run.program, live_run.resumed).items():
            say(
                f"{robot!r}: cannot be resumed: it has ended by {why}"
                if why
                else f"{robot!r}: it has come to its end"
            )
        ending = run_live(live_run)
    except NotReadyError as error:
        for robot, found in error.faults.items():
            say(f"{robot!r}: does not get ready: {found.reason or found.which}")
        return LINK if any(found.which == LINK_LOST for found in error.faults.values()) else FAILED
    except Incomplete as error:
        say(str(error))
        return LINK
    except FaultError as fault:
        return LINK if fault.event == LINK_LOST else FAILED
    except ValueError as error:
        say(f"--resume: {error}")
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED
    _tell(ending, tuple(live_run.connect))
    return exit_code(ending)


def _tell(ending: Ending, robots: Sequence[str]) -> None:
    """Print the outcome of each robot."""
    for robot in robots:
        fault, why = ending.faults.get(robot), ""
        if robot in ending.suspended:
            why = f"; {ending.came_down.get(robot, 'has not gone on')}; --resume continues where it stopped"
        elif robot in ending.unconfirmed:
            why = "; it has not confirmed that it stopped"
        if fault is not None or why:
            say(f"{robot!r}: ended early{f': {fault}' if fault is not None else ''}{why}")
        elif not any(waiting.robot == robot for waiting in ending.waiting):
            say(f"{robot!r}: done")
    for waiting in ending.waiting:
        say(str(waiting))


def _telling(writer: LogWriter, robots: Sequence[Robot]) -> Callable[[StepRecord], None]:
    """Return what keeps steps, and tells people of every move that begins."""
    steps = {(robot.id, step.move): step for robot in robots for step in robot.steps}

    def observe(record: StepRecord) -> None:
        writer.write(record)
        if record.label == "begin":
            step = steps[record.robot, record.move]
            serves = f" for task {step.task!r}" if step.task else ""
            say(f"{record.robot!r}: {step.move!r} ({type(step.movement).__name__}){serves}")

    return observe


def _log(parser: argparse.ArgumentParser, options: Options) -> LogWriter:
    try:
        return LogWriter(options.log, resumed=options.resume)
    except OSError as error:
        parser.error(f"--log {options.log}: {error.strerror or error}")


def _resumed(robots: Sequence[Robot], options: Options) -> tuple[StepRecord, ...]:
    if not options.resume:
        return ()
    return tuple(chain.from_iterable(read(options.log / robot.log) for robot in robots))


def _slots(
    parser: argparse.ArgumentParser,
    program: Program,
    robots: Sequence[Robot],
    options: Options,
    rehearsal: Rehearsal,
    resumed: tuple[StepRecord, ...],
    stack: ExitStack,
) -> ProgramBus | LocalSlots:
    if not options.bus.used:
        if strangers := strangers_of(program, [robot.id for robot in robots]):
            parser.error(
                f"needs {', '.join(map(ascii, strangers))}: run fleet.py, or every program with --bus"
            )
        slots = LocalSlots(program)
        restore(slots, program, resumed)
        return slots
    from ..bus.carriers.over_zenoh import ZenohCarrier
    from ..bus.carriers.sessions import Endpoints

    ids = [robot.id for robot in robots]
    reached = Endpoints(options.bus.listen, options.bus.connect, options.bus.file)
    team = sorted(program.by_id)
    zenoh = ZenohCarrier(program.name, options.run, team, reached, plan=program.fingerprint)
    carrier = rehearsal.wrap_carrier(zenoh, ids)
    try:
        bus = shared_bus(program, ids, options.run, options.log, carrier, resumed if options.resume else None)
    except OSError as error:
        parser.error(reason_of(error))
    except ValueError as error:
        parser.error(f"--log {options.log}: {error}")
    stack.callback(bus.close)
    return bus


def _hear(
    parser: argparse.ArgumentParser,
    options: Options,
    robots: Sequence[str],
    live_run: LiveRun,
    stack: ExitStack,
) -> None:
    """Connect the run to orders from other processes."""
    try:
        status = live_run.status_board.status
        stack.callback(Control(options.log, options.run, robots, live_run.orders, status).close)
    except Taken as error:
        parser.error(f"--log {options.log}: {error}")
    except OSError as error:
        say(f"{options.log}: no orders can be given while this runs: {error.strerror or error}")


ELSEWHERE = "elsewhere"
"""The one move that is known of a robot that another process runs."""


def program_of(robots: Sequence[Robot]) -> runtime.Program:
    """Return the program of these robots, with those of other processes as far as they are known."""
    own = {robot.id: robot.executable for robot in robots}
    names = [*own, *_strangers(robots)]
    notifies: dict[str, list[Notify]] = {name: [] for name in names}
    slots: dict[str, list[str]] = {name: [] for name in names}
    for robot in robots:
        for reported, active in ((robot.senders, True), (robot.resets, False)):
            for sender, slot in _senders(robot.id, reported):
                notifies[sender].append(Notify((slot,), active))
        for owner, name in robot.volatile:
            notifies[owner].append(Notify(((owner, name),), active=False))
        for notify in robot.executable.notifies:
            for owner, name in notify.slots:
                slots[owner].append(name)
    return runtime.Program(
        tuple(own.get(name) or _stranger(name, notifies[name], slots[name]) for name in names),
        name=robots[0].mission,
        fingerprint=robots[0].plan,
    )


def _strangers(robots: Sequence[Robot]) -> list[str]:
    here = {robot.id for robot in robots}
    return sorted({each for robot in robots for each in (*robot.fleet, *_contacts(robot))} - here)


def _contacts(robot: Robot) -> set[str]:
    reported = {sender for side in (robot.senders, robot.resets) for sender, _ in _senders(robot.id, side)}
    return reported | {owner for notify in robot.executable.notifies for owner, _ in notify.slots}


def _senders(owner: str, side: Iterable[tuple[str, tuple[str, ...]]]) -> Iterable[tuple[str, SlotId]]:
    return ((sender, (owner, name)) for name, senders in side for sender in senders)


def _stranger(name: str, notifies: Sequence[Notify], slots: Sequence[str]) -> runtime.ExecutableRobot:
    move = Move(ELSEWHERE, before=tuple(notifies))
    return runtime.ExecutableRobot(name, (move,), ELSEWHERE, tuple(dict.fromkeys(slots)))
