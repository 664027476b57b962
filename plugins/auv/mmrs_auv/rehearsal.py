"""Simulated vehicles in real time: the bus, body and control layer of each, as processes of their own."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from types import TracebackType

from auv_vessel.body.befalling import NoSuchFaultError, befalling
from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.surroundings import to_json as surroundings_json
from auv_vessel.sheet import Sheet, to_json
from auv_vessel.wire.hub import Troubles
from mmrs_core.cli.typed import obeyed
from mmrs_core.errors import LinkLostError

PARTS = ("vehicle", "sensors", "actuators", "movement")
END_SECONDS = 10.0
"""Real seconds that processes have to end."""
BUS_FAULTS = "cut, loss SHARE, delay SECONDS, corruption SHARE, and clear bus"


class VehicleProcesses:
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
            own = ("--surroundings", str(around), "--seed", str(seed), "--speedup", str(speedup), "--faults")
            self._start("vehicle", *own)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> VehicleProcesses:
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

    def befall(self, words: Sequence[str]) -> None:
        """Let a fault befall the vehicle or its bus, or end one.

        Args:
            words: as `befalling` takes them; or ``cut``, ``loss SHARE``, ``delay SECONDS`` and ``corruption
                SHARE`` of the bus, which ``clear bus`` ends; or ``status``, which the vehicle answers.

        Raises:
            ValueError: there is no such fault.
        """
        match words:
            case ["cut"]:
                self._tell("hub", "cut")
            case ["clear", "bus"]:
                self._tell("hub", "clear")
            case ["loss" | "delay" | "corruption" as what, amount]:
                Troubles(**{what: _number(amount)})
                self._tell("hub", " ".join(words))
            case ["status"]:
                self._tell("vehicle", "status")
            case _:
                try:
                    befalling(self._sheet, words)
                except NoSuchFaultError as error:
                    raise ValueError(f"{error}; of the bus {BUS_FAULTS}") from error
                self._tell("vehicle", " ".join(words))

    def close(self) -> None:
        """End all of it; the hub once no process sends on it any more."""
        hub = self._processes.get("hub")
        parts = [process for process in self._processes.values() if process is not hub]
        for group in (parts, [] if hub is None else [hub]):
            for process in group:
                process.terminate()
            for process in group:
                try:
                    process.communicate(timeout=END_SECONDS)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.communicate()

    def _tell(self, part: str, line: str) -> None:
        stdin = self._processes[part].stdin
        assert stdin is not None
        with suppress(BrokenPipeError):  # that it has ended is told anyway
            stdin.write(f"{line}\n")
            stdin.flush()

    def _hub(self, port: int) -> str:
        words = [sys.executable, "-m", "mmrs_core", "can", "hub", "--simulated-time", "--port", str(port)]
        hub = self._processes["hub"] = _begun(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert hub.stdout is not None
        line = hub.stdout.readline()
        if not line.startswith("hub at "):
            assert hub.stderr is not None
            last = hub.stderr.read().strip().rpartition("\n")[2]
            raise LinkLostError(last.removeprefix("mmrs: ") or f"no hub at port {port}")
        return line.split()[2].rpartition(":")[2].rstrip(";")

    def _start(self, part: str, *more: str) -> None:
        words = [sys.executable, "-m", "auv_vessel", part, "--sheet", str(self._file)]
        words += ["--channel", self.channel, "--clock", "bus", *more]
        self._processes[part] = _begun(words)


def _begun(
    words: Sequence[str], stdout: int | None = None, stderr: int | None = None
) -> subprocess.Popen[str]:
    """Return a process that receives no interrupt of the terminal, since it ends after others."""
    return subprocess.Popen(
        words, stdin=subprocess.PIPE, stdout=stdout, stderr=stderr, text=True, start_new_session=True
    )


def keep(
    fleet: Mapping[str, VehicleProcesses], until: float, stopped: list[int], lines: SimpleQueue[str]
) -> None:
    """Return when the time has come, something was put into `stopped`, or a line says ``quit``.

    Args:
        fleet: by robot.
        until: by the monotonic clock.
        stopped: filled to end the rehearsal.
        lines: that are typed: ``ROBOT FAULT``, ``all FAULT``, ``ROBOT clear FAULT``, ``status``.

    Raises:
        LinkLostError: a part has ended on its own.
    """
    while not stopped and time.monotonic() < until:
        for robot, processes in fleet.items():
            for part, code in processes.ended().items():
                if not stopped:
                    raise LinkLostError(f"'{robot}': {part} has ended with {code}")
        if obeyed(lines, list(fleet), lambda robot, words: fleet[robot].befall(words), "status"):
            return
        time.sleep(0.1)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{text} is not a number") from None
