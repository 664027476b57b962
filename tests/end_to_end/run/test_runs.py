"""`mmrs run` as a process: missions, what it says, several processes, and what it refuses."""

import json
import os
import signal
import subprocess
from pathlib import Path

import pytest
from fault_table.project import OUT, TOUR, Pad
from ports import free_endpoint
from real_runs import PATIENCE, SYNCHRONISED, begun, fly_by_hand, judged, landed, least_distance
from warm_python import python

from mmrs_core.cli import run
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("runs")

FULL = Path("/dev/full")


@pytest.fixture
def told(capsys):
    """Return a function that gives robots an `mmrs run` which refuses: its exit code, and its last words."""

    def call(fleet, *arguments, robot=""):
        code = run(fleet.command(*arguments, robot=robot)[2:])
        return code, capsys.readouterr().err.splitlines()[-1]

    return call


@pytest.mark.thorough
def test_robots_of_one_process_wait_for_each_other_and_their_logs_replay(fleet):
    flown = fleet(*SYNCHRONISED, Pad("c", stay=2.0))
    assert flown.start().end(PATIENCE) == 0, flown.process.said
    assert judged(flown) is Outcome.SUCCESS
    assert landed(flown)
    assert all(least_distance(flown.vehicles["c"], place) < 2.0 for place in (OUT, *TOUR))


def test_robots_fly_on_where_nobody_reads_or_what_is_said_cannot_be_written(fleet):
    flown = fleet(Pad("a"))
    reading, writing = os.pipe()
    with os.fdopen(writing, "w") as into:
        process = flown.start(into=into)
    begun(flown, "a", "out")
    os.close(reading)
    process.signal(signal.SIGHUP)
    assert process.end(PATIENCE) == 0
    assert judged(flown) is Outcome.SUCCESS


@pytest.mark.thorough
@pytest.mark.skipif(not FULL.exists(), reason="needs a device that is full")
def test_robots_fly_where_nothing_that_is_said_can_be_written(fleet):
    flown = fleet(Pad("a"))
    with FULL.open("w") as into:
        assert flown.start(into=into).end(PATIENCE) == 0
    assert judged(flown) is Outcome.SUCCESS


def test_a_full_disk_ends_a_robot_by_its_policy_also_where_what_is_said_goes_there(fleet, tmp_path):
    flown = fleet(Pad("a"), speedup=8.0)
    with (tmp_path / "said.txt").open("w") as into:
        process = flown.start("--inject", "disk-full@35+400", into=into)
        assert process.end(PATIENCE) == 1
    moves = {step["move"] for step in flown.steps("a")}
    assert "start" in moves
    assert "stop" not in moves
    assert landed(flown)


def test_robots_of_two_processes_meet_on_the_bus_and_begin_together(fleet):
    flown = fleet(*SYNCHRONISED)
    endpoint = free_endpoint()
    first = flown.start("--bus-listen", endpoint, "--sync", robot="a")
    second = flown.start("--bus-connect", endpoint, "--sync", robot="b")
    assert (first.end(PATIENCE), second.end(PATIENCE)) == (0, 0), first.said + second.said
    assert judged(flown) is Outcome.SUCCESS
    assert any("begins together" in line for line in first.said)
    for robot in "ab":
        (begun,) = [line for line in flown.box(robot) if line.get("what") == "TOGETHER"]
        assert begun["response"] == "begins"
        assert "ms apart, known to" in begun["why"]


def test_nothing_begins_where_robots_of_other_processes_do_not_come(fleet):
    flown = fleet(*SYNCHRONISED)
    listens = ("--bus-listen", free_endpoint())
    process = flown.start(*listens, "--sync", "--sync-patience", "1", robot="a")
    assert process.end(PATIENCE) == 5, process.said
    assert "after 1 s 'b' is not ready; never seen on the bus: 'b'" in process.said[-1]
    assert any("1 of 2 are ready: 'a'; not yet: 'b'" in line for line in process.said)
    assert not any(number == 400 for _, number, _ in flown.vehicles["a"].autopilot.history)
    assert flown.steps("a") == []


def test_a_robot_whose_peers_run_elsewhere_needs_the_bus(fleet, told):
    code, said = told(fleet(*SYNCHRONISED), robot="a")
    assert code == 2
    assert "say --bus" in said


def test_a_vehicle_whose_motors_run_is_not_taken_for_a_new_run(fleet):
    flown = fleet(Pad("a"))
    fly_by_hand(flown.vehicles["a"])
    assert flown.start().end(PATIENCE) == 1
    assert "is armed already" in flown.process.said[-1]
    assert flown.vehicles["a"].autopilot.mode_name == "loiter"
    (step,) = flown.steps("a")
    assert (step["move"], step["label"], step["detail"]) == ("start", "fault", "REFUSED")
    start, decision = [line for line in flown.box("a") if line["kind"] in ("start", "decision")]
    assert (start["kind"], start["vehicle"]) == ("start", "copter")
    assert (decision["what"], decision["response"], decision["move"]) == ("REFUSED", "NOTHING", "start")
    assert "is armed already" in decision["why"]


def test_a_vehicle_that_was_never_heard_is_waited_for_again_in_the_same_folder(fleet):
    flown = fleet(Pad("a"))
    flown.vehicles["a"].stop()
    for again in ((), ("--resume",)):
        assert flown.start("--backend-option", "patience=0.2", *again).end(PATIENCE) == 5
        assert "no vehicle" in flown.process.said[-1]
        assert flown.steps("a") == []
    told = [line["what"] for line in flown.box("a") if line["kind"] == "decision"]
    assert told == ["LINK_LOST", "LINK_LOST"]


def test_a_folder_with_logs_is_not_flown_over(fleet, told):
    flown = fleet(Pad("a"))
    flown.logs.mkdir()
    (flown.logs / "a.jsonl").write_text("", "ascii")
    code, said = told(flown)
    assert code == 2
    assert "already contains logs" in said


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--inject", "foo=1"), "--inject"),
        (("--connect", "a=foo"), "--connect"),
        (("--connect", "b=udpin:127.0.0.1:1"), "--connect"),
        (("--assume", "calm=yes"), "condition 'calm': no Choice uses it; conditions in use: none"),
    ],
)
def test_what_makes_no_sense_is_wrong_usage(fleet, told, words, why):
    flown = fleet(Pad("a"))
    code, said = told(flown, *words)
    assert code == 2, said
    assert why in said
    assert not flown.logs.exists()


def test_a_vehicle_that_is_not_there_is_told_with_its_link(fleet):
    flown = fleet(Pad("a"))
    flown.vehicles["a"].faults.begin("link-down")
    assert flown.start("--backend-option", "patience=1").end(PATIENCE) == 5
    assert "no vehicle at udpin" in flown.process.said[-1]


def test_faults_on_purpose_are_made_and_the_mission_still_flies(fleet):
    flown = fleet(Pad("a", stay=1.0), speedup=10.0)
    process = flown.start("--inject", "loss=0.1,delay=0.02~0.01,seed=7")
    assert process.end(PATIENCE) == 0, process.said[-6:]
    assert judged(flown) is Outcome.SUCCESS
    assert any(line["kind"] == "injected" for line in flown.box("a"))


def test_simulated_robots_run_by_the_same_command(fleet):
    flown = fleet(*SYNCHRONISED)
    command = [python(), "-m", "mmrs_core", "run", str(flown.behaviour), "--backend", "simulation"]
    command += ["--speedup", "100", "--log", str(flown.logs), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["ending"]["outcome"] == "success"
    assert judged(flown) is Outcome.SUCCESS
