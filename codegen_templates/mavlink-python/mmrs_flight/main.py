"""Runs one robot's program, or those of several robots, from the command line."""

from __future__ import annotations

import argparse
import signal
import sys
import threading
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from traceback import format_exception
from typing import Any

from .ardupilot import MavlinkVehicle
from .clock import Clock
from .dry import DryVehicle
from .faults import CRASHED, LINK_LOST, STOPPED, Fault
from .link import TRIES, Link
from .log import Log, Records
from .objects import Locator
from .pilot import Condition, Desk, Pilot
from .ports import open_port
from .program import Choose, GoTo, Movement, Object, Robot, Turn
from .responses import policy_for, respond
from .signing import signing_key
from .slots import LocalSlots, Slots
from .vehicle import Vehicle
from .watch import Watch

OK, FAILED, LINK, INTERRUPTED = 0, 1, 5, 130
CODES = {STOPPED: INTERRUPTED, LINK_LOST: LINK}
FIRST_PORT = 14_550
PORT_STEP = 10
DRY_SPEEDUP = 500.0

_print_lock = threading.Lock()


def say(line: str) -> None:
    """Tell people something, one line at a time."""
    with _print_lock:
        print(line, file=sys.stderr, flush=True)


@dataclass(frozen=True, slots=True)
class Options:
    """What was asked for on the command line, for all robots."""

    links: Mapping[str, str]
    log: Path
    run: str
    clock: Clock
    dry: bool
    on_stop: str
    fence: bool
    acceptance: float
    home_tolerance: float
    system: int
    patience: float
    tries: int
    key: bytes | None


@dataclass(frozen=True, slots=True)
class Judgement:
    """What only the user can say: when conditions hold, and where objects are."""

    conditions: Mapping[str, Condition]
    locators: Mapping[str, Locator]

    def faults(self, robots: Sequence[Robot]) -> list[str]:
        """Return what is missing for these robots."""
        choices = {s.then.condition for r in robots for s in r.steps if isinstance(s.then, Choose)}
        objects = {found for r in robots for s in r.steps for found in _objects(s.movement)}
        return [
            *(
                f"conditions.py decides nothing for {name!a}"
                for name in sorted(choices - set(self.conditions))
            ),
            *(f"objects.py finds nothing for {name!a}" for name in sorted(objects - set(self.locators))),
        ]


def _objects(movement: Movement) -> list[str]:
    look = movement.look if isinstance(movement, GoTo | Turn) else None
    targets = [look.at if look else None, movement.at if isinstance(movement, GoTo) else None]
    return [target.description for target in targets if isinstance(target, Object)]


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
    parser = _parser(robots)
    given = parser.parse_args(arguments)
    options = _options(parser, robots, given)
    judgement = Judgement(conditions or {}, locators or {})
    for fault in judgement.faults(robots):
        parser.error(fault)
    with ExitStack() as stack:
        slots = _slots(parser, robots, given, stack)
        stop = threading.Event()
        _stop_on_signals(stop)
        codes = _run_all(robots, options, slots, judgement, stop)
    return next((code for code in (INTERRUPTED, LINK, FAILED) if code in codes), OK)


def _run_all(
    robots: Sequence[Robot],
    options: Options,
    slots: Slots,
    judgement: Judgement,
    stop: threading.Event,
) -> list[int]:
    codes = [FAILED] * len(robots)

    def run(index: int) -> None:
        codes[index] = run_robot(robots[index], options, slots, judgement, stop)

    threads = [
        threading.Thread(target=run, args=(index,), name=f"robot {index}") for index in range(len(robots))
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        while thread.is_alive():
            thread.join(0.2)
    return codes


def run_robot(
    robot: Robot,
    options: Options,
    slots: Slots,
    judgement: Judgement,
    stop: threading.Event,
) -> int:
    """Run one robot's program to its end, or to the end that its policies say; return the exit code."""
    try:
        with ExitStack() as stack:
            stack.callback(slots.leave, robot.id)
            log = Log(options.log / robot.log, options.run, robot.id)
            stack.callback(log.close)
            records = Records(options.log / f"{Path(robot.log).stem}.records.ndjson")
            desk = Desk(
                options.clock, slots, log, records, judgement.conditions, judgement.locators, stop, say
            )
            vehicle, watch = _vehicle(robot, options, stop, stack)
            return _fly(robot, vehicle, watch, desk, options)
    except (OSError, ValueError) as error:
        say(f"{robot.id!a}: {error}")
        return LINK
    except Fault as fault:
        say(f"{robot.id!a}: {fault}")
        return CODES.get(fault.event, FAILED)


def _fly(robot: Robot, vehicle: Vehicle, watch: Watch, desk: Desk, options: Options) -> int:
    pilot = Pilot(robot, vehicle, desk)
    watch.current = lambda: pilot.policies
    try:
        pilot.fly(options.fence)
    except Fault as fault:
        return _end_early(fault, pilot, robot, vehicle, watch, desk, options)
    except Exception as error:
        say("".join(format_exception(error)))
        crash = Fault(CRASHED, f"the program itself fails: {error!r}")
        return _end_early(crash, pilot, robot, vehicle, watch, desk, options)
    say(f"{robot.id!a}: done")
    return OK


def _end_early(
    fault: Fault,
    pilot: Pilot,
    robot: Robot,
    vehicle: Vehicle,
    watch: Watch,
    desk: Desk,
    options: Options,
) -> int:
    response = policy_for(fault.event, robot, pilot.policies).response
    if fault.event == STOPPED:
        response = options.on_stop.upper()
    say(f"{robot.id!a}: {fault.event}: {fault}; response: {response}")
    watch.relax()
    try:
        pilot.fail(fault.event)
    except OSError as error:
        say(f"{robot.id!a}: the log cannot be written: {error}")
    desk.slots.leave(robot.id)
    try:
        watched = respond(response, fault, robot, vehicle, pilot.track)
    except Fault as error:
        say(f"{robot.id!a}: cannot carry out {response}: {error}; take over by hand")
        return CODES.get(error.event, FAILED)
    if watched:
        say(f"{robot.id!a}: holds; interrupt to end")
        desk.stop.wait()
    say(f"{robot.id!a}: stopped" if fault.event == STOPPED else f"{robot.id!a}: ended early")
    return CODES.get(fault.event, FAILED)


def _vehicle(
    robot: Robot, options: Options, stop: threading.Event, stack: ExitStack
) -> tuple[Vehicle, Watch]:
    watch = Watch(robot, options.clock, stop)
    if options.dry:
        return DryVehicle(options.clock, robot.home, watch.check), watch
    link = Link(open_port(options.links[robot.id]), options.clock, options.system, options.key)
    stack.callback(link.close)
    link.guard, link.tries = watch.check, options.tries
    say(f"{robot.id!a}: waits for a vehicle at {options.links[robot.id]}")
    if not link.wait(lambda: link.component, options.patience * options.clock.speedup):
        raise Fault(LINK_LOST, f"no vehicle at {options.links[robot.id]}")
    vehicle = MavlinkVehicle(
        link,
        robot.vehicle,
        robot.home,
        acceptance=options.acceptance,
        home_tolerance=options.home_tolerance,
    )
    watch.begin(link, vehicle)
    unset = vehicle.answer_lost_link(policy_for(LINK_LOST, robot).response)
    if unset:
        say(f"{robot.id!a}: response to a lost link: {unset}")
    return vehicle, watch


def _parser(robots: Sequence[Robot]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        description=f"Flies {', '.join(ascii(robot.id) for robot in robots)}.",
        epilog="Exit codes: 0 done, 1 ended early, 2 usage, 5 link lost, 130 stopped.",
    )
    add = parser.add_argument
    add(
        "--link",
        action="append",
        default=[],
        metavar="[ROBOT=]URL",
        help="udpin:HOST:PORT, udpout:HOST:PORT, tcp:HOST:PORT or DEVICE,BAUD;"
        f" default udpin:127.0.0.1:{FIRST_PORT} for the first robot, {PORT_STEP} more for each further one",
    )
    add("--log", type=Path, default=Path("logs"), help="folder for the logs; must not hold any yet")
    add("--run", default="run-0", help="identifier of this run, in the logs")
    add("--dry-run", action="store_true", help="no link: go through the program with a vehicle made up")
    add("--speedup", type=float, default=None, help="how much faster than real time the vehicles run")
    add("--on-stop", choices=("hold", "return", "land"), default="hold", help="what to do when interrupted")
    add("--no-fence", action="store_true", help="do not upload the fence")
    add("--acceptance", type=float, default=0.5, help="metres from a place that count as there")
    add("--home-tolerance", type=float, default=20.0, help="metres a vehicle may be from its home at first")
    add("--patience", type=float, default=30.0, help="real seconds to wait for a vehicle's first sign")
    add("--tries", type=int, default=TRIES, help="how often to send at most what a vehicle does not answer")
    add("--system", type=int, default=0, help="MAVLink system of the vehicle; 0: whichever speaks first")
    add("--signing-key", type=Path, metavar="FILE", help="sign what is sent, and hear only what is signed so")
    add("--bus", action="store_true", help="keep slots with robots in other processes, by Zenoh")
    add("--bus-listen", action="append", default=[], metavar="ENDPOINT", help="such as tcp/0.0.0.0:7447")
    add("--bus-connect", action="append", default=[], metavar="ENDPOINT", help="such as tcp/10.0.0.2:7447")
    return parser


def _options(parser: argparse.ArgumentParser, robots: Sequence[Robot], given: Any) -> Options:
    links = {robot.id: f"udpin:127.0.0.1:{FIRST_PORT + PORT_STEP * i}" for i, robot in enumerate(robots)}
    for link in given.link:
        robot, separator, url = link.rpartition("=")
        if separator and robot not in links:
            parser.error(f"--link {link}: there is no robot {robot!a}")
        if not separator and len(robots) > 1:
            parser.error(f"--link {link}: which robot? say ROBOT={link}")
        links[robot or robots[0].id] = url
    taken = [str(given.log / robot.log) for robot in robots if (given.log / robot.log).exists()]
    if taken:
        parser.error(f"{taken[0]}: there is a log already; choose another --log")
    speedup = given.speedup or (DRY_SPEEDUP if given.dry_run else 1.0)
    if speedup <= 0:
        parser.error("--speedup must be positive")
    if given.tries < 1:
        parser.error("--tries must be at least 1")
    return Options(
        links,
        given.log,
        given.run,
        Clock(speedup),
        given.dry_run,
        given.on_stop,
        not given.no_fence,
        given.acceptance,
        given.home_tolerance,
        given.system,
        given.patience,
        given.tries,
        _key(parser, given.signing_key),
    )


def _key(parser: argparse.ArgumentParser, path: Path | None) -> bytes | None:
    if path is None:
        return None
    try:
        return signing_key(path)
    except (OSError, ValueError) as error:
        parser.error(str(error))


def _slots(parser: argparse.ArgumentParser, robots: Sequence[Robot], given: Any, stack: ExitStack) -> Slots:
    if given.bus or given.bus_listen or given.bus_connect:
        from .bus import BusSlots

        bus = BusSlots(robots, given.run, given.log, given.bus_listen, given.bus_connect)
        stack.callback(bus.close)
        return bus
    here = {robot.id for robot in robots}
    strangers = sorted(
        {sender for robot in robots for _, senders in robot.senders for sender in senders} - here
    )
    if strangers:
        parser.error(
            f"waits for {', '.join(map(ascii, strangers))}: run fleet.py, or every program with --bus"
        )
    return LocalSlots()


def _stop_on_signals(stop: threading.Event) -> None:
    if threading.current_thread() is threading.main_thread():
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: stop.set())
