"""A simulated vehicle in real time, each part a process, driven by the interpreter and by generated code."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path

import pytest
from dives import dive, diver, swim
from mmrs_auv.backend.connected import ConnectedRobot
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.rehearsal import Berth
from mmrs_auv.sheets import sheet_of
from mmrs_auv.targets.can_python.target import CAN_PYTHON
from mmrs_auv.vessel.body.surroundings import Surroundings

from mmrs_core.behaviour.log import LogWriter, read_logs
from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import Outcome, replay
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_core.pipeline import Place, inputs_of
from mmrs_core.runtime.clock import RealClock
from mmrs_core.runtime.live import Venture, run_live
from mmrs_core.runtime.slots import InProcessBus
from mmrs_core.runtime.terms import Ending
from mmrs_core.testing.programs import use
from mmrs_core.transformation.kinds import MOVE_KINDS

SPEED = 0.5
"""Slower than real time, so that a computer with other work does not make the vehicle give up its dive."""


def short_dive() -> Program:
    return dive(swim("out", 1.5, 0.0, 1.0, after=(use("ctd", "Sample"),)))


def written(steps: Generator[StepRecord, None, Ending], writer: LogWriter) -> Ending:
    """Write steps until there are no more; return how the run ended."""
    while True:
        try:
            writer.write(next(steps))
        except StopIteration as over:
            return over.value


@pytest.fixture
def berth(tmp_path: Path):
    sheet = sheet_of(diver(), "naiad", home=(0.0, 0.0, -0.5))
    with Berth(sheet, tmp_path / "berth", surroundings=Surroundings(bottom=6.0), speedup=SPEED) as found:
        yield found


def entries_in(folder: Path, kind: str) -> list[dict[str, object]]:
    """Return the entries of a kind in the black box of the vehicle."""
    lines = (folder / "naiad.blackbox.ndjson").read_text(encoding="utf-8").splitlines()
    return [entry for line in lines if (entry := json.loads(line))["kind"] == kind]


def devices_confirm(folder: Path) -> bool:
    """Return whether the black box says that devices on a bus tell when they are done."""
    (start,) = entries_in(folder, "start")
    return start["link"] == "can" and start["confirms"] is True


def venture_of(berth: Berth, contributions: Contributions, folder: Path) -> Venture:
    """Return a dive of the vehicle by the interpreter."""
    behaviour, place = short_dive(), Place({diver().name: diver()}, (), {})
    return Venture(
        behaviour,
        inputs_of(behaviour, place, contributions, options={"clock": "bus"}),
        InProcessBus(behaviour),
        {},
        clock=RealClock(SPEED),
        folder=folder / "logs",
        links={"naiad": berth.channel},
    )


def test_a_dive_is_carried_out_over_the_bus(berth, contributions, tmp_path):
    venture = venture_of(berth, contributions, tmp_path)
    with LogWriter(tmp_path / "logs") as writer:
        ending = written(run_live(venture, contributions.backends["can"]), writer)
    assert ending.outcome is Outcome.SUCCESS, ending
    assert replay(venture.program, read_logs([tmp_path / "logs"])).accepted
    assert len(entries_in(tmp_path / "logs", "fix")) > 10
    assert devices_confirm(tmp_path / "logs")
    assert not berth.ended()


@pytest.mark.timeout(120)
def test_a_run_ends_whose_bus_goes_while_its_vehicle_stops(berth, contributions, tmp_path, monkeypatch):
    stop = ConnectedRobot.stop

    def stop_without_a_bus(robot: ConnectedRobot, now: float, response: str) -> None:
        stop(robot, now, response)
        berth.close()
        while robot._connection.failure is None:
            time.sleep(0.01)

    monkeypatch.setattr(ConnectedRobot, "stop", stop_without_a_bus)
    said: list[str] = []
    venture = replace(venture_of(berth, contributions, tmp_path), say=said.append)
    for step in run_live(venture, contributions.backends["can"]):
        if (step.label, step.move) == ("begin", "out"):
            venture.orders.give("stop", ["naiad"])
    assert [line for line in said if line.startswith("'naiad': not known to have stopped (HOLD): LINK_LOST")]


def test_generated_code_does_the_same(berth, tmp_path):
    kinds = {kind.metaclass: kind for kind in MOVE_KINDS}
    given = TargetInput(short_dive(), {diver().name: diver()}, {AUV_KIND.metaclass: AUV_KIND}, kinds)
    write(render(CAN_PYTHON, given), tmp_path / "code")
    words = [
        "--can",
        berth.channel,
        "--clock",
        "bus",
        "--speedup",
        str(SPEED),
        "--log",
        str(tmp_path / "logs"),
    ]
    done = subprocess.run(
        [sys.executable, "fleet.py", *words],
        cwd=tmp_path / "code",
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    judged = replay(short_dive(), read_logs([tmp_path / "logs"]))
    assert judged.accepted
    assert devices_confirm(tmp_path / "logs")
    assert judged.outcome is Outcome.SUCCESS
    assert len(entries_in(tmp_path / "logs", "fix")) > 10


def test_a_part_that_ends_is_told(berth):
    berth._processes["movement"].kill()
    until = time.monotonic() + 20.0
    while not berth.ended() and time.monotonic() < until:
        time.sleep(0.05)
    assert list(berth.ended()) == ["movement"]
