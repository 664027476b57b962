"""A simulated vehicle in real time, each part a process, driven by the engine and by generated code."""

import json
import time
from dataclasses import replace
from pathlib import Path

import pytest
from dives import dive, diver, swim
from dives_by_code import SPEED, dive_by_code, interpreted
from mmrs_auv.controllers.connected import ConnectedVehicle
from mmrs_auv.rehearsal import VehicleProcesses
from mmrs_auv.sheets import sheet_of

from auv_vessel.body.surroundings import Surroundings
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import replay
from mmrs_core.simulation.live import run_live
from mmrs_core.testing.programs import use
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("vessels")


def short_dive() -> Program:
    return dive(swim("out", 1.5, 0.0, 1.0, after=(use("ctd", "Sample"),)))


@pytest.fixture
def berth(tmp_path: Path):
    sheet = sheet_of(diver(), "naiad", home=(0.0, 0.0, -0.5))
    with VehicleProcesses(
        sheet, tmp_path / "berth", surroundings=Surroundings(bottom=6.0), speedup=SPEED
    ) as found:
        yield found


def entries_in(folder: Path, kind: str) -> list[dict[str, object]]:
    """Return the entries of a kind in the black box of the vehicle."""
    lines = (folder / "naiad.blackbox.ndjson").read_text(encoding="utf-8").splitlines()
    return [entry for line in lines if (entry := json.loads(line))["kind"] == kind]


def devices_confirm(folder: Path) -> bool:
    """Return whether the black box says that devices on a bus tell when they are done."""
    (start,) = entries_in(folder, "start")
    return start["link"] == "can" and start["confirms"] is True


@pytest.mark.thorough
def test_a_dive_is_carried_out_over_the_bus(berth, contributions, tmp_path):
    live_run = interpreted(short_dive(), berth, contributions, tmp_path)
    with LogWriter(tmp_path / "logs") as writer:
        ending = run_live(replace(live_run, observe=writer.write, sync=writer.sync))
    assert ending.outcome is Outcome.SUCCESS, ending
    assert replay(short_dive(), read_logs([tmp_path / "logs"])).accepted
    assert len(entries_in(tmp_path / "logs", "fix")) > 10
    assert devices_confirm(tmp_path / "logs")
    assert not berth.ended()


@pytest.mark.timeout(120)
def test_a_run_ends_whose_bus_goes_while_its_vehicle_stops(berth, contributions, tmp_path, monkeypatch):
    respond = ConnectedVehicle.respond

    def respond_without_a_bus(robot: ConnectedVehicle, response: str, now: float) -> None:
        respond(robot, response, now)
        berth.close()
        while robot._connection.failure is None:
            time.sleep(0.01)

    monkeypatch.setattr(ConnectedVehicle, "respond", respond_without_a_bus)
    said: list[str] = []
    live_run = interpreted(short_dive(), berth, contributions, tmp_path)

    def observe(step: StepRecord) -> None:
        if (step.label, step.move) == ("begin", "out"):
            live_run.orders.give("stop", ["naiad"])

    run_live(replace(live_run, say=said.append, observe=observe))
    assert [line for line in said if line.startswith("'naiad': not known to have stopped (HOLD): LINK_LOST")]


def test_generated_code_does_the_same(berth, tmp_path):
    dive_by_code(short_dive(), berth, tmp_path)
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
