"""Dives by what the processes of a vehicle's eyes tell: it approaches, faces and chooses by what is seen."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from math import dist
from pathlib import Path

import pytest
from dives import dive, diver, swim
from dives_by_code import SPEED, dive_by_code, interpreted
from mmrs_auv.rehearsal import VehicleProcesses
from mmrs_auv.sheets import sheet_of
from ports import free_port

from auv_vessel.body.surroundings import BUOY, Surroundings, Thing, to_json
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Heading, Move, MoveTarget, Program, Transition
from mmrs_core.behaviour.replay import replay
from mmrs_core.simulation.live import run_live
from mmrs_core.testing.programs import feedback, move
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.semantics import Outcome

pytestmark = [pytest.mark.real_time("vessels"), pytest.mark.thorough]

AROUND = Surroundings(
    bottom=5.0,
    things=(
        Thing(BUOY, "red buoy", 0.6, 4.3, 1.6, colour="red", size=0.3),
        Thing(BUOY, "green buoy", -9.0, -9.0, 1.6, colour="green", size=0.3),
    ),
)
STAND_OFF = 1.5


def looking() -> Program:
    """Return a dive to a buoy that is not quite where it is expected, and to what is chosen there."""
    target = MoveTarget((4.0, 0.0, -1.5), "red buoy", 1.5)
    near = swim("near", 0.0, 0.0, 0.0, target=target, heading=Heading(target), distance=STAND_OFF)
    ways = {
        1: Transition(1, 2, condition="detected:red buoy", otherwise=4),
        2: Transition(2, 4, condition="detected:green buoy", otherwise=3),
    }
    return dive(near, told("red"), told("no green"), told("wrong"), transitions=ways)


def told(name: str) -> Move:
    return replace(move(name, "HoldPosition", duration=0.1), before=(feedback(name),))


@contextmanager
def eyes(folder: Path, berth: VehicleProcesses, port: int) -> Iterator[None]:
    """Run all three processes, whose memory is called after the folder."""
    file = folder / "surroundings.json"
    file.write_text(to_json(AROUND), encoding="utf-8")
    words = ["--sheet", str(folder / "berth/sheet.json"), "--surroundings", str(file)]
    words += ["--memory", f"seeing-{os.getpid()}", "--channel", berth.channel, "--to", f"127.0.0.1:{port}"]
    parts = [
        subprocess.Popen([sys.executable, "-m", "auv_vision", part, *words])
        for part in ("frames", "front", "bottom")
    ]
    try:
        yield
    finally:
        for part in parts:
            part.send_signal(signal.SIGTERM)
        assert [part.wait(30.0) for part in parts] == [0, 0, 0]


@pytest.fixture
def seen(tmp_path: Path) -> Iterator[tuple[VehicleProcesses, int]]:
    """Return a vehicle, and the port at which its eyes tell what they see."""
    port = free_port()
    sheet = sheet_of(diver(), "naiad", home=(0.0, 0.0, -0.5))
    with ExitStack() as stack:
        berth = stack.enter_context(
            VehicleProcesses(sheet, tmp_path / "berth", surroundings=AROUND, seed=5, speedup=SPEED)
        )
        stack.enter_context(eyes(tmp_path, berth, port))
        yield berth, port


def judge(folder: Path) -> None:
    """Check that a log is one of the dive, that the choices were right, and where the vehicle then was."""
    found = replay(looking(), read_logs([folder]))
    assert found.accepted, found.complaints
    assert found.outcome is Outcome.SUCCESS
    assert [each.detail for each in read_logs([folder]) if each.label == "choose"] == ["true", "false"]
    lines = (folder / "naiad.blackbox.ndjson").read_text(encoding="utf-8").splitlines()
    last = [entry["place"] for entry in map(json.loads, lines) if entry["kind"] == "fix"][-1]
    (buoy, _) = AROUND.things
    here = (last["north"], last["east"], -last["height"])
    assert dist(here, (buoy.north, buoy.east, buoy.depth)) == pytest.approx(STAND_OFF, abs=0.6)


def test_the_interpreter_goes_and_chooses_by_what_three_processes_see(seen, contributions, tmp_path):
    berth, port = seen
    live_run = interpreted(looking(), berth, contributions, tmp_path, detections=str(port))
    with LogWriter(tmp_path / "logs") as writer:
        run_live(replace(live_run, observe=writer.write, sync=writer.sync))
    judge(tmp_path / "logs")


def test_generated_code_goes_and_chooses_by_what_three_processes_see(seen, tmp_path):
    berth, port = seen
    dive_by_code(looking(), berth, tmp_path, "--detections", str(port))
    judge(tmp_path / "logs")
