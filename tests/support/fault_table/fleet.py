"""Robots in the air: simulated vehicles, and the process that flies them one way or the other."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from fault_table.project import Pad, home_of, write_project
from mmrs_core.sitl import Settings, SimulatedVehicle

EXECUTIONS = ("generated", "interpreted")
STARTED_SECONDS = 60.0


class Fleet:
    """One process with all robots of a project, and a vehicle for each.

    Attributes:
        vehicles: by robot.
        said: what the process has said so far.
        logs: folder of the logs.
    """

    def __init__(
        self,
        folder: Path,
        pads: Sequence[Pad],
        execution: str,
        *,
        speedup: float = 10.0,
        settings: Mapping[str, Mapping[str, object]] | None = None,
        arguments: Sequence[str] = (),
    ) -> None:
        """Write a project, and switch its vehicles on.

        Args:
            folder: for all files.
            pads: robots with their programs and policies.
            execution: one of `EXECUTIONS`.
            speedup: seconds of the run in a second.
            settings: of the vehicles, by robot.
            arguments: of the process, beside those that it needs.
        """
        self.folder, self.pads, self.execution, self.speedup = folder, pads, execution, speedup
        self.behaviour = write_project(folder, pads)
        self.logs = folder / "logs"
        self.vehicles: dict[str, SimulatedVehicle] = {}
        self.said: list[str] = []
        self.process: subprocess.Popen[str] | None = None
        self._arguments = list(arguments)
        self._links: list[str] = []
        for index, pad in enumerate(pads):
            port = free_port()
            given = Settings("copter", *home_of(index), **(settings or {}).get(pad.robot, {}))
            self.vehicles[pad.robot] = SimulatedVehicle(port, given, speedup=speedup)
            self._links += ["--link", f"{pad.robot}=udpin:127.0.0.1:{port}"]
        if execution == "generated":
            mmrs("generate", str(self.behaviour), "--target", "mavlink-python", "-o", str(folder / "made"))

    def __enter__(self) -> Fleet:
        for vehicle in self.vehicles.values():
            vehicle.start()
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.kill()
        if self.process is not None:
            self.process.wait()
            self._reader.join()
        for vehicle in self.vehicles.values():
            vehicle.stop()

    def start(self, *arguments: str) -> None:
        """Start the process; again, with further arguments, after it has ended."""
        command = [sys.executable, "-W", "error", *self._program(), *self._links]
        command += ["--log", str(self.logs), "--speedup", str(self.speedup), *self._arguments, *arguments]
        self.process = subprocess.Popen(
            command,
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._reader = threading.Thread(target=self._listen, args=(self.process,), daemon=True)
        self._reader.start()

    def _program(self) -> list[str]:
        if self.execution == "generated":
            return [str(self.folder / "made" / "fleet.py")]
        return ["-m", "mmrs_core", "run", str(self.behaviour), "--backend", "mavlink"]

    def _listen(self, process: subprocess.Popen[str]) -> None:
        assert process.stderr is not None
        with process.stderr:
            for line in process.stderr:
                self.said.append(line.rstrip("\n"))

    def signal(self, number: int) -> None:
        """Send the process a signal."""
        assert self.process is not None
        self.process.send_signal(number)

    def end(self, seconds: float = 60.0) -> int | None:
        """Wait for the end of the process; return its exit code, None if it has not ended in that time."""
        assert self.process is not None
        try:
            code = self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            return None
        self._reader.join()
        return code

    def running(self) -> bool:
        """Return whether the process has not ended."""
        return self.process is not None and self.process.poll() is None

    def steps(self, robot: str) -> list[dict[str, object]]:
        """Return the steps in a robot's log; a line cut off at the end is left out."""
        return _lines(self.logs / f"{robot}.jsonl")

    def box(self, robot: str) -> list[dict[str, object]]:
        """Return the lines of a robot's black box."""
        return _lines(self.logs / f"{robot}.blackbox.ndjson")


def _lines(path: Path) -> list[dict[str, object]]:
    if not path.exists():
        return []
    lines = path.read_text("ascii").splitlines(keepends=True)
    return [json.loads(line) for line in lines if line.endswith("\n")]


def mmrs(*arguments: str) -> str:
    """Run a command of ours that must succeed; return what it printed."""
    done = subprocess.run(
        [sys.executable, "-m", "mmrs_core", *arguments],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, f"{arguments}: {done.stdout}{done.stderr}"
    return done.stdout


def free_port() -> int:
    """Return a UDP port that nobody uses."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def wait_for(test, seconds: float) -> bool:
    """Return whether a test has come true in that many real seconds."""
    until = time.monotonic() + seconds
    while not test():
        if time.monotonic() > until:
            return False
        time.sleep(0.02)
    return True
