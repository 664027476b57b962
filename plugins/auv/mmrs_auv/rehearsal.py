"""Simulated vehicles in real time: the bus, body and control layer of each, as processes of their own."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType

from mmrs_auv.vessel.body.surroundings import Surroundings
from mmrs_auv.vessel.body.surroundings import to_json as surroundings_json
from mmrs_auv.vessel.sheet import Sheet, to_json
from mmrs_core.errors import LinkLostError

PARTS = ("vehicle", "sensors", "actuators", "movement")
HUB_SECONDS, END_SECONDS = 30.0, 10.0
"""Real seconds that a hub has to begin, and that processes have to end."""


class Berth:
    """A simulated vehicle: a hub, and one process for each part.

    Attributes:
        channel: by which it is reached, in python-can's words.
    """

    def __init__(
        self,
        sheet: Sheet,
        folder: Path,
        *,
        port: int = 0,
        surroundings: Surroundings | None = None,
        seed: int = 0,
        speedup: float = 1.0,
    ) -> None:
        """Start it.

        Args:
            sheet: of the vehicle.
            folder: for what its processes read.
            port: of the hub; 0: any that is free.
            surroundings: None: water without anything.
            seed: of instruments' noise and bias.
            speedup: seconds of the vehicle's in a second.

        Raises:
            LinkLostError: the hub does not begin.
        """
        self._sheet, self._file = sheet, folder / "sheet.json"
        folder.mkdir(parents=True, exist_ok=True)
        self._file.write_text(to_json(sheet), encoding="utf-8")
        around = folder / "surroundings.json"
        around.write_text(surroundings_json(surroundings or Surroundings()), encoding="utf-8")
        self._processes: dict[str, subprocess.Popen[str]] = {}
        try:
            self.channel = f"can0@127.0.0.1:{self._hub(port)}"
            for part in PARTS[1:]:
                self._start(part)
            own = ("--surroundings", str(around), "--seed", str(seed), "--speedup", str(speedup))
            self._start("vehicle", *own)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Berth:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def ended(self) -> Mapping[str, int]:
        """Return the exit codes of parts that have ended."""
        codes = {part: process.poll() for part, process in self._processes.items()}
        return {part: code for part, code in codes.items() if code is not None}

    @property
    def ids(self) -> Mapping[str, int]:
        """Return the system's number of each process, by part."""
        return {part: process.pid for part, process in self._processes.items()}

    def close(self) -> None:
        """End all of it; the hub last."""
        for part in (*PARTS, "hub"):
            if (process := self._processes.get(part)) is not None:
                process.terminate()
        for process in self._processes.values():
            try:
                process.communicate(timeout=END_SECONDS)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()

    def _hub(self, port: int) -> str:
        words = [sys.executable, "-m", "mmrs_core", "can", "hub", "--port", str(port)]
        hub = self._processes["hub"] = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        assert hub.stdout is not None
        line = hub.stdout.readline()
        if not line.startswith("hub at "):
            assert hub.stderr is not None
            raise LinkLostError(f"no hub at port {port}: {hub.stderr.read().strip()}")
        return line.split()[2].rpartition(":")[2].rstrip(";")

    def _start(self, part: str, *more: str) -> None:
        words = [sys.executable, "-m", "mmrs_auv.vessel", part, "--sheet", str(self._file)]
        words += ["--channel", self.channel, "--clock", "bus", *more]
        self._processes[part] = subprocess.Popen(words, stdin=subprocess.DEVNULL, text=True)


def keep(berths: Mapping[str, Berth], until: float, stopped: list[int]) -> None:
    """Return when the time has come, or something was put into `stopped`.

    Args:
        berths: by robot.
        until: by the monotonic clock.
        stopped: filled by whoever wants an end.

    Raises:
        LinkLostError: a part has ended by itself.
    """
    while not stopped and time.monotonic() < until:
        for robot, berth in berths.items():
            for part, code in berth.ended().items():
                if not stopped:
                    raise LinkLostError(f"'{robot}': {part} has ended with {code}")
        time.sleep(0.1)
