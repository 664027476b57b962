"""Run one part of an underwater vehicle as a process on its CAN bus.

sensors, actuators and movement are the parts of the control layer; vehicle simulates the vehicle itself.

Example:
python -m auv_vessel vehicle --sheet auv.json --interface socketcand --channel can0@127.0.0.1:29536
"""

from __future__ import annotations

import argparse
import logging
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING

from auv_vessel.hosting import ClockSilentError, Pace, serve
from auv_vessel.node import Node, stopped_by_signals
from auv_vessel.sheet import Sheet, from_json
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.ports import CHANNEL, PortError, open_port

if TYPE_CHECKING:
    from auv_vessel.body.vehicle import Vehicle
    from auv_vessel.control.drives import Drives

PARTS = ("sensors", "actuators", "movement", "vehicle")


def main(words: Sequence[str] | None = None) -> int:
    """Serve the part that is asked for until SIGTERM or SIGINT; return the exit status."""
    logging.getLogger("can").setLevel(logging.ERROR)
    given = _parser().parse_args(words)

    def tell(text: str) -> None:
        print(f"{given.part}: {text}", file=sys.stderr, flush=True)

    try:
        sheet = from_json(given.sheet.read_text(encoding="utf-8"))
        node = _node(given, sheet)
        port = open_port(given.interface, given.channel, bit_rate=given.bit_rate, say=tell)
    except (OSError, ValueError) as error:
        print(f"{given.part}: {error}", file=sys.stderr)
        return 2
    stop = stopped_by_signals()
    late: list[float] = []
    begin = time.process_time()
    try:
        with port:
            serve(
                node,
                port,
                _pace(given),
                stop,
                speedup=given.speedup,
                late=late.append if given.figures else None,
                say=tell,
            )
    except ClockSilentError as error:
        print(f"{given.part}: {error}", file=sys.stderr)
        return 3
    except PortError as error:
        print(f"{given.part}: bus lost: {error}", file=sys.stderr)
        return 3
    if given.figures:
        _write_figures(given.figures, late, time.process_time() - begin)
    return 0


_SHEET = "vehicle configuration (JSON) from 'mmrs auv sheet'"
_INTERFACE = "python-can interface. Default: socketcand"
_CHANNEL = f"channel of the interface; NAME@HOST:PORT for a hub on another machine. Default: {CHANNEL}"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m auv_vessel", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("part", choices=PARTS, help="part to run")
    parser.add_argument("--sheet", type=Path, required=True, metavar="FILE", help=_SHEET)
    parser.add_argument("--interface", default="socketcand", metavar="NAME", help=_INTERFACE)
    parser.add_argument("--channel", default=CHANNEL, metavar="NAME", help=_CHANNEL)
    parser.add_argument(
        "--bit-rate", type=int, metavar="BITS", help="bit rate per second, for adapters that need it"
    )
    parser.add_argument(
        "--clock",
        choices=("real", "bus"),
        default="real",
        help="clock; bus: the time that the simulated vehicle sends. Default: real",
    )
    parser.add_argument(
        "--speedup",
        type=float,
        default=1.0,
        metavar="FACTOR",
        help="simulated seconds per real second, for vehicle with --clock bus. Default: 1",
    )
    parser.add_argument(
        "--surroundings",
        type=Path,
        metavar="FILE",
        help="surroundings of the simulated vehicle, as JSON. Default: still water, 100 m deep",
    )
    parser.add_argument(
        "--drives",
        metavar="MODULE:FUNCTION,OPTION=VALUE,...",
        help="for actuators: driver of thrusters with another protocol, such as "
        "mmrs_dronecan.speed_controllers:opened",
    )
    parser.add_argument(
        "--without-drives",
        action="store_true",
        help="for vehicle: take the thrust from speed controllers that are nodes of their own on the bus",
    )
    parser.add_argument(
        "--faults",
        action="store_true",
        help="for vehicle: read faults to inject from standard input, as 'mmrs auv sitl' does",
    )
    parser.add_argument(
        "--seed",
        type=int,
        default=0,
        metavar="N",
        help="random seed for instrument noise and bias. Default: 0",
    )
    parser.add_argument(
        "--figures", type=Path, metavar="FILE", help="file for the processor time and the delay of each tick"
    )
    return parser


def _pace(given: argparse.Namespace) -> Pace:
    if given.clock == "real":
        return "real"
    return "lead" if given.part == "vehicle" else "bus"


def _node(given: argparse.Namespace, sheet: Sheet) -> Node:
    """Return the part; only what it needs is imported."""
    codec = Codec(sheet)
    if given.part == "sensors":
        from auv_vessel.control.sensors import Sensors

        return Sensors(sheet, codec)
    if given.part == "actuators":
        from auv_vessel.control.actuators import Actuators

        return Actuators(sheet, codec, _drives(given.drives, sheet))
    if given.part == "movement":
        from auv_vessel.movement.movement import Movement

        return Movement(sheet, codec)
    from auv_vessel.body import surroundings as around
    from auv_vessel.body.vehicle import Vehicle

    text = None if given.surroundings is None else given.surroundings.read_text(encoding="utf-8")
    found = around.Surroundings() if text is None else around.from_json(text)
    vehicle = Vehicle(sheet, codec, found, given.seed, without_drives=given.without_drives)
    return _befallen(sheet, vehicle) if given.faults else vehicle


def _befallen(sheet: Sheet, vehicle: Vehicle) -> Node:
    from auv_vessel.body.befalling import Befallen

    lines: SimpleQueue[str] = SimpleQueue()

    def read() -> None:
        for line in sys.stdin:
            lines.put(line)

    threading.Thread(target=read, name="typed lines", daemon=True).start()
    return Befallen(sheet, vehicle, lines, lambda said: print(said, file=sys.stderr, flush=True))


def _drives(text: str | None, sheet: Sheet) -> Drives | None:
    if text is None:
        return None
    from auv_vessel.control.drives import drives_of

    return drives_of(text, sheet)


def _write_figures(path: Path, late: Sequence[float], seconds: float) -> None:
    """Write seconds of processor time, then how late each tick was, one number in a line."""
    path.write_text("".join(f"{each:.6f}\n" for each in (seconds, *late)), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
