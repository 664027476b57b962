"""Runs programs of robots whose vehicles are on CAN buses, from the command line."""

from __future__ import annotations

import argparse
import logging
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from math import inf
from pathlib import Path

from auv_vessel.api import Connection
from auv_vessel.controllers.vehicle import CanVehicle
from auv_vessel.eyes import Detections
from auv_vessel.goals import FAREWELL
from auv_vessel.sheet import from_json
from auv_vessel.wire.ports import CHANNEL, open_port
from mmrs_mavlink.judgement import Condition, objects_of
from mmrs_mavlink.main import main as run
from mmrs_mavlink.objects import Locator, not_looked_for, where_expected
from mmrs_mavlink.options import Options
from mmrs_mavlink.program import Robot
from mmrs_runtime.faults import LINK_LOST, Fault
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.screen import say


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
    ids = [robot.id for robot in robots]
    channels = {**dict.fromkeys(ids, CHANNEL), **_by_robot(parser, "--can", ids, given.can)}
    ports = _ports(parser, ids, given.detections)
    with ExitStack() as stack:

        def vehicle(robot: Robot, options: Options, guard: Callable[[], None], box: BlackBox) -> CanVehicle:
            sheet = from_json(sheets[robot.id].read_text(encoding="utf-8"))
            channel = channels[robot.id]

            def tell(text: str) -> None:
                say(f"'{robot.id}': {text}")

            try:
                port = open_port(given.interface, channel, bit_rate=given.bit_rate, say=tell)
            except (OSError, ValueError) as error:
                raise Fault(LINK_LOST, f"{channel}: {error}") from error
            paced = given.clock or ("bus" if options.clock.speedup != 1.0 else "real")
            connection = Connection(sheet, port, "bus" if paced == "bus" else "real")

            def let_go() -> None:
                time.sleep(FAREWELL)
                connection.close()
                port.close()

            stack.callback(let_go)
            patience, eyes = options.reach.patience, _eyes(robot.id, ports.get(robot.id), stack)
            return CanVehicle(
                robot,
                sheet,
                connection.craft,
                options.clock,
                guard,
                box,
                patience=patience,
                eyes=eyes,
                clearance=given.clearance,
            )

        return run(robots, conditions, _locators(robots, ports, locators or {}), rest, vehicles=vehicle)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(add_help=False, usage="the vehicles' buses, beside the options below:")
    add = parser.add_argument
    add("--can", action="append", default=[], metavar="[ROBOT=]CHANNEL", help="such as can0@127.0.0.1:29600")
    add("--interface", default="socketcand", help="of python-can")
    add("--bit-rate", type=int, help="for adapters that have to be told")
    add(
        "--detections",
        action="append",
        default=[],
        metavar="[ROBOT=]PORT",
        help="UDP port on which cameras tell where objects are, whatever objects.py says",
    )
    add("--clearance", type=_metres, default=0.0, help="metres ahead within which sonar must see nothing")
    add("--clock", choices=("real", "bus"), help="bus: time as a simulated vehicle tells it")
    return parser


def _metres(text: str) -> float:
    found = float(text)
    if not 0.0 <= found < inf:
        raise ValueError(text)
    return found


def _by_robot(
    parser: argparse.ArgumentParser, option: str, robots: Sequence[str], texts: Sequence[str]
) -> dict[str, str]:
    found = {}
    for text in texts:
        robot, sign, value = text.rpartition("=")
        if sign and robot not in robots:
            parser.error(f"{option} {text}: there is no robot {robot!r}")
        if not sign and len(robots) > 1:
            parser.error(f"{option} {text}: which robot? say ROBOT={text}")
        found[robot or robots[0]] = value
    return found


def _ports(parser: argparse.ArgumentParser, robots: Sequence[str], texts: Sequence[str]) -> Mapping[str, int]:
    found = _by_robot(parser, "--detections", robots, texts)
    for text in found.values():
        if not (text.isascii() and text.isdecimal() and len(text) < 6 and 0 < int(text) < 65_536):
            parser.error(f"--detections {text}: is no port")
    if len(set(found.values())) < len(found):
        parser.error("--detections: each vehicle's cameras need a port of their own")
    return {robot: int(text) for robot, text in found.items()}


def _eyes(robot: str, port: int | None, stack: ExitStack) -> Detections | None:
    if port is None:
        return None
    try:
        return stack.enter_context(Detections(port=port, robot=robot))
    except OSError as error:
        raise Fault(LINK_LOST, f"--detections {port}: {error.strerror or error}") from error


def _locators(
    robots: Sequence[Robot], ports: Mapping[str, int], locators: Mapping[str, Locator]
) -> Mapping[str, Locator]:
    """Return what finds objects: nobody need say how those are found that only cameras look for."""
    blind = {
        description
        for robot in robots
        if robot.id not in ports
        for step in robot.steps
        for description in objects_of(step.movement)
    }
    return {
        description: where_expected if found is not_looked_for and description not in blind else found
        for description, found in locators.items()
    }
