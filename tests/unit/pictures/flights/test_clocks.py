"""Robots of separate processes are laid over each other by the time of day."""

import json
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from mmrs_core.pictures.flights.gathering import read_flight

NOON = datetime(2026, 6, 1, 12, 0, tzinfo=UTC)


def begin(folder, robot, after, pace=1.0, process=""):
    """Have a robot's black box say that its process began so many seconds of the run after noon."""
    path = folder / f"{robot}.blackbox.ndjson"
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    for line in lines:
        of_day = NOON + timedelta(seconds=(line["time"] + after) / pace)
        line["wall"] = of_day.isoformat(timespec="milliseconds").replace("+00:00", "Z")
        line |= {"process": process} if line["kind"] == "start" else {}
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))


@pytest.fixture
def flight(folder, behaviour, types):
    return lambda: read_flight((folder,), behaviour, types)


def last(flown):
    return float(flown.track.times[-1])


@pytest.mark.parametrize("pace", [1.0, 5.0])
def test_a_process_that_began_later_has_the_times_of_the_first(flight, folder, pace):
    before = flight().robots
    begin(folder, "alpha", 0.0, pace)
    begin(folder, "beta", 7.3, pace)
    read = flight()
    assert last(read.robots["beta"]) == pytest.approx(last(before["beta"]) + 7.3, abs=0.02)
    later = [each.time for each in before["beta"].records]
    assert [each.time - 7.3 for each in read.robots["beta"].records] == pytest.approx(later, abs=0.02)
    assert np.allclose(read.robots["alpha"].track.times, before["alpha"].track.times, atol=0.001)
    (note,) = read.damages
    assert note.startswith(f"beta: its process began {7.3 / pace:.1f} s after that of alpha")


def test_robots_of_one_process_are_left_as_they_are(flight, folder):
    for robot in ("alpha", "beta"):
        begin(folder, robot, 0.0)
    assert flight().damages == ()


@pytest.mark.parametrize(("names", "moved"), [(("one", "one"), 0), (("one", "other"), 1), (("", ""), 1)])
def test_however_fast_a_run_was_robots_that_name_one_process_have_one_clock(flight, folder, names, moved):
    """A dry run takes a second or two: what is written a little late there is late by minutes of the run."""
    for robot, process, after in zip(("alpha", "beta"), names, (0.0, 40.0), strict=True):
        begin(folder, robot, after, 500.0, process)
    assert len(flight().damages) == moved


def test_how_fast_a_run_was_is_known_of_short_ones_too(flight, folder):
    """Else what is late because it comes late in the run would be taken for a process that began late."""
    pace = last(flight().robots["alpha"]) / 0.5
    for robot in ("alpha", "beta"):
        begin(folder, robot, 0.0, pace)
    box = folder / "beta.blackbox.ndjson"
    lines = box.read_text().splitlines(keepends=True)
    box.write_text("".join([lines[0], *lines[len(lines) // 2 :]]))
    assert flight().damages == ()


def test_times_of_day_that_cannot_be_read_move_nothing(flight, folder):
    begin(folder, "alpha", 0.0)
    box = folder / "alpha.blackbox.ndjson"
    box.write_text(box.read_text().replace("2026-06-01T", "soon "))
    begin(folder, "beta", 3.0)
    assert flight().damages == ()


def test_a_robot_whose_process_was_started_again_alone_is_left_and_that_is_told(flight, folder):
    begin(folder, "alpha", 0.0)
    begin(folder, "beta", 5.0)
    box = folder / "beta.blackbox.ndjson"
    lines = box.read_text().splitlines(keepends=True)
    box.write_text("".join([*lines, lines[0], *lines[-3:]]))
    (note,) = [each for each in flight().damages if "was restarted" in each]
    assert note.startswith("beta: was restarted differently from alpha")


def test_what_is_noted_before_a_vehicle_is_known_is_of_the_same_process(flight, folder):
    for robot in ("alpha", "beta"):
        begin(folder, robot, 0.0)
    box = folder / "beta.blackbox.ndjson"
    first, second, *rest = box.read_text().splitlines(keepends=True)
    box.write_text("".join([second, first, *rest]))
    assert flight().damages == ()


def test_the_time_of_day_at_which_a_flight_began_is_that_of_its_first_process(flight, folder):
    assert flight().zero is None
    begin(folder, "alpha", 4.0)
    begin(folder, "beta", 1.5)
    assert flight().zero == pytest.approx(NOON.timestamp() + 1.5, abs=0.002)
