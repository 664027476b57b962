"""Runs one robot's program, or those of several robots, from the command line."""

from __future__ import annotations

import argparse
import signal
import threading
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from queue import SimpleQueue
from typing import TYPE_CHECKING

from mmrs_runtime.bus import Recorded
from mmrs_runtime.control import Control, Taken
from mmrs_runtime.injection import Rehearsal
from mmrs_runtime.records.log import read
from mmrs_runtime.screen import bear_all_characters, say, unfailing

from .crews import Crews
from .judgement import Condition, Judgement, conditions_of
from .objects import Locator
from .options import Options, options_of, parser_for
from .program import Robot
from .session import Shared, Vehicles, run_robot
from .slots import BusSlots, LocalSlots, recorded_of, shared_slots, strangers_of, team_of
from .steps.ending import FAILED, INTERRUPTED, LINK, OK
from .steps.resuming import slots_of

if TYPE_CHECKING:
    from mmrs_runtime.ports import Port

    from .links.radios import Radios


def main(
    robots: Sequence[Robot],
    conditions: Mapping[str, Condition] | None = None,
    locators: Mapping[str, Locator] | None = None,
    arguments: Sequence[str] | None = None,
    *,
    vehicles: Vehicles | None = None,
) -> int:
    """Run the programs of robots, each in a thread of its own, and return the exit code.

    Args:
        robots: at least one.
        conditions: what decides Choices, by identifier.
        locators: what finds objects, by description.
        arguments: as on the command line; None: those of this process.
        vehicles: what makes vehicles that are reached otherwise than by MAVLink.
    """
    bear_all_characters()
    parser = parser_for(robots)
    options = options_of(parser, robots, arguments)
    judgement = Judgement(conditions or {}, locators or {})
    for fault in judgement.faults(robots):
        parser.error(fault)
    with ExitStack() as stack:
        stack.enter_context(unfailing())
        stop, abandon = threading.Event(), threading.Event()
        rehearsal = Rehearsal(options.inject, options.clock, say)
        shared = Shared(
            options=options,
            slots=_slots(parser, robots, options, rehearsal, stack),
            judgement=judgement,
            decides=judgement.decides(robots),
            rehearsal=rehearsal,
            radios=None if vehicles is not None or options.dry else _radios(options, rehearsal),
            crews=(
                crews := Crews(
                    [robot.id for robot in robots], {robot.id: conditions_of([robot]) for robot in robots}
                )
            ),
            stop=stop,
            abandon=abandon,
            vehicles=vehicles,
        )
        stack.callback(rehearsal.close)
        rehearsal.start()
        _open_control(parser, options, crews, stack)
        _stop_on_signals(stop, abandon)
        codes = _run_all(robots, shared)
    return next((code for code in (LINK, INTERRUPTED, FAILED) if code in codes), OK)


def _run_all(robots: Sequence[Robot], shared: Shared) -> list[int]:
    codes = [FAILED] * len(robots)

    def run(index: int) -> None:
        codes[index] = run_robot(robots[index], shared)

    threads = [
        threading.Thread(target=run, args=(index,), name=f"robot {index}") for index in range(len(robots))
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        while thread.is_alive():
            thread.join(0.2)
    return codes


def _slots(
    parser: argparse.ArgumentParser,
    robots: Sequence[Robot],
    options: Options,
    rehearsal: Rehearsal,
    stack: ExitStack,
) -> BusSlots:
    if options.bus.used:
        from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
        from mmrs_runtime.bus.carriers.sessions import Endpoints

        reached = Endpoints(options.bus.listen, options.bus.connect, options.bus.file)
        zenoh = ZenohCarrier(robots[0].mission, options.run, team_of(robots), reached, plan=robots[0].plan)
        carrier = rehearsal.wrap_carrier(zenoh, [robot.id for robot in robots])
        try:
            bus = shared_slots(robots, options.run, options.log, carrier, _recorded(robots, options))
        except OSError as error:
            parser.error(f"{error.filename}: {error.strerror}" if error.filename else str(error))
        except ValueError as error:
            parser.error(f"--log {options.log}: {error}")
        stack.callback(bus.close)
        return bus
    if strangers := strangers_of(robots):
        parser.error(f"needs {', '.join(map(ascii, strangers))}: run fleet.py, or every program with --bus")
    slots = LocalSlots(robots, options.run)
    if options.resume:
        slots.restore(*slots_of(robots, [step for robot in robots for step in read(options.log / robot.log)]))
    return slots


def _recorded(robots: Sequence[Robot], options: Options) -> dict[str, Recorded]:
    """Return what the logs say of robots that are started again."""
    if not options.resume:
        return {}
    return {robot.id: recorded_of(robot, read(options.log / robot.log)) for robot in robots}


def _radios(options: Options, rehearsal: Rehearsal) -> Radios:
    from .links.radios import Radios  # MAVLink's library need not be there where no robot speaks it

    reach = options.reach

    def wrap(port: Port, url: str) -> Port:
        return rehearsal.wrap(port, reach.sharers(url))

    return Radios(options.clock, reach.signer, reach.retries, wrap)


def _open_control(parser: argparse.ArgumentParser, options: Options, crews: Crews, stack: ExitStack) -> None:
    try:
        control = Control(options.log, options.run, crews.inboxes, crews.status)
    except Taken as error:
        parser.error(f"--log {options.log}: {error}")
    except OSError as error:
        say(f"{options.log}: no orders can be given while this runs: {error.strerror or error}")
        return
    stack.callback(control.close)


def _stop_on_signals(stop: threading.Event, abandon: threading.Event) -> None:
    """Have the first signal set one event, the second the other.

    A thread sets them: a signal that comes while the first is heeded would wait for an event's lock for ever.
    """
    told: SimpleQueue[int] = SimpleQueue()

    def heed() -> None:
        for event in (stop, abandon):
            told.get()
            event.set()

    if threading.current_thread() is threading.main_thread():
        threading.Thread(target=heed, name="signals", daemon=True).start()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda number, _frame: told.put(number))
        if hasattr(signal, "SIGHUP"):
            # A terminal that closes gives no order: robots fly on.
            signal.signal(signal.SIGHUP, signal.SIG_IGN)
