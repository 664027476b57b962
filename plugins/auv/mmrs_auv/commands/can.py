"""``mmrs can``: the CAN buses of vehicles."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TextIO

import typer

from mmrs_auv.commands.modelled import RobotName, Vehicle, sheet_in
from mmrs_core.cli.output import say, say_file, say_json, tell
from mmrs_core.cli.parameters import Duration
from mmrs_core.cli.settings import Json
from mmrs_core.errors import LinkLostError, UnreadableError
from mmrs_core.languages.writing import replace_file

if TYPE_CHECKING:
    from auv_vessel.wire.frame import Frame
    from auv_vessel.wire.ports import Port

_HELP = "Work with vehicle CAN buses."

app = typer.Typer(rich_markup_mode=None, help=_HELP, no_args_is_help=True, add_completion=False)

_COUNTED = ("frames", "lost", "corrupted", "overdue", "missed", "slowed", "wrong", "refused")

Interface = Annotated[
    str,
    typer.Option("--interface", metavar="NAME", help="python-can interface, e.g. socketcand or socketcan."),
]
Channel = Annotated[
    str,
    typer.Option(
        "--channel",
        metavar="NAME",
        help="Channel of the interface; NAME@HOST:PORT for a hub on another machine.",
    ),
]


@app.callback()
def can() -> None:
    """Leave the help to the application; without this, one command alone would lose its name."""


@app.command("dbc")
def dbc(
    vehicle: Vehicle,
    robot: RobotName = "",
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Output file. Default: standard output."),
    ] = None,
) -> int:
    """Export a vehicle's CAN database (DBC).

    Example: mmrs can dbc examples/pool --robot Naiad -o auv.dbc
    """
    from auv_vessel.wire.database import dbc_of

    text = dbc_of(sheet_in(vehicle, robot))
    if output is None:
        say_file(text.encode("ascii"))
        return 0
    try:
        replace_file(output, text.encode("ascii"))
    except OSError as error:
        raise UnreadableError(f"{output}: {error.strerror}") from error
    say(f"written: {output}")
    return 0


@app.command("hub")
def hub(
    host: Annotated[
        str, typer.Option("--host", metavar="HOST", help="Address to listen on. The bus is unauthenticated.")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option("--port", metavar="PORT", min=0, max=65_535, help="TCP port; 0 picks a free port.")
    ] = 29536,
    loss: Annotated[
        float,
        typer.Option("--loss", metavar="FRACTION", min=0.0, max=1.0, help="Fraction of frames to drop."),
    ] = 0.0,
    delay: Annotated[
        float, typer.Option("--delay", metavar="SECONDS", min=0.0, max=60.0, help="Frame latency in seconds.")
    ] = 0.0,
    corruption: Annotated[
        float,
        typer.Option(
            "--corruption",
            "--corrupt",
            metavar="FRACTION",
            min=0.0,
            max=1.0,
            help="Fraction of frames in which to flip one to three data bits.",
        ),
    ] = 0.0,
    seed: Annotated[int, typer.Option("--seed", metavar="N", help="Random seed.")] = 0,
    log: Annotated[
        Path | None, typer.Option("--log", metavar="FILE", help="Log all frames to FILE in candump format.")
    ] = None,
    simulated: Annotated[
        bool, typer.Option("--simulated-time", help="Exempt frames that carry simulated time from faults.")
    ] = False,
    seconds: Duration = 0.0,
) -> int:
    """Run a virtual CAN bus on this machine.

    Forwards each frame to all other processes on the same channel, in order, over the socketcand protocol. It
    has no arbitration, bit rate, acknowledgement, error frames or bus-off. Type 'loss 0.2', 'delay 0.05',
    'corruption 0.1' or 'cut' to inject faults, 'clear' to clear them, 'quit' to stop.

    Example: mmrs can hub --loss 0.05 --log bus.log
    """
    from auv_vessel.hosting import tells_time
    from auv_vessel.wire.hub import Troubles, is_loopback
    from mmrs_auv.commands.hubbing import run_hub

    tell("no arbitration, no bit rate, no acknowledgement, no error frames, no bus-off (--help says more)")
    if not is_loopback(host):
        tell(f"the bus is unauthenticated: every computer that reaches {host} can send on it")
    with _opened(log) as file:
        troubles = Troubles(loss, delay, corruption)
        spared = tells_time if simulated else lambda frame: False
        done = run_hub(host, port, troubles, seed, file, seconds, say, spared)
    counted = ", ".join(
        f"{done.counts[each]} {each}" for each in _COUNTED if done.counts[each] or each == "frames"
    )
    say(counted)
    return 0


@app.command("monitor")
def monitor(
    vehicle: Vehicle,
    robot: RobotName = "",
    interface: Interface = "socketcand",
    channel: Channel = "can0",
    only: Annotated[
        list[str] | None,
        typer.Option("--only", metavar="MESSAGE", help="Show only this message. Repeatable."),
    ] = None,
    seconds: Duration = 0.0,
) -> int:
    """Decode and print a vehicle's CAN traffic.

    Ends with a summary of missing and implausible messages.

    Example: mmrs can monitor examples/pool --robot Naiad --only Depth --only ActuatorsEmergency
    """
    from mmrs_auv.commands.watching import Monitor, received

    sheet = sheet_in(vehicle, robot)
    watched = Monitor(sheet)
    if odd := sorted(set(only or ()) - watched.names):
        raise typer.BadParameter(
            f"--only {odd[0]}: no such message; there are {', '.join(sorted(watched.names))}"
        )
    with _connected(interface, channel, sheet.bit_rate) as port:
        try:
            for time, frame in received(port, seconds):
                line = watched.line(frame)
                if not only or watched.name_of(frame) in only:
                    say(f"{time:10.3f} {line}")
        finally:
            for line in watched.summary():
                tell(line)
    return 0


@app.command("load")
def load(
    vehicle: Vehicle,
    robot: RobotName = "",
    log: Annotated[
        Path | None,
        typer.Option("--log", metavar="FILE", help="Log of a bus, from candump or 'mmrs can hub'."),
    ] = None,
    interface: Annotated[
        str,
        typer.Option("--interface", metavar="NAME", help="python-can interface to listen on. Default: none."),
    ] = "",
    channel: Channel = "can0",
    seconds: Annotated[
        float, typer.Option("--for", min=0.1, metavar="SECONDS", help="Seconds to listen on --interface.")
    ] = 10.0,
    messages: Annotated[
        bool, typer.Option("--messages", help="List the load and response time of each message, too.")
    ] = False,
    json: Json = False,
) -> int:
    """Compute a vehicle's CAN bus load.

    Computes the load from message lengths and periods, without stuff bits and with as many as there can be,
    and the worst-case response time of each message. With --log or --interface, also measures the load of the
    frames received.

    Example: mmrs can load examples/pool --robot Naiad --messages
    """
    from auv_vessel.wire.load import load_of, measured_load
    from mmrs_auv.commands.watching import summary, table

    sheet = sheet_in(vehicle, robot)
    designed = load_of(sheet)
    frames = _logged(log) if log is not None else None
    if frames is None and interface:
        frames = _listened(interface, channel, sheet.bit_rate, seconds)
    found = None if frames is None else measured_load(frames, sheet.bit_rate)
    if frames is not None and found is None:
        raise LinkLostError("no frames at two different times: nothing was said")
    if json:
        say_json({"designed": asdict(designed), "heard": asdict(found) if found else None})
        return 0
    for line in (*(table(designed) if messages else ()), *summary(designed, found)):
        say(line)
    return 0


def _listened(interface: str, channel: str, bit_rate: int, seconds: float) -> list[tuple[float, Frame]]:
    from mmrs_auv.commands.watching import received

    with _connected(interface, channel, bit_rate) as port:
        return list(received(port, seconds))


def _logged(file: Path) -> list[tuple[float, Frame]]:
    from can import LogReader

    from auv_vessel.wire.frame import Frame

    try:
        with LogReader(file) as log:
            return [
                (each.timestamp, Frame(each.arbitration_id, bytes(each.data), each.is_extended_id))
                for each in log
                if not (each.is_error_frame or each.is_remote_frame or each.is_fd)
            ]
    except OSError as error:
        raise UnreadableError(f"{file}: {error.strerror}") from error
    except Exception as error:  # python-can's readers raise whatever their format's library does
        raise UnreadableError(f"{file}: not a log of a bus: {error}") from error


@contextmanager
def _connected(interface: str, channel: str, bit_rate: int) -> Iterator[Port]:
    from auv_vessel.wire.ports import PortError, open_port

    rate = None if interface in ("socketcan", "socketcand", "virtual") else bit_rate
    try:
        with open_port(interface, channel, bit_rate=rate, say=tell) as port:
            yield port
    except PortError as error:
        raise LinkLostError(str(error)) from error
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error


@contextmanager
def _opened(file: Path | None) -> Iterator[TextIO | None]:
    if file is None:
        yield None
        return
    try:
        log = file.open("w", encoding="ascii", buffering=1)
    except OSError as error:
        raise UnreadableError(f"{file}: {error.strerror}") from error
    try:
        yield log
    finally:
        with suppress(OSError):  # that was told when it happened
            log.close()
