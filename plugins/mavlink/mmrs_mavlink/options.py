"""The command line of vehicles that speak MAVLink: how they are reached, and the acceptance radius."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mmrs_runtime.controllers.options import count, positive
from mmrs_runtime.controllers.vocabulary import Robot

from .links.ports import address_of, split_system
from .links.retries import ANSWER_SECONDS, ITEM_SECONDS, TRIES, Retries

if TYPE_CHECKING:
    from .links.signing import Signer

FIRST_PORT = 14_550
PORT_STEP = 10
SWITCHES = {"yes": True, "no": False}


@dataclass(frozen=True, slots=True)
class Reach:
    """How vehicles are reached.

    Attributes:
        urls: of the links, by robot; robots with the same one share its port.
        systems: MAVLink systems of the vehicles, by robot; 0: whichever speaks first.
        retries: how often, and how long apart, to send what is not answered.
        signer: None: no signatures.
        acceptance: metres from a place that count as there; None: the robot's travel mode says it.
        fence: whether to upload it.
        device_check, battery_check: whether what is found wrong keeps a vehicle on the ground.
        tried: devices whose actions are carried out on the ground, before take-off.
    """

    urls: Mapping[str, str]
    systems: Mapping[str, int]
    retries: Retries
    signer: Signer | None
    acceptance: float | None
    fence: bool
    device_check: bool
    battery_check: bool
    tried: frozenset[str]

    def sharers(self, url: str) -> list[str]:
        """Return the robots that are reached by a url."""
        return [robot for robot, each in self.urls.items() if each == url]


def add_reach(parser: argparse.ArgumentParser) -> None:
    """Add the options of MAVLink to a command line."""
    add = parser.add_argument
    add(
        "--connect",
        action="append",
        default=[],
        metavar="[ROBOT=]URL[@SYSTEM]",
        help="connection URL of a robot: udpin:HOST:PORT, udpout:HOST:PORT, tcp:HOST:PORT or DEVICE,BAUD,"
        " with the vehicle's MAVLink system after @ (otherwise the first system received). Robots may"
        " share a URL."
        f" Repeatable. Default: udpin:127.0.0.1:{FIRST_PORT} for the first robot, and {PORT_STEP} ports"
        " higher for each further one",
    )
    add(
        "--tries",
        type=count,
        default=TRIES,
        metavar="N",
        help=f"how often to send a command that the vehicle does not answer. Default: {TRIES}",
    )
    add(
        "--answer-seconds",
        type=positive,
        default=ANSWER_SECONDS,
        metavar="SECONDS",
        help=f"timeout for each answer of a vehicle. Default: {ANSWER_SECONDS:g}",
    )
    add(
        "--item-seconds",
        type=positive,
        default=ITEM_SECONDS,
        metavar="SECONDS",
        help=f"timeout for each item of a mission transfer. Default: {ITEM_SECONDS:g}",
    )
    add(
        "--signing-key",
        type=Path,
        metavar="FILE",
        help="MAVLink 2 signing key file; unsigned messages are ignored",
    )
    add("--no-fence", action="store_true", help="do not upload the geofence")
    add(
        "--device-check",
        choices=tuple(SWITCHES),
        default="yes",
        help="no: take off although a device cannot do what the program asks of it. Default: yes",
    )
    add(
        "--battery-check",
        choices=tuple(SWITCHES),
        default="yes",
        help="no: take off although the battery does not suffice for the first sortie. Default: yes",
    )
    add(
        "--try-device",
        action="append",
        default=[],
        metavar="DEVICE",
        help="carry out the actions of a device on the ground, before take-off, to see whether it works."
        " Repeatable",
    )
    add(
        "--acceptance",
        type=positive,
        metavar="METRES",
        help="acceptance radius in metres. Default: by travel mode",
    )


def reach_of(parser: argparse.ArgumentParser, robots: Sequence[Robot], given: Any) -> Reach:
    """Return what a command line says; exits with a usage error where it makes no sense."""
    links, signer = _links(parser, robots, given.connect), _signer(parser, given.signing_key)
    return Reach(
        {robot: url for robot, (url, _) in links.items()},
        {robot: system for robot, (_, system) in links.items()},
        Retries(given.tries, given.answer_seconds, given.item_seconds),
        signer,
        given.acceptance,
        fence=not given.no_fence,
        device_check=SWITCHES[given.device_check],
        battery_check=SWITCHES[given.battery_check],
        tried=frozenset(given.try_device),
    )


def _links(
    parser: argparse.ArgumentParser, robots: Sequence[Robot], texts: Sequence[str]
) -> dict[str, tuple[str, int]]:
    links = {
        robot.id: (f"udpin:127.0.0.1:{FIRST_PORT + PORT_STEP * index}", 0)
        for index, robot in enumerate(robots)
    }
    given: dict[str, str] = {}
    fleet = dict.fromkeys([*links, *(each for robot in robots for each in robot.fleet)])
    for text in texts:
        robot, separator, reached = text.rpartition("=")
        if separator and robot not in fleet:
            parser.error(f"--connect {text}: unknown robot {robot!r}; the robots are {', '.join(fleet)}")
        if not separator and len(robots) > 1:
            parser.error(f"--connect {text}: several robots; name one: --connect {robots[0].id}={text}")
        name = robot or robots[0].id
        if name in given:
            parser.error(f"--connect {text}: {name!r} already has the connection {given[name]}")
        given[name] = reached
        if name in links:
            links[name] = _link(parser, reached)
    taken = [each for each in links.values() if each[1]]
    for url, system in taken:
        if taken.count((url, system)) > 1:
            parser.error(f"--connect {url}@{system}: used for two robots")
    return links


def _link(parser: argparse.ArgumentParser, text: str) -> tuple[str, int]:
    try:
        url, system = split_system(text)
        address_of(url)
    except ValueError as error:
        parser.error(f"--connect {error}")
    return url, system


def _signer(parser: argparse.ArgumentParser, path: Path | None) -> Signer | None:
    if path is None:
        return None
    from .links.signing import signer_for  # needs MAVLink's library

    try:
        return signer_for(path)
    except (OSError, ValueError) as error:
        parser.error(str(error))
