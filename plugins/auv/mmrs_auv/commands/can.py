"""``mmrs can``: the CAN buses of vehicles."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TextIO

import typer
from typer.main import get_command

from mmrs_auv.commands.vehicles import RobotName, Vehicle, sheet_in
from mmrs_core.cli.output import say, say_file, say_json, tell
from mmrs_core.cli.settings import Json
from mmrs_core.errors import LinkLostError, UnreadableError
from mmrs_core.languages.writing import replace_file

if TYPE_CHECKING:
    from auv_vessel.wire.frame import Frame
    from auv_vessel.wire.ports import Port

_HELP = (
    "CAN buses of vehicles: their database (DBC), a hub for processes of one machine, what is said, how busy."
)

app = typer.Typer(rich_markup_mode=None, help=_HELP, no_args_is_help=True, add_completion=False)

_COUNTED = ("frames", "lost", "corrupted", "overdue", "missed", "slowed", "wrong", "refused")

Interface = Annotated[
    str,
    typer.Option("--interface", metavar="NAME", help="As python-can calls it: socketcand, socketcan, ..."),
]
Channel = Annotated[
    str, typer.Option("--channel", metavar="NAME", help="Of it; of a hub elsewhere: NAME@HOST:PORT.")
]
Seconds = Annotated[
    float, typer.Option("--for", min=0.0, metavar="SECONDS", help="End by itself; 0: when interrupted.")
]


def main(arguments: list[str]) -> int:
    """Run ``mmrs can`` with what follows it; return the exit code."""
    result = get_command(app)(args=arguments, prog_name="mmrs can", standalone_mode=False)
    return result if isinstance(result, int) else 0


@app.callback()
def can() -> None:
    """Leave the help to the application; without this, one command alone would lose its name."""


@app.command("dbc")
def dbc(
    vehicle: Vehicle,
    robot: RobotName = "",
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Where to write; else it is printed."),
    ] = None,
) -> int:
    """Write the database of a vehicle's bus, for other people's tools.

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
        str, typer.Option("--host", help="Where to listen; who reaches that can drive what is there.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option("--port", min=0, max=65_535, help="TCP port; 0: any.")] = 29536,
    loss: Annotated[
        float, typer.Option("--loss", min=0.0, max=1.0, help="Part of the frames that nobody hears.")
    ] = 0.0,
    delay: Annotated[
        float, typer.Option("--delay", min=0.0, max=60.0, help="Seconds that each takes.")
    ] = 0.0,
    corruption: Annotated[
        float, typer.Option("--corrupt", min=0.0, max=1.0, help="Part with one to three bits of data wrong.")
    ] = 0.0,
    seed: Annotated[int, typer.Option("--seed", help="Of the chances.")] = 0,
    log: Annotated[
        Path | None, typer.Option("--log", metavar="FILE", help="Write all frames there, as candump does.")
    ] = None,
    simulated: Annotated[
        bool,
        typer.Option("--simulated-time", help="Let frames that tell simulated time pass in any case."),
    ] = False,
    seconds: Seconds = 0.0,
) -> int:
    """Be a bus for several processes of this machine.

    It speaks the protocol of socketcand, and passes on what one says to all others on the same channel, in
    the order in which it comes. It is no CAN: it has no arbitration, no bit rate, no acknowledgement, no
    error frames and no bus-off. Lines such as 'loss 0.2', 'delay 0.05', 'corruption 0.1', 'cut', 'mend' and
    'quit' count at once.

    Example: mmrs can hub --loss 0.05 --log bus.log
    """
    from auv_vessel.hosting import tells_time
    from auv_vessel.wire.hub import Troubles, is_loopback
    from mmrs_auv.commands.hubbing import run_hub

    tell("no arbitration, no bit rate, no acknowledgement, no error frames, no bus-off (--help says more)")
    if not is_loopback(host):
        tell(f"whoever reaches {host} can say anything on this bus: nobody is asked who they are")
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
        list[str] | None, typer.Option("--only", metavar="MESSAGE", help="Tell this one; may be repeated.")
    ] = None,
    seconds: Seconds = 0.0,
) -> int:
    """Tell what is said on a vehicle's bus.

    At the end it tells what was missed, and what was not believed.

    Example: mmrs can monitor examples/pool --robot Naiad --only Depth --only ActuatorsEmergency
    """
    from mmrs_auv.commands.watching import Monitor, heard

    sheet = sheet_in(vehicle, robot)
    watched = Monitor(sheet)
    if odd := sorted(set(only or ()) - watched.names):
        raise typer.BadParameter(
            f"--only {odd[0]}: no such message; there are {', '.join(sorted(watched.names))}"
        )
    with _connected(interface, channel, sheet.bit_rate) as port:
        try:
            for time, frame in heard(port, seconds):
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
        typer.Option("--log", metavar="FILE", help="Of a bus, as candump or mmrs can hub write it."),
    ] = None,
    interface: Annotated[
        str, typer.Option("--interface", metavar="NAME", help="Listen to a bus, --for so many seconds.")
    ] = "",
    channel: Channel = "can0",
    seconds: Annotated[float, typer.Option("--for", min=0.1, metavar="SECONDS", help="To listen.")] = 10.0,
    messages: Annotated[bool, typer.Option("--messages", help="Tell each message by itself.")] = False,
    json: Json = False,
) -> int:
    """Tell how busy a vehicle's bus is at its bit rate.

    By design: from lengths and periods, without any stuff bit and with as many as there can be; and by when
    each message is over in the worst case. With a log or a bus to listen to: also as it was, by the stuff
    bits of the very frames.

    Example: mmrs can load examples/pool --robot Naiad --messages
    """
    from auv_vessel.wire.load import heard_load, load_of
    from mmrs_auv.commands.load_words import summary, table

    sheet = sheet_in(vehicle, robot)
    designed = load_of(sheet)
    frames = _logged(log) if log is not None else None
    if frames is None and interface:
        frames = _listened(interface, channel, sheet.bit_rate, seconds)
    found = None if frames is None else heard_load(frames, sheet.bit_rate)
    if frames is not None and found is None:
        raise LinkLostError("no frames at two different times: nothing was said")
    if json:
        say_json({"designed": asdict(designed), "heard": asdict(found) if found else None})
        return 0
    for line in (*(table(designed) if messages else ()), *summary(designed, found)):
        say(line)
    return 0


def _listened(interface: str, channel: str, bit_rate: int, seconds: float) -> list[tuple[float, Frame]]:
    from mmrs_auv.commands.watching import heard

    with _connected(interface, channel, bit_rate) as port:
        return list(heard(port, seconds))


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
        raise UnreadableError(f"{file}: is no log of a bus: {error}") from error


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
