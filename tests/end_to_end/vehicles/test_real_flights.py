"""The harness of flights on real firmware, with a stand-in for the firmware that is ours."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from example_flight.fleets import PEERS
from firmware import ARDUCOPTER, FIRMWARES, Fix
from flown_times.comparison import compared
from real_flights.flight import Begun
from real_flights.flying import write_track
from real_flights.judging import distances
from real_flights.plans import ROVER_AUTO
from real_flights.table import FLIGHTS

HARNESS = Path(__file__).parents[3] / "benchmarks" / "real_flights.py"


def fly(*arguments, **binaries):
    names = {f"{each.variable}{end}" for each in FIRMWARES for end in ("", "_PARAMETERS")}
    environment = {name: value for name, value in os.environ.items() if name not in names}
    return subprocess.run(
        [sys.executable, str(HARNESS), *arguments],
        env=environment | binaries,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )


def stand_in(folder, ends_after=1000):
    binary = folder / "arducopter"
    command = f'timeout {ends_after} "{sys.executable}" "{PEERS}/arducopter_stand_in.py"'
    binary.write_text(f'#!/bin/sh\nexec {command} "$@"\n')
    binary.chmod(0o755)
    return {ARDUCOPTER.variable: str(binary)}


def test_without_a_binary_it_names_the_variables():
    done = fly()
    assert done.returncode == 2
    assert all(each.variable in done.stderr for each in FIRMWARES)


def test_without_a_binary_for_any_of_its_flights_nothing_went_as_declared(tmp_path):
    done = fly("rover: legs", **stand_in(tmp_path))
    assert done.returncode == 2
    assert done.stdout.endswith("not flown: rover: legs: set MMRS_ARDUROVER\n")


def test_an_unknown_flight_is_a_usage_error():
    done = fly("copter: nowhere")
    assert (done.returncode, done.stdout) == (2, "")
    assert "copter: nowhere" in done.stderr


@pytest.mark.thorough
@pytest.mark.real_time("faults")
def test_a_flight_as_declared_is_measured_and_kept(tmp_path):
    kept = ("--speedup", "8", "--keep", str(tmp_path / "kept"))
    done = fly("copter: legs", "rover: legs", *kept, **stand_in(tmp_path))
    assert done.returncode == 0, done.stdout + done.stderr
    assert "| copter: legs | run | " in done.stdout
    assert "not flown: rover: legs: set MMRS_ARDUROVER" in done.stdout
    assert (tmp_path / "kept" / "copter-legs" / "Alba.track.csv.gz").exists()


@pytest.mark.thorough
@pytest.mark.real_time("faults")
def test_a_flight_that_does_not_end_as_declared_is_told_by_the_exit_code(tmp_path):
    done = fly("copter: legs", "--speedup", "8", **stand_in(tmp_path, ends_after=8))
    assert done.returncode == 1
    assert "NO: " in done.stdout


def test_distances_are_those_to_the_nearest_leg():
    line = [(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 10.0, 0.0)]
    rows = np.array([(5.0, 2.0, 1.0), (13.0, 5.0, 4.0), (-3.0, -4.0, 0.0)])
    assert distances(rows, line, plane=True).tolist() == pytest.approx([2.0, 3.0, 5.0])
    assert distances(rows, line, plane=False).tolist() == pytest.approx([5.0**0.5, 5.0, 5.0])


@pytest.mark.parametrize("completes", [True, False])
def test_the_mission_of_a_rover_that_stays_armed_is_over_once_it_is_complete(tmp_path, completes):
    flight = next(each for each in FLIGHTS if each.name == "rover: plan in AUTO")
    flight.models(tmp_path)
    driven = [
        Fix(t, 42.35, 13.39, 630.0, 0.0, 0.0, 0.0, 0.0, 0.0, True, ROVER_AUTO, 1 + t // 16) for t in range(96)
    ]
    waiting = [driven[-1]._replace(t=t, seq=7 if completes else 6) for t in range(96, 200)]
    write_track(tmp_path / "Badger.track.csv.gz", [*driven, *waiting])
    (found,) = compared(tmp_path)
    assert (found.whole, found.flown == 95.0) == (completes, completes)


def test_names_of_flights_are_unique_and_happenings_wait_for_something():
    assert len({flight.name for flight in FLIGHTS}) == len(FLIGHTS)
    for flight in FLIGHTS:
        assert not flight.happens or isinstance(flight.happens[0][0], Begun), flight.name
