"""``mmrs bus``: what robots on different machines need to keep their slots together."""

from __future__ import annotations

import json as json_format
import re
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from ipaddress import ip_address
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.behaviours import load_program
from mmrs_core.cli.bus_access import Holder
from mmrs_core.cli.buses import refuse_endpoints
from mmrs_core.cli.completion import robot_names
from mmrs_core.cli.output import answer, counted, say, say_json, tell, written
from mmrs_core.cli.parameters import Behaviour, behaviour_file
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.errors import LinkLostError, UnreadableError, UnsupportedError
from mmrs_runtime.bus.gateway.server import Gateway
from mmrs_runtime.bus.messages import digest
from mmrs_runtime.bus.program_bus import node_of
from mmrs_runtime.screen import unfailing

if TYPE_CHECKING:
    from types import FrameType

    from mmrs_runtime.bus import Node, Recorded

app = typer.Typer(rich_markup_mode=None, no_args_is_help=True, add_completion=False)

Listen = Annotated[
    list[str] | None,
    typer.Option(
        "--listen", metavar="ENDPOINT", help="Zenoh endpoint to listen on, e.g. tcp/0.0.0.0:7447. Repeatable."
    ),
]
Connect = Annotated[
    list[str] | None,
    typer.Option(
        "--connect",
        metavar="ENDPOINT",
        help="Zenoh endpoint to connect to, e.g. tcp/10.0.0.2:7447. Repeatable.",
    ),
]
Config = Annotated[
    Path | None, typer.Option("--config", metavar="FILE", help="Zenoh configuration from 'mmrs bus keys'.")
]
Run = Annotated[
    str, typer.Option("--run", metavar="NAME", help="Run name; the same in all processes of a run.")
]

_NAME = re.compile(r"(?!-)[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*")
_HOLDER = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")


@app.callback()
def bus() -> None:
    """Synchronise slots between machines.

    A slot is a named flag of a robot. Robots coordinate by slots: one robot waits until its slot is set,
    another robot sets it. Across machines, the bus (Zenoh) transmits slots; 'mmrs run --bus' joins it.
    """


@app.command("keys")
def keys(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder.")],
    robots: Annotated[
        list[str],
        typer.Option(
            "--robot",
            metavar="[NAME=]ROBOT[,ROBOT]",
            help="Robot, or several that one process runs, which then needs a NAME. Repeatable.",
        ),
    ],
    hosts: Annotated[
        list[str] | None,
        typer.Option(
            "--host",
            metavar="HOST",
            help="Host name or address at which robots are reached; give all. Default: this machine only. "
            "Repeatable.",
        ),
    ] = None,
    days: Annotated[
        int, typer.Option("--days", metavar="DAYS", min=1, max=36_500, help="Validity in days.")
    ] = 730,
    json: Json = False,
) -> int:
    """Create certificates and bus configurations.

    With a certificate, a robot can set and acknowledge only its own slots. Copy DIR/NAME to the machine of
    robot NAME and pass its bus.json5 to 'mmrs run' or the controller as --bus-config. DIR/observer is for
    monitoring. Keep DIR/authority.key.pem private. To add a robot, or to replace a revoked certificate or a
    missing folder, run the command again with all robots and copy the folders again; existing certificates
    are kept.

    Example: mmrs bus keys keys --robot Drone1 --robot Drone2 --host 10.0.0.1 --host 10.0.0.2
    """
    with _needing("cryptography"):
        from mmrs_core.cli.bus_certificates import make_keys
    holders = tuple(_holder(text) for text in robots)
    _refuse_doubles(holders)
    reached = [_host(text) for text in hosts or ("localhost", "127.0.0.1")]
    with _readable():
        made = make_keys(folder, holders, reached, datetime.now(UTC), days)
    answer({"folders": list(map(str, made))}, written(made), as_json=json)
    return 0


@app.command("revoke")
def revoke(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder of 'mmrs bus keys'.")],
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Robot or process whose certificate is revoked.")
    ],
    json: Json = False,
) -> int:
    """Revoke the certificate of a robot.

    Copy DIR/revoked.pem to every machine, next to its bus.json5. Running processes read it within seconds and
    then refuse the old certificate. 'mmrs bus keys' creates a new one.

    Example: mmrs bus revoke keys Drone1
    """
    with _needing("cryptography"):
        from mmrs_core.cli import bus_certificates
    with _readable():
        lists = bus_certificates.revoke(folder, name, datetime.now(UTC))
    answer({"revoked": name, "lists": list(map(str, lists))}, written(lists), as_json=json)
    return 0


@app.command("gateway")
def gateway(
    call: typer.Context,
    behaviour: Behaviour,
    robot: Annotated[
        str,
        typer.Option(
            "--robot", metavar="ROBOT", help="Robot that the program controls.", autocompletion=robot_names
        ),
    ],
    listen: Listen = None,
    connect: Connect = None,
    config: Config = None,
    port: Annotated[
        int,
        typer.Option(
            "--port",
            metavar="PORT",
            min=0,
            max=65_535,
            help="TCP port on 127.0.0.1 for the program; 0 picks a free port.",
        ),
    ] = 0,
    run: Run = "run-0",
    log: Annotated[
        Path,
        typer.Option("--log", metavar="DIR", help="Folder for gateway.json and the record of slot changes."),
    ] = Path("logs"),
) -> int:
    """Connect a program without Zenoh as one robot.

    The program, in any language, exchanges JSON lines over TCP; it reads port and token from
    gateway.json in the folder of --log. docs/how-to/bus.md shows what they say. If the program or the gateway
    ends early, the other robots report the robot as lost. Runs until interrupted.

    Example: mmrs bus gateway survey/behaviour.xmi --robot Auv1 --connect tcp/10.0.0.2:7447
    """
    with _needing("eclipse-zenoh"):
        from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
        from mmrs_runtime.bus.carriers.sessions import Endpoints
    program = load_program(Session(settings_of(call)), behaviour_file(behaviour))
    names = [each.id for each in program.robots]
    if robot not in names:
        raise typer.BadParameter(f"--robot {robot}: unknown robot; the behaviour has {', '.join(names)}")
    _refuse_endpoints(listen, connect)
    endpoints = Endpoints(tuple(listen or ()), tuple(connect or ()), config)

    def enter(recorded: Recorded | None) -> Node:
        carrier = ZenohCarrier(program.name, run, names, endpoints, plan=program.fingerprint)
        given = None if recorded is None else {robot: recorded}
        return node_of(program.shared, [robot], run, log, carrier, given)

    try:
        log.mkdir(parents=True, exist_ok=True)
        found = Gateway(robot, run, enter, log, port)
    except OSError as error:
        raise LinkLostError(f"gateway: {error.strerror or error}") from error
    with unfailing():
        tell(f"gateway of '{robot}' at 127.0.0.1:{found.port}; its token stands in {log / 'gateway.json'}")
        _until_interrupted(found)
    return 0


@app.command("state")
def state(
    mission: Annotated[
        str, typer.Argument(metavar="MISSION", help="Name of the mission: the attribute 'name' of its model.")
    ],
    listen: Listen = None,
    connect: Connect = None,
    config: Config = None,
    run: Run = "run-0",
    robots: Annotated[
        list[str] | None,
        typer.Option("--robot", metavar="ROBOT", help="Robot that must answer. Default: any. Repeatable."),
    ] = None,
    seconds: Annotated[
        float, typer.Option("--seconds", metavar="SECONDS", min=0.1, help="Seconds to wait for answers.")
    ] = 2.0,
    json: Json = False,
) -> int:
    """Show the slots of all reachable robots.

    Exit codes: 0 all robots named by --robot, or at least one robot, have answered, 5 otherwise.

    Example: mmrs bus state survey --connect tcp/10.0.0.2:7447 --robot Drone1
    """
    with _needing("eclipse-zenoh"):
        from mmrs_runtime.bus.carriers.queries import reasons, states_of
        from mmrs_runtime.bus.carriers.sessions import Endpoints
    _refuse_endpoints(listen, connect)
    endpoints = Endpoints(tuple(listen or ()), tuple(connect or ()), config)
    try:
        answers = states_of(mission, run, endpoints, seconds, robots or ())
    except OSError as error:
        raise LinkLostError(str(error)) from error
    known = dict(sorted(_said(key, text) for key, text in answers.items()))
    shown = {name: slots for name, slots in known.items() if not robots or name in robots}
    missing = [name for name in robots or () if name not in shown]
    if json:
        say_json({"slots": shown, "missing": missing})
    else:
        _say_states(shown, missing)
        if not shown and not missing:
            tell(
                f"no robot answered for mission {mission!r}, run {run!r}; check --connect, --config and --run"
            )
        for why in reasons(endpoints) if missing or not shown else ():
            tell(why)
    return LinkLostError.exit_code if missing or not shown else 0


def _said(key: str, text: str) -> tuple[str, dict[str, dict[str, object]]]:
    """Return the robot that a key belongs to, and the state of its slots, by an answer.

    An answer with the name of another robot is identified by the key alone, which certificates protect;
    any other answer shows no slots.
    """
    found = _object_in(text)
    name = found.get("robot")
    slots = found.get("slots")
    states = {
        slot: each
        for slot, each in (slots.items() if isinstance(slots, dict) else ())
        if isinstance(each, dict) and {*each} >= _SHOWN
    }
    return name if isinstance(name, str) and digest(name) == key else key, states


def _object_in(text: str) -> dict[str, object]:
    try:
        found = json_format.loads(text)
    except (ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


_SHOWN = {"active", "writer"}


@contextmanager
def _needing(distribution: str) -> Iterator[None]:
    """Name the package to install where an import here is missing."""
    try:
        yield
    except ModuleNotFoundError as error:
        raise UnsupportedError(f"bus: needs {distribution}; pip install 'mmrs-core[bus]'") from error


@contextmanager
def _readable() -> Iterator[None]:
    """Report what is wrong with a folder of keys."""
    try:
        yield
    except OSError as error:
        raise UnreadableError(f"{error.filename}: {error.strerror}") from error
    except ValueError as error:
        raise UnreadableError(str(error)) from error


def _holder(text: str) -> Holder:
    name, separator, robots = text.partition("=")
    if name in ("observer", "authority"):
        raise typer.BadParameter(f"--robot {text}: there is a folder of that name anyway; say NAME=ROBOT")
    if not _HOLDER.fullmatch(name):
        raise typer.BadParameter(
            f"--robot {text}: a folder is named so: letters, digits, . _ - only; say NAME=ROBOT for others"
        )
    return Holder(name, tuple(robots.split(",")) if separator else (name,))


def _host(text: str) -> str:
    """Return a name, or an address, also where it is written as in an endpoint: ``[fd00::1]``."""
    host = text[1:-1] if text.startswith("[") and text.endswith("]") else text
    try:
        return str(ip_address(host))
    except ValueError as error:
        if _NAME.fullmatch(host):
            return host
        raise typer.BadParameter(f"--host {text}: no name, nor an address, such as 10.0.0.1") from error


def _refuse_doubles(holders: tuple[Holder, ...]) -> None:
    names = [holder.name for holder in holders]
    robots = [robot for holder in holders for robot in holder.robots]
    for given in (names, robots):
        for name in given:
            if given.count(name) > 1:
                raise typer.BadParameter(f"--robot {name}: given twice")


def _refuse_endpoints(listen: list[str] | None, connect: list[str] | None) -> None:
    refuse_endpoints("--listen", listen or ())
    refuse_endpoints("--connect", connect or ())


def _until_interrupted(found: Gateway) -> None:
    def stop(number: int, frame: FrameType | None) -> None:
        threading.Thread(target=found.close).start()

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, stop)
    found.serve(tell)


def _say_states(shown: dict[str, dict[str, dict[str, object]]], missing: list[str]) -> None:
    for robot, slots in shown.items():
        say(f"{robot!r}: {counted(len(slots), 'slot')}")
        for name, found in slots.items():
            word = "active" if found["active"] else "inactive"
            by = f", set by {found['writer']!r}" if found["writer"] else ""
            say(f"  {name}: {word}{by}")
    for robot in missing:
        tell(f"{robot!r}: no answer")
