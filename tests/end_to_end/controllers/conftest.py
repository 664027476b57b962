"""Generated controllers as processes, and simulated vehicles for them."""

import json
import subprocess
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType

import pytest
from mmrs_multicopter.testing import target_input
from patience import until
from ports import free_port
from warm_python import python

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import ReplayResult, replay
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.sitl import Settings, SimulatedVehicle

PATIENCE = 60.0


class Controllers:
    """A folder of generated controllers, and what can be done with it."""

    def __init__(self, folder: Path, program, types=None, files=None, **options) -> None:
        self.folder = folder
        self.program = program
        self.logs = folder / "logs"
        write(files or render(MAVLINK_PYTHON, target_input(program, types), **options), folder)

    def start(self, script: str, *arguments: str) -> subprocess.Popen[str]:
        command = [python(), "-W", "error", str(self.folder / script), *arguments]
        return subprocess.Popen(
            command, cwd=self.folder, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def run(self, script: str, *arguments: str, patience: float = PATIENCE) -> tuple[int, str]:
        """Run a script to its end; return its exit code and what it said."""
        with self.start(script, *arguments) as process:
            try:
                _, said = process.communicate(timeout=patience)
            except subprocess.TimeoutExpired:
                process.kill()
                _, said = process.communicate()
                pytest.fail(f"{script} does not end; it said:\n{said}")
        return process.returncode, said

    def box(self, robot: str, *kinds: str) -> list[dict]:
        """Return the lines of a robot's black box, those of some kinds only if any are named."""
        text = (self.logs / f"{robot}.blackbox.ndjson").read_text("ascii")
        lines = map(json.loads, text.splitlines())
        return [line for line in lines if not kinds or line["kind"] in kinds]

    def steps(self, robot: str) -> list[dict]:
        """Return the lines of a robot's log."""
        return list(map(json.loads, (self.logs / f"{robot}.jsonl").read_text("ascii").splitlines()))

    def await_step(self, move: str, label: str = "begin", robot: str = "alpha") -> None:
        """Wait until a robot's log tells of a step of a move."""
        path, step = self.logs / f"{robot}.jsonl", f'"label":"{label}","move":"{move}"'
        until(lambda: path.exists() and step in path.read_text("ascii"), PATIENCE)

    def replayed(self, *, partial: bool = False) -> ReplayResult:
        return replay(self.program, read_logs([self.logs]), partial=partial)


@pytest.fixture(scope="session")
def new_controllers():
    """Return a function that makes controllers in a folder."""
    return Controllers


@pytest.fixture
def controllers(tmp_path):
    """Return a function that makes controllers in a folder of this test."""
    return lambda program, **options: Controllers(tmp_path / "controllers", program, **options)


@contextmanager
def _open_hangar():
    """Give a function that switches on a vehicle at each robot's home, and returns the links to them."""
    vehicles: list[SimulatedVehicle] = []

    def switch_on(program, speedup: float = 30.0, types=MappingProxyType({}), **settings):
        links, found = ["--speedup", str(speedup)], {}
        settings.setdefault("recharge", 60.0)
        for robot in program.robots:
            latitude, longitude = (42.37, 13.35)
            if not program.frame.is_local:
                ((latitude, longitude),) = degrees_of([robot.home[:2]], program.frame)
            port = free_port()
            kind = context_of(robot, target_input(program, types.values())).profile.rehearsed_as
            given = Settings(kind, latitude, longitude, **settings)
            vehicle = SimulatedVehicle(port, given, speedup=speedup)
            vehicle.start()
            vehicles.append(vehicle)
            found[robot.id] = vehicle
            links += ["--connect", f"{robot.id}=udpin:127.0.0.1:{port}@{given.system}"]
        return found, links

    try:
        yield switch_on
    finally:
        for vehicle in vehicles:
            vehicle.stop()


@pytest.fixture(scope="session")
def new_hangar():
    """Return a context manager for vehicles."""
    return _open_hangar


@pytest.fixture
def hangar():
    """Return a function that switches on vehicles for this test, and gives the links to them."""
    with _open_hangar() as switch_on:
        yield switch_on
