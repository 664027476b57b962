"""Robots in the air: simulated vehicles, and the processes that fly them one way or the other."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import IO

from ports import free_port
from warm_python import python

from fault_table.process import Process
from fault_table.project import Pad, home_of, write_project
from mmrs_core import pipeline
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import ReplayResult, replay
from mmrs_core.languages.reading import read_model
from mmrs_core.plugins import load_plugins
from mmrs_mavlink.sitl import Settings, SimulatedVehicle

GENERATED, INTERPRETED = "generated", "interpreted"
"""What flies robots: their controllers, or `mmrs run`; both run the same engine and driver."""
GROUND_STATION = Path(__file__).parents[2] / "peers" / "ground_station.py"


class Fleet:
    """All robots of a project, each with a vehicle, and the processes that fly them.

    Attributes:
        vehicles: by robot.
        logs: folder of the logs.
        process: the one that was started last.
        station: of people who look on at all vehicles; None: nobody does.
        replies: of all robots to orders that were given to all of them.
    """

    def __init__(
        self,
        folder: Path,
        pads: Sequence[Pad],
        execution: str,
        *,
        speedup: float = 10.0,
        settings: Mapping[str, Mapping[str, object]] | None = None,
        watched: bool = False,
    ) -> None:
        """Write a project, and make what flies it.

        Args:
            folder: for all files.
            pads: robots with their programs and policies.
            execution: `GENERATED` or `INTERPRETED`.
            speedup: seconds of the run in a second.
            settings: of the vehicles, by robot.
            watched: whether somebody looks on, by a ground station of pymavlink's.
        """
        self.folder, self.execution, self.speedup = folder, execution, speedup
        self.logs = folder / "logs"
        self.behaviour = write_project(folder, pads)
        self.vehicles: dict[str, SimulatedVehicle] = {}
        self._links: dict[str, str] = {}
        self._processes: list[Process] = []
        self.station: Process | None = None
        self.replies: list[dict[str, object]] = []
        self._ground = ("127.0.0.1", free_port()) if watched else None
        for index, pad in enumerate(pads):
            port = free_port()
            own = (settings or {}).get(pad.robot, {})
            given = Settings("copter", *home_of(index), ground=self._ground, **own)
            self.vehicles[pad.robot] = SimulatedVehicle(port, given, speedup=speedup)
            self._links[pad.robot] = f"{pad.robot}=udpin:127.0.0.1:{port}"
        if execution == "generated":
            mmrs("generate", str(self.behaviour), "--target", "mavlink-python", "-o", str(folder / "made"))

    def __enter__(self) -> Fleet:
        for vehicle in self.vehicles.values():
            vehicle.start()
        if self._ground is not None:
            self.station = Process([str(GROUND_STATION), str(self._ground[1])], self.folder)
        return self

    def __exit__(self, *error: object) -> None:
        for process in (*self._processes, self.station):
            if process is not None:
                process.close()
        for vehicle in self.vehicles.values():
            vehicle.stop()

    @property
    def process(self) -> Process:
        """Return the process that was started last."""
        return self._processes[-1]

    def start(self, *arguments: str, robot: str = "", into: IO[str] | None = None) -> Process:
        """Start a process for all robots, or for one of them; give it these arguments beside the usual.

        What it says goes to `into`; None: to `Process.said`.
        """
        process = Process(self.command(*arguments, robot=robot), self.folder, into)
        self._processes.append(process)
        return process

    def command(self, *arguments: str, robot: str = "") -> list[str]:
        """Return what Python runs to fly all robots or one, with these arguments beside the usual."""
        chosen = [link for name, link in self._links.items() if robot in ("", name)]
        links = [word for link in chosen for word in ("--connect", link)]
        usual = ["--log", str(self.logs), "--speedup", str(self.speedup)]
        return [*self._program(robot), *links, *usual, *arguments]

    def _program(self, robot: str) -> list[str]:
        if self.execution == "generated":
            return [str(self.folder / "made" / (f"robot_{robot}.py" if robot else "fleet.py"))]
        chosen = ["--robot", robot] if robot else []
        return ["-m", "mmrs_core", "run", str(self.behaviour), "--backend", "mavlink", *chosen]

    def steps(self, robot: str) -> list[dict[str, object]]:
        """Return the steps in a robot's log; a line cut off at the end is left out."""
        return _lines(self.logs / f"{robot}.jsonl")

    def box(self, robot: str) -> list[dict[str, object]]:
        """Return the lines of a robot's black box."""
        return _lines(self.logs / f"{robot}.blackbox.ndjson")

    def replayed(self) -> ReplayResult:
        """Return what a replay of all logs finds; they may end before the run does."""
        contributions = _contributions()
        (behaviour,) = read_model(self.behaviour, contributions.languages).roots
        program = pipeline.program_of(behaviour, contributions)
        return replay(program, read_logs([self.logs], partial=True), partial=True)


@cache
def _contributions():
    return load_plugins().contributions


def _lines(path: Path) -> list[dict[str, object]]:
    if not path.exists():
        return []
    lines = path.read_text("ascii").splitlines(keepends=True)
    return [json.loads(line) for line in lines if line.endswith("\n")]


def mmrs(*arguments: str) -> str:
    """Run a command of ours that must succeed; return what it printed."""
    command = [python(), "-m", "mmrs_core", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, f"{arguments}: {done.stdout}{done.stderr}"
    return done.stdout
