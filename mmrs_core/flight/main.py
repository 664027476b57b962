"""Runs one robot's program, or those of several robots, from the command line."""

from __future__ import annotations

import argparse
import signal
import threading
from collections.abc import Mapping, Sequence
from contextlib import ExitStack

from .conditions import Condition
from .judgement import Judgement
from .objects import Locator
from .options import Options, options_of, parser_for
from .program import Robot
from .radios import Radios
from .session import FAILED, INTERRUPTED, LINK, OK, Shared, run_robot
from .slots import LocalSlots, Slots, shared_slots, strangers_of


def main(
    robots: Sequence[Robot],
    conditions: Mapping[str, Condition] | None = None,
    locators: Mapping[str, Locator] | None = None,
    arguments: Sequence[str] | None = None,
) -> int:
    """Run the programs of robots, each in a thread of its own, and return the exit code.

    Args:
        robots: at least one.
        conditions: what decides Choices, by identifier.
        locators: what finds objects, by description.
        arguments: as on the command line; None: those of this process.
    """
    parser = parser_for(robots)
    options = options_of(parser, robots, arguments)
    judgement = Judgement(conditions or {}, locators or {})
    for fault in judgement.faults(robots):
        parser.error(fault)
    with ExitStack() as stack:
        slots = _slots(parser, robots, options, stack)
        stop = threading.Event()
        _stop_on_signals(stop)
        radios = Radios(options.clock, options.reach.signer, options.reach.retries)
        codes = _run_all(robots, Shared(options, slots, judgement, radios, stop))
    return next((code for code in (INTERRUPTED, LINK, FAILED) if code in codes), OK)


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
    parser: argparse.ArgumentParser, robots: Sequence[Robot], options: Options, stack: ExitStack
) -> Slots:
    if options.bus.used:
        from .bus.over_zenoh import Endpoints, ZenohCarrier

        fleet = {robot.id for robot in robots} | {*robots[0].fleet} | {*strangers_of(robots)}
        reached = Endpoints(options.bus.listen, options.bus.connect, options.bus.file)
        carrier = ZenohCarrier(robots[0].mission, options.run, sorted(fleet), reached)
        try:
            bus = shared_slots(robots, options.run, options.log, carrier)
        except OSError as error:
            parser.error(f"--log {options.log}: {error.strerror or error}")
        except ValueError as error:
            parser.error(f"--log {options.log}: {error}")
        stack.callback(bus.close)
        return bus
    if strangers := strangers_of(robots):
        parser.error(f"needs {', '.join(map(ascii, strangers))}: run fleet.py, or every program with --bus")
    return LocalSlots(robots, options.run)


def _stop_on_signals(stop: threading.Event) -> None:
    if threading.current_thread() is threading.main_thread():
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: stop.set())
