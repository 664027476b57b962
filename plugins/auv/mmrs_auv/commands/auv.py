"""``mmrs auv``: simulated underwater vehicles to rehearse on."""

from __future__ import annotations

import signal
import tempfile
import time
from contextlib import ExitStack
from math import inf
from pathlib import Path
from shlex import quote
from types import FrameType
from typing import Annotated

import typer

from mmrs_core.cli.interruption import INTERRUPTED
from mmrs_core.cli.output import say
from mmrs_core.cli.parameters import Duration
from mmrs_core.cli.typed import typed_lines
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.writing import replace_files
from mmrs_runtime.records.steps import SUFFIX, log_name

FIRST_PORT = 29_600

app = typer.Typer(rich_markup_mode=None, no_args_is_help=True, add_completion=False)


@app.callback(help="Simulate underwater vehicles.")
def auv() -> None:
    """Leave the help to the application; without this, one command alone would lose its name."""


@app.command("sitl")
def sitl(
    path: Annotated[
        Path, typer.Argument(metavar="PROJECT|BEHAVIOUR", help="Project folder, mission or behaviour file.")
    ],
    port: Annotated[
        int,
        typer.Option(
            "--port",
            metavar="PORT",
            min=1,
            max=65_000,
            help="TCP port of the first vehicle's bus; one more for each vehicle.",
        ),
    ] = FIRST_PORT,
    speedup: Annotated[
        float,
        typer.Option(
            "--speedup", metavar="FACTOR", min=0.1, max=20.0, help="Simulated seconds per real second."
        ),
    ] = 1.0,
    surroundings: Annotated[
        Path | None,
        typer.Option(
            "--surroundings",
            metavar="FILE",
            help="JSON file of the water (current, bottom, haze), obstacles and things to see; replaces "
            "--current and --bottom.",
        ),
    ] = None,
    current: Annotated[
        str, typer.Option("--current", metavar="NORTH,EAST", help="Water current north and east, in m/s.")
    ] = "0,0",
    bottom: Annotated[
        float, typer.Option("--bottom", metavar="METRES", min=1.0, help="Water depth in metres.")
    ] = 30.0,
    seed: Annotated[
        int, typer.Option("--seed", metavar="N", min=0, help="Random seed for instrument noise and bias.")
    ] = 0,
    seconds: Duration = 0.0,
) -> int:
    """Start each AUV's simulator and control layer.

    Each vehicle has its own virtual CAN bus. Prints the arguments for 'mmrs run'. Type 'Thetis
    leak', 'all thruster-dead T1', 'Thetis frozen Pressure', 'Thetis battery 0.2' or 'Thetis cut' (its bus) to
    inject a fault, 'Thetis clear leak' to clear it, 'status' to print the vehicles' state, 'quit' to stop.

    Example: mmrs auv sitl examples/pool-course --speedup 2
    """
    from auv_vessel.body.surroundings import Surroundings, from_json
    from mmrs_auv.backend.options import pair
    from mmrs_auv.commands.modelled import sheets_in
    from mmrs_auv.rehearsal import VehicleProcesses, keep

    try:
        around = Surroundings(current=pair(current), bottom=bottom)
        if surroundings is not None:
            around = from_json(surroundings.read_text(encoding="utf-8"))
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error
    except OSError as error:
        raise UnreadableError(f"{surroundings}: {error.strerror}") from error
    stopped: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        stopped.append(number)

    sheets = sheets_in(path)
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        for number in _ending():
            stack.callback(signal.signal, number, signal.signal(number, stop))
        berths = {}
        for count, (robot, sheet) in enumerate(sheets.items()):
            if stopped:
                return INTERRUPTED
            berths[robot] = stack.enter_context(
                VehicleProcesses(
                    sheet,
                    folder / str(count),
                    port=port + count,
                    surroundings=around,
                    seed=seed + count,
                    speedup=speedup,
                )
            )
        words = ["--backend", "can", "--backend-option", "clock=bus"]
        for robot, berth in berths.items():
            words += ["--connect", f"{robot}={berth.channel}"]
        words += ["--speedup", f"{speedup:g}"] if speedup != 1.0 else []
        say(" ".join(map(quote, words)))
        keep(berths, time.monotonic() + (seconds or inf), stopped, typed_lines())
    return INTERRUPTED if stopped else 0


def _ending() -> list[signal.Signals]:
    """Return the signals that end it; a terminal that closes does, unless it was to be ignored."""
    heeded = [signal.SIGINT, signal.SIGTERM]
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        heeded.append(signal.SIGHUP)
    return heeded


@app.command("sheet")
def sheet(
    path: Annotated[
        Path, typer.Argument(metavar="PROJECT|BEHAVIOUR", help="Project folder, mission or behaviour file.")
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Output folder; one file per vehicle.")
    ] = Path("sheets"),
) -> int:
    """Export the configuration of each underwater vehicle as JSON.

    'mmrs can' reads it, and so do auv_vessel (control layer) and auv_vision (cameras) with --sheet.

    Example: mmrs auv sheet examples/pool-course -o sheets
    """
    from auv_vessel.sheet import to_json
    from mmrs_auv.commands.modelled import sheets_in

    files = {
        output / f"{log_name(robot).removesuffix(SUFFIX)}.json": to_json(found).encode()
        for robot, found in sheets_in(path).items()
    }
    try:
        replace_files(files)
    except OSError as error:
        raise UnreadableError(f"{output}: {error.strerror}") from error
    for file in files:
        say(f"written: {file}")
    return 0
