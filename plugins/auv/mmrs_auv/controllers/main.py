"""Runs programs of robots whose vehicles are on CAN buses, from the command line."""

from __future__ import annotations

import argparse
import logging
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

from mmrs_auv.controllers.vehicle import CanVehicle
from mmrs_auv.vessel.api import Connection
from mmrs_auv.vessel.sheet import from_json
from mmrs_auv.vessel.wire.ports import CHANNEL, open_port
from mmrs_core.flight.conditions import Condition
from mmrs_core.flight.faults import LINK_LOST, Fault
from mmrs_core.flight.main import main as run
from mmrs_core.flight.objects import Locator
from mmrs_core.flight.options import Options
from mmrs_core.flight.program import Robot
from mmrs_core.flight.records.blackbox import BlackBox

FAREWELL = 0.5
"""Real seconds in which the last goal is still repeated."""


def main(
    robots: Sequence[Robot],
    sheets: Mapping[str, Path],
    conditions: Mapping[str, Condition] | None = None,
    locators: Mapping[str, Locator] | None = None,
    arguments: Sequence[str] | None = None,
) -> int:
    """Run the programs of robots; return the exit code.

    Args:
        robots: at least one.
        sheets: files of the vehicles' data, by robot.
        conditions: what decides Choices, by identifier.
        locators: what finds objects, by description.
        arguments: as on the command line; None: those of this process.
    """
    logging.getLogger("can").setLevel(logging.ERROR)
    parser = _parser()
    words = sys.argv[1:] if arguments is None else list(arguments)
    if "-h" in words or "--help" in words:
        print(parser.format_help())
    given, rest = parser.parse_known_args(words)
    channels = _channels(parser, [robot.id for robot in robots], given.can)
    with ExitStack() as stack:

        def vehicle(robot: Robot, options: Options, guard: Callable[[], None], box: BlackBox) -> CanVehicle:
            sheet = from_json(sheets[robot.id].read_text(encoding="utf-8"))
            channel = channels[robot.id]
            try:
                port = open_port(given.interface, channel, bit_rate=given.bit_rate)
            except (OSError, ValueError) as error:
                raise Fault(LINK_LOST, f"{channel}: {error}") from error
            paced = given.clock or ("bus" if options.clock.speedup != 1.0 else "real")
            connection = Connection(sheet, port, "bus" if paced == "bus" else "real")

            def let_go() -> None:
                time.sleep(FAREWELL)
                connection.close()
                port.close()

            stack.callback(let_go)
            patience = options.reach.patience
            return CanVehicle(robot, sheet, connection.craft, options.clock, guard, box, patience=patience)

        return run(robots, conditions, locators, rest, vehicles=vehicle)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(add_help=False, usage="the vehicles' buses, beside the options below:")
    add = parser.add_argument
    add("--can", action="append", default=[], metavar="[ROBOT=]CHANNEL", help="such as can0@127.0.0.1:29600")
    add("--interface", default="socketcand", help="of python-can")
    add("--bit-rate", type=int, help="for adapters that have to be told")
    add("--clock", choices=("real", "bus"), help="bus: time as a simulated vehicle tells it")
    return parser


def _channels(
    parser: argparse.ArgumentParser, robots: Sequence[str], texts: Sequence[str]
) -> Mapping[str, str]:
    found = dict.fromkeys(robots, CHANNEL)
    for text in texts:
        robot, sign, channel = text.rpartition("=")
        if sign and robot not in found:
            parser.error(f"--can {text}: there is no robot {robot!r}")
        if not sign and len(robots) > 1:
            parser.error(f"--can {text}: which robot? say ROBOT={text}")
        found[robot or robots[0]] = channel
    return found
