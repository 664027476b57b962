"""Run one of the three vision processes of an underwater vehicle.

frames captures pictures from the cameras into shared memory; front and bottom detect objects in them.

Examples:
python -m auv_vision frames --sheet auv.json --surroundings pool.json --channel can0@127.0.0.1:29536
python -m auv_vision front --sheet auv.json --surroundings pool.json --to 127.0.0.1:29600
python -m auv_vision bottom --sheet auv.json --surroundings pool.json --to 127.0.0.1:29600
"""

from __future__ import annotations

import argparse
import logging
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from urllib.parse import quote

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.surroundings import from_json as surroundings_from
from auv_vessel.eyes import CAMERAS
from auv_vessel.hosting import FramePort, clock_time
from auv_vessel.node import stopped_by_signals
from auv_vessel.refusals import refuse
from auv_vessel.sheet import Sheet
from auv_vessel.sheet import from_json as sheet_from
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame
from auv_vision.cameras import Camera, Pose, cameras_of
from auv_vision.ring import Reader, Writer

STALE = 1.0
"""Seconds of silence after which a pose is not known any more."""


class Whereabouts:
    """Receives positions and poses; one thread may receive while another asks."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._lock = threading.Lock()
        self._values: dict[str, dict[str, float]] = {}
        self._last: dict[str, float] = {}
        self._clock: float | None = None

    def hear(self, frame: Frame) -> None:
        """Take a frame of the bus."""
        time_said = clock_time(frame)
        if time_said is not None:
            self._clock = time_said
            return
        received = self._codec.decode(frame)
        if received is None or received.name not in ("Position", "Depth", "Pose"):
            return
        values = {key: float(value) for key, value in received.values.items() if not isinstance(value, str)}
        with self._lock:
            self._values[received.name] = values
            self._last[received.name] = time.monotonic()

    def pose(self) -> Pose | None:
        """Return where the vehicle believes to be; None if that is not known, or not to be trusted."""
        with self._lock:
            now = time.monotonic()
            if len(self._last) < 3 or now - min(self._last.values()) > STALE:
                return None
            place, depth, turned = (self._values[name] for name in ("Position", "Depth", "Pose"))
        if not depth["Trusted"]:
            return None
        return Pose(
            place["North"], place["East"], depth["Depth"], turned["Roll"], turned["Pitch"], turned["Heading"]
        )

    def now(self) -> float:
        """Return the time of the vehicle's clock; that of this computer where no time is received."""
        return time.time() if self._clock is None else self._clock

    def listen(self, port: FramePort, stop: threading.Event) -> None:
        """Read a bus until stopped; raises the port's errors when the bus is gone."""
        while not stop.is_set():
            if (frame := port.receive(0.1)) is not None:
                self.hear(frame)


FRAMES, NONE = "frames", "none"
EXIT_USAGE, EXIT_GONE = 2, 3


class GoneError(Exception):
    """What a process needs is gone: it is started again from outside."""


def main(words: Sequence[str] | None = None) -> int:
    """Serve until SIGTERM, SIGINT or the end of a file; return the exit status."""
    given = _parser().parse_args(words)
    logging.getLogger("can").setLevel(logging.ERROR)
    stop = stopped_by_signals()
    import cv2

    cv2.setNumThreads(1)
    try:
        sheet = sheet_from(given.sheet.read_text(encoding="utf-8"))
        refuse(sheet)
        around = surroundings_from(given.surroundings.read_text(encoding="utf-8"))
        _serve(given, sheet, around, stop)
    except GoneError as error:
        print(f"{given.part}: {error}", file=sys.stderr)
        return EXIT_GONE
    except (OSError, ValueError) as error:
        print(f"{given.part}: {error}", file=sys.stderr)
        return EXIT_USAGE
    finally:
        if given.figures:
            given.figures.write_text(f"{time.process_time():.3f}\n", encoding="utf-8")
    return 0


_SHEET = "vehicle configuration (JSON) from 'mmrs auv sheet'"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m auv_vision", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("part", choices=(FRAMES, *CAMERAS), help="process to run")
    parser.add_argument("--sheet", type=Path, required=True, metavar="FILE", help=_SHEET)
    parser.add_argument(
        "--surroundings", type=Path, required=True, metavar="FILE", help="objects to detect, as JSON"
    )
    parser.add_argument(
        "--memory", metavar="NAME", help="name of the shared memory. Default: by the vehicle's name"
    )
    parser.add_argument(
        "--to",
        type=_address,
        default=("127.0.0.1", 29600),
        metavar="HOST:PORT",
        help="UDP address of the controller that receives detections. Default: 127.0.0.1:29600",
    )
    for camera in CAMERAS:
        parser.add_argument(
            f"--{camera}",
            metavar="SOURCE",
            help=f"pictures of the {camera} camera: simulated, none, a video file, a camera's number or "
            "device, or two of these for a stereo pair, as in 0,1. Default: simulated, or none "
            "if the other is given",
        )
    parser.add_argument(
        "--rate", type=_rate, default=5.0, metavar="HERTZ", help="stereo pairs per second. Default: 5"
    )
    parser.add_argument(
        "--seed",
        type=int,
        default=0,
        metavar="N",
        help="random seed for the noise of simulated pictures. Default: 0",
    )
    parser.add_argument(
        "--interface",
        default="socketcand",
        metavar="NAME",
        help="python-can interface to receive the vehicle's position from; none: the vehicle stays at its "
        "home. Default: socketcand",
    )
    parser.add_argument(
        "--channel",
        default="can0@127.0.0.1:29536",
        metavar="NAME",
        help="channel of the interface. Default: can0@127.0.0.1:29536",
    )
    parser.add_argument("--figures", type=Path, metavar="FILE", help="file for the processor time used")
    return parser


def _address(text: str) -> tuple[str, int]:
    host, _, port = text.rpartition(":")
    if not host or not port.isdecimal() or len(port) > 5 or not 0 < int(port) < 65536:
        raise argparse.ArgumentTypeError(f"{text}: expected HOST:PORT")
    return host, int(port)


def _rate(text: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 0.0 < rate <= 100.0:
        raise argparse.ArgumentTypeError(f"{text}: expected a rate above 0, at most 100")
    return rate


def memory_of(robot: str) -> str:
    """Return the name of the memory of a vehicle's eyes: each has its own."""
    return f"mmrs-eyes-{quote(robot, safe='')[:200]}"


def _serve(given: argparse.Namespace, sheet: Sheet, around: Surroundings, stop: threading.Event) -> None:
    cameras = dict(zip(CAMERAS, cameras_of(sheet), strict=True))
    given.memory = given.memory or memory_of(sheet.robot)
    if given.part == FRAMES:
        _serve_frames(given, sheet, around, cameras, stop)
        return
    from auv_vision.detecting import sought_in, unseen
    from auv_vision.processes import watch
    from auv_vision.water import POOL, hazier

    camera, sought = cameras[given.part], sought_in(around)
    for each in unseen(camera, sought):
        print(f"{given.part}: {each}", file=sys.stderr)
    with Reader(f"{given.memory}-{given.part}") as reader:
        watch(reader, camera, sought, given.to, stop, hazier(POOL, around.haze), sheet.robot)


def _serve_frames(
    given: argparse.Namespace,
    sheet: Sheet,
    around: Surroundings,
    cameras: dict[str, Camera],
    stop: threading.Event,
) -> None:
    from auv_vision.processes import handle
    from auv_vision.renderer import Renderer
    from auv_vision.sources import SIMULATED, SourceError, opened

    given_by_name = {name: getattr(given, name) for name in CAMERAS}
    otherwise = SIMULATED if set(given_by_name.values()) == {None} else NONE
    chosen = {name: otherwise if text is None else text for name, text in given_by_name.items()}
    used = {name: text for name, text in chosen.items() if text != NONE}
    if not used:
        raise ValueError("--front none, --bottom none: no camera is used")
    with ExitStack() as stack:
        renderer = Renderer(around, given.seed)
        sources = {name: opened(text, cameras[name], lambda: renderer) for name, text in used.items()}
        for source in sources.values():
            stack.callback(source.close)
        writers = {
            name: stack.enter_context(
                Writer(f"{given.memory}-{name}", cameras[name].width, cameras[name].height)
            )
            for name in used
        }
        where, clock, lost = _whereabouts(given, sheet, stop, stack)
        try:
            handle(sources, cameras, writers, where, clock, stop, given.rate)
        except SourceError as error:
            raise GoneError(str(error)) from error
        if lost:
            raise GoneError(f"bus lost: {lost[0]}")


def _whereabouts(
    given: argparse.Namespace, sheet: Sheet, stop: threading.Event, stack: ExitStack
) -> tuple[Callable[[], Pose | None], Callable[[], float], list[str]]:
    """Return who tells the vehicle's pose, who tells its time, and a list for why the bus is gone."""
    lost: list[str] = []
    if given.interface == "none":
        home = Pose(*sheet.home, heading=sheet.heading)
        return lambda: home, time.time, lost
    from auv_vessel.wire.codec import Codec
    from auv_vessel.wire.ports import open_port

    whereabouts = Whereabouts(Codec(sheet))

    def tell(text: str) -> None:
        print(f"{given.part}: {text}", file=sys.stderr, flush=True)

    port = stack.enter_context(open_port(given.interface, given.channel, say=tell))

    def listen() -> None:
        try:
            whereabouts.listen(port, stop)
        except OSError as error:
            lost.append(str(error))
            stop.set()

    listener = threading.Thread(target=listen, name="whereabouts", daemon=True)
    listener.start()
    stack.callback(listener.join)
    stack.callback(stop.set)
    return whereabouts.pose, whereabouts.now, lost


if __name__ == "__main__":
    sys.exit(main())
