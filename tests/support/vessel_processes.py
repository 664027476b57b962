"""A vehicle as processes on a hub, in real time, and an ear on its bus."""

import os
import signal
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from warm_python import python

from auv_vessel.api import Connection
from auv_vessel.sheet import Sheet, to_json
from auv_vessel.wire.codec import Codec, Received
from auv_vessel.wire.ports import Port, PortError, open_port

PARTS = ("vehicle", "sensors", "actuators", "movement")


class Ear:
    """Hears all that is said on a bus, each with the time of this process's monotonic clock."""

    def __init__(self, sheet: Sheet, port: Port) -> None:
        self.heard: list[tuple[float, Received]] = []
        self.codec = Codec(sheet)
        self._port = port
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    def _listen(self) -> None:
        try:
            while True:
                frame = self._port.receive(1.0)
                if frame is not None and (said := self.codec.decode(frame)) is not None:
                    self.heard.append((time.monotonic(), said))
        except PortError:
            return

    def said(self, name: str, since: float = 0.0) -> list[tuple[float, Received]]:
        """Return what messages of that name, or with such a beginning, said since then."""
        return [(at, said) for at, said in tuple(self.heard) if at >= since and said.name.startswith(name)]

    def last_thrust(self, since: float) -> float:
        """Return when a drive last told of thrust, after that time; that time if none did."""
        pushed = [
            at
            for at, said in self.said("Thruster", since)
            if said.name.endswith("Status") and said.values["Thrust"] != 0.0
        ]
        return max(pushed, default=since)


class Boat:
    """A vehicle that runs."""

    def __init__(self, sheet: Sheet, folder: Path, drives: Path | None = None) -> None:
        self.sheet = sheet
        self.file = folder / "sheet.json"
        self.file.write_text(to_json(sheet))
        hub = [python(), "-m", "mmrs_core", "can", "hub", "--port", "0", "--log", str(folder / "bus.log")]
        self.hub = subprocess.Popen(
            hub,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, bufsize=1,
        )  # fmt: skip
        assert self.hub.stdout is not None
        port = int(self.hub.stdout.readline().split()[2].rpartition(":")[2].rstrip(";"))
        self.channel = f"can0@127.0.0.1:{port}"
        without = () if drives is None else ("--without-drives",)
        self.parts = {part: self.start(part, *(without if part == "vehicle" else ())) for part in PARTS}
        if drives is not None:
            self.parts["drives"] = subprocess.Popen(
                [str(drives), "127.0.0.1", str(port)], stderr=subprocess.PIPE, text=True
            )
        self.ear = Ear(sheet, open_port("socketcand", self.channel))
        self.connection = Connection(sheet, open_port("socketcand", self.channel))
        self.craft = self.connection.craft

    def start(self, part: str, *more: str) -> subprocess.Popen[str]:
        words = [
            python(),
            "-m",
            "auv_vessel",
            part,
            "--sheet",
            str(self.file),
            "--channel",
            self.channel,
            *more,
        ]
        return subprocess.Popen(words, stderr=subprocess.PIPE, text=True)

    def order(self, line: str) -> None:
        """Tell the hub something, as if it was typed; returns when it counts."""
        assert self.hub.stdin is not None
        assert self.hub.stdout is not None
        self.hub.stdin.write(line + "\n")
        self.hub.stdout.readline()

    def kill(self, part: str) -> float:
        """Kill a part at once; return when."""
        os.kill(self.parts[part].pid, signal.SIGKILL)
        return time.monotonic()

    def close(self) -> None:
        self.connection.close()
        for process in self.parts.values():
            process.terminate()
        for process in self.parts.values():
            process.communicate(timeout=20)
        self.hub.terminate()
        self.hub.communicate(timeout=20)


@contextmanager
def boat(sheet: Sheet, folder: Path, drives: Path | None = None) -> Iterator[Boat]:
    """Have a vehicle run; `drives`: a program that stands for those of its thrusters."""
    found = Boat(sheet, folder, drives)
    try:
        yield found
    finally:
        found.close()
