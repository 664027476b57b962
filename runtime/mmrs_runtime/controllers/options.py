"""The command line that all controllers share, as a parser and as what it was understood to say."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Any

from ..bus import PATIENCE
from ..engine.clocks import FollowingClock, RealClock
from ..faults import FaultError
from ..injection import HELP, Injections, injections
from ..injection.spec import OF_STATIONS, OF_VEHICLE
from ..records.blackbox import black_box_path, last_time, plan_of
from ..records.log import read
from .driver import Driver
from .vocabulary import Robot

DRY_SPEEDUP = 500.0
FIRST_RUN = "run-0"


@dataclass(frozen=True, slots=True)
class Bus:
    """Whether slots are kept with robots in other processes, and how these are reached.

    Attributes:
        listen, connect: endpoints. file: of Zenoh's configuration, with certificates; None: there is none.
    """

    used: bool
    listen: tuple[str, ...]
    connect: tuple[str, ...]
    file: Path | None = None


@dataclass(frozen=True, slots=True)
class Options:
    """Options for all robots.

    Attributes:
        log: folder for the logs.
        run: identifier of the run.
        resume: whether to resume where the logs end.
        dry: whether there are no vehicles.
        on_stop: ``hold``, ``return`` or ``land``.
        battery_patience: real seconds to wait for a changed battery when no other robot works.
        patience: real seconds to wait for a vehicle's first message.
        home_tolerance: metres that a vehicle may be from its home at first.
        sync: real seconds to wait for all robots, which then begin at one instant; None: no wait.
        inject: faults to inject.
    """

    log: Path
    run: str
    resume: bool
    clock: FollowingClock
    dry: bool
    on_stop: str
    battery_patience: float
    patience: float
    home_tolerance: float
    bus: Bus
    sync: float | None
    inject: Injections


def parser_for(robots: Sequence[Robot], driver: Driver) -> argparse.ArgumentParser:
    """Return the parser of the command line that runs these robots."""
    named = ", ".join(repr(robot.id) for robot in robots)
    parser = argparse.ArgumentParser(
        description=f"Run {named} on {'its vehicle' if len(robots) == 1 else 'their vehicles'}.",
        epilog="Exit codes: 0 completed, 1 ended early, 2 usage error, 5 link lost, 130 interrupted."
        " To send commands while it runs: python -m mmrs_runtime.control ORDER --log DIR.",
    )
    driver.add_options(parser)
    add = parser.add_argument
    add(
        "--patience",
        type=positive,
        default=30.0,
        metavar="SECONDS",
        help="timeout for a vehicle's first message, in real seconds. Default: 30",
    )
    add(
        "--log",
        type=Path,
        default=Path("logs"),
        metavar="DIR",
        help="folder for the logs, without logs of another run. Default: logs",
    )
    add("--run", metavar="NAME", help=f"run name, recorded in the logs. Default: {FIRST_RUN}")
    add("--resume", action="store_true", help="resume the run logged in --log, e.g. after a battery change")
    add("--dry-run", action="store_true", help="execute the program without a vehicle, in fast motion")
    add(
        "--speedup",
        type=positive,
        default=None,
        metavar="FACTOR",
        help="time factor of simulated vehicles. Default: 1",
    )
    add(
        "--on-stop",
        choices=("hold", "return", "land"),
        default="hold",
        help="behaviour on interrupt. Default: hold",
    )
    add("--battery-patience", type=not_negative, default=0.0, metavar="SECONDS", help=_PATIENCE)
    add(
        "--home-tolerance",
        type=positive,
        default=20.0,
        metavar="METRES",
        help="maximum distance of a vehicle from its home at the start, in metres. Default: 20",
    )
    add("--inject", action="append", default=[], metavar="FAULTS", help=HELP)
    add("--sync", action="store_true", help="start at one instant, once all robots of the mission are ready")
    add("--sync-patience", type=positive, default=PATIENCE, metavar="SECONDS", help=_SYNC_PATIENCE)
    add("--bus", action="store_true", help=_BUS)
    add(
        "--bus-listen",
        action="append",
        default=[],
        metavar="ENDPOINT",
        help="Zenoh endpoint to listen on, e.g. tcp/0.0.0.0:7447. Repeatable",
    )
    add(
        "--bus-connect",
        action="append",
        default=[],
        metavar="ENDPOINT",
        help="Zenoh endpoint to connect to, e.g. tcp/10.0.0.2:7447. Repeatable",
    )
    add("--bus-config", type=Path, metavar="FILE", help="Zenoh configuration from 'mmrs bus keys'")
    return parser


def options_of(
    parser: argparse.ArgumentParser, robots: Sequence[Robot], driver: Driver, arguments: Sequence[str] | None
) -> Options:
    """Return what a command line says; the driver keeps its part. Exits with a usage error where it is none.

    Args:
        parser: for the same robots and driver.
        robots: to run.
        driver: of their vehicles.
        arguments: as on the command line; None: those of this process.
    """
    given = parser.parse_args(arguments)
    run, start = _run(parser, robots, given)
    speedup = given.speedup or (DRY_SPEEDUP if given.dry_run else 1.0)
    links = driver.settle(parser, robots, given)
    return Options(
        log=given.log,
        run=run,
        resume=given.resume,
        clock=FollowingClock(RealClock(speedup, start)),
        dry=given.dry_run,
        on_stop=given.on_stop,
        battery_patience=given.battery_patience,
        patience=given.patience,
        home_tolerance=given.home_tolerance,
        bus=_bus(given),
        sync=given.sync_patience if given.sync else None,
        inject=_inject(parser, links, driver.rehearses, given),
    )


_SYNC_PATIENCE = f"start timeout for --sync, in real seconds; no robot starts after it. Default: {PATIENCE:g}"
_BUS = (
    "synchronise slots (the signals that robots wait for) with other processes over Zenoh; without"
    " endpoints: on this machine"
)
_PATIENCE = (
    "timeout for a battery change (command resume) once no other robot is active, in real seconds. Default: 0"
)


def positive(text: str) -> float:
    """Return a number above 0, which is not infinite either."""
    if not 0.0 < (number := _number(text)) < inf:
        raise argparse.ArgumentTypeError(f"{text}: must be a positive number")
    return number


def not_negative(text: str) -> float:
    """Return a number from 0 on."""
    if not (number := _number(text)) >= 0.0:
        raise argparse.ArgumentTypeError(f"{text}: must be a number of at least 0")
    return number


def count(text: str) -> int:
    """Return a whole number from 1 on."""
    if not text.isdecimal() or len(text) > 9 or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}: must be a whole number of at least 1")
    return int(text)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text}: must be a number") from None


def _boxes(robots: Sequence[Robot], folder: Path) -> list[Path]:
    return [black_box_path(folder / robot.log) for robot in robots]


def _run(parser: argparse.ArgumentParser, robots: Sequence[Robot], given: Any) -> tuple[str, float]:
    """Return the identifier of the run, and how many seconds of it have passed."""
    taken = [given.log / robot.log for robot in robots if (given.log / robot.log).exists()]
    if taken and not given.resume:
        parser.error(
            f"{taken[0]}: already contains a log; choose another --log, or resume that run with --resume"
        )
    # A run in which nothing began has black boxes, and no logs.
    if given.resume and not any(path.exists() for path in (*taken, *_boxes(robots, given.log))):
        parser.error(f"--resume: no log of these robots in {given.log}")
    try:
        steps = [step for path in taken for step in read(path)]
    except FaultError as fault:
        parser.error(f"--resume: {fault}")
    runs = sorted({step.run for step in steps})
    if len(runs) > 1 or (runs and given.run and runs != [given.run]):
        parser.error(f"--resume: the logs are of run {', '.join(map(repr, runs))}")
    for robot in robots:
        if plan_of(black_box_path(given.log / robot.log)) not in ("", robot.plan):
            parser.error(
                f"--resume: the logs of {robot.id!r} in {given.log} are from another plan of the mission"
            )
    ends = (last_time(black_box_path(path)) for path in taken)
    start = max((*(step.time for step in steps), *ends), default=0.0)
    return (runs[0] if runs else given.run or FIRST_RUN), start


def _inject(
    parser: argparse.ArgumentParser, links: Mapping[str, str], rehearses: Collection[str], given: Any
) -> Injections:
    try:
        alone = not (_bus(given).used or given.sync)
        found = injections(given.inject, links, dry=given.dry_run, alone=alone)
    except ValueError as error:
        parser.error(f"--inject {error}")
    for fault in found.faults:
        if fault.name in (*OF_VEHICLE, *OF_STATIONS) and fault.name not in rehearses:
            parser.error(f"--inject {fault.text}: not supported by these vehicles")
    return found


def _bus(given: Any) -> Bus:
    used = given.bus or given.bus_listen or given.bus_connect or given.bus_config
    return Bus(bool(used), tuple(given.bus_listen), tuple(given.bus_connect), given.bus_config)
