"""The eyes of a vehicle as processes, and a bus that tells them where it is."""

import os
import signal
import subprocess
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from secrets import token_hex

import warm_python
from can_hub import running
from sample_vessels import pool_sheet

from auv_vessel.body.surroundings import BUOY, GATE, PATH, Surroundings, Thing, to_json
from auv_vessel.eyes import Detections
from auv_vessel.sheet import to_json as sheet_json
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.ports import open_port
from auv_vision.cameras import Pose

POOL = Surroundings(
    bottom=4.0,
    things=(
        Thing(GATE, "gate", 6.0, 0.0, 1.0, 0.0, "orange", 2.0),
        Thing(BUOY, "red buoy", 5.0, 1.6, 1.8, 0.0, "red", 0.3),
        Thing(BUOY, "yellow buoy", 4.0, -1.0, 1.6, 0.0, "yellow", 0.3),
        Thing(PATH, "path", 0.2, 0.1, 4.0, 30.0, "orange", 1.2),
    ),
)
PARTS = ("frames", "front", "bottom")


class Teller:
    """Says on a bus where the vehicle is, as its sensor controller does.

    Attributes:
        pose: that is told; trusted: whether it is told to be.
    """

    def __init__(self, channel: str, pose: Pose) -> None:
        self.pose, self.trusted = pose, True
        self._codec = Codec(pool_sheet())
        self._port = open_port("socketcand", channel)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._tell, daemon=True)
        self._thread.start()

    def _tell(self) -> None:
        while not self._stop.wait(0.05):
            pose = self.pose
            said = (
                ("Position", {"North": pose.north, "East": pose.east}),
                ("Depth", {"Depth": pose.depth, "Uncertainty": 0.1, "Trusted": self.trusted}),
                ("Pose", {"Roll": pose.roll, "Pitch": pose.pitch, "Heading": pose.heading}),
            )
            for name, values in said:
                self._port.send(self._codec.encode(name, **values))

    def close(self) -> None:
        self._stop.set()
        self._thread.join()
        self._port.close()


class Head:
    """Processes, who tells them where they are, and who listens."""

    def __init__(self, folder: Path, channel: str, pose: Pose, parts: Iterable[str], python: str) -> None:
        self._files = (folder / "sheet.json", folder / "pool.json")
        self._files[0].write_text(sheet_json(pool_sheet()))
        self._files[1].write_text(to_json(POOL))
        self.memory = f"mmrs-test-{token_hex(6)}"
        self.channel = channel
        self.told = Teller(channel, pose)
        self.detections = Detections(lasting=2.0)
        self._python = python
        self.parts = {part: self.start(part) for part in parts}

    def start(self, part: str, *words: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [
                self._python, "-m", "auv_vision", part, "--sheet", str(self._files[0]),
                "--surroundings", str(self._files[1]), "--memory", self.memory, "--rate", "5",
                "--channel", self.channel, "--to", f"127.0.0.1:{self.detections.port}", *words,
            ],
            stderr=subprocess.PIPE, text=True,
        )  # fmt: skip

    def kill(self, part: str) -> None:
        os.kill(self.parts[part].pid, signal.SIGKILL)
        self.parts[part].communicate(timeout=20)

    def restart(self, part: str) -> None:
        self.parts[part] = self.start(part)

    def cpu(self) -> float:
        """Return seconds of processor time that all have had."""
        ticks = 0
        for process in self.parts.values():
            figures = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
            ticks += int(figures[11]) + int(figures[12])
        return ticks / os.sysconf("SC_CLK_TCK")

    def close(self) -> list[int]:
        """End all; return the processes' exit statuses."""
        for process in self.parts.values():
            process.terminate()
        for process in self.parts.values():
            process.communicate(timeout=20)
        self.told.close()
        self.detections.close()
        return [process.returncode for process in self.parts.values()]


@contextmanager
def eyes(folder: Path, pose: Pose, parts: Iterable[str] = PARTS, python: str | None = None) -> Iterator[Head]:
    """Have these processes of a vehicle's eyes run, by a Python that has imported all that they need."""
    with running() as hub:
        head = Head(folder, f"can0@127.0.0.1:{hub.port}", pose, parts, python or warm_python.python())
        try:
            yield head
        finally:
            head.close()
