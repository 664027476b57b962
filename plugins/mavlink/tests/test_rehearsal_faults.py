"""Faults on a schedule, and by typed lines."""

import pytest

from mmrs_mavlink.commands.rehearsal import Schedule, ScheduledFault, obey, scheduled
from mmrs_mavlink.sitl import Settings, SimulatedVehicle


@pytest.fixture
def vehicle():
    vehicle = SimulatedVehicle(9, Settings(ready=0.1))
    yield vehicle
    vehicle.stop()


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("gps-lost", ScheduledFault("", "gps-lost", ())),
        ("all:gps-lost@5", ScheduledFault("", "gps-lost", (), 5.0)),
        ("Drone1:gps-lost@60+20", ScheduledFault("Drone1", "gps-lost", (), 60.0, 20.0)),
        ("battery=0.2@7.5", ScheduledFault("", "battery", ("0.2",), 7.5)),
        ("A:position-shift=3,90@1+2", ScheduledFault("A", "position-shift", ("3", "90"), 1.0, 2.0)),
        ("west: A@1:gps-lost@5", ScheduledFault("west: A@1", "gps-lost", (), 5.0)),
    ],
)
def test_a_fault_names_robot_values_begin_and_duration(text, fault):
    assert scheduled(text) == fault


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("gps", "known are gps-lost"),
        ("gps-lost@soon", "not "),
        ("gps-lost@", "not "),
        ("restart@5+2", "one-shot"),
        ("", "not "),
    ],
)
def test_a_malformed_fault_is_refused(text, complaint):
    with pytest.raises(ValueError, match=complaint):
        scheduled(text)


def test_time_counts_from_the_first_arming_with_which_the_track_begins(vehicle):
    schedule = Schedule(vehicle, [scheduled("gps-lost@10+5")])
    happened = []
    for second in range(40):
        vehicle.autopilot.time = float(second)
        if second == 12:
            vehicle.autopilot.track.append((12.0, 0.0, 0.0, 0.0))
        happened += [(second, event) for event in schedule.advance()]
    assert happened == [(22, "gps-lost begins"), (27, "gps-lost ends")]
    assert vehicle.autopilot.located


def test_words_inject_and_clear_faults(vehicle):
    obey(vehicle, ("obstacle", "4"))
    assert vehicle.autopilot.obstacle == 4.0
    obey(vehicle, ("clear", "obstacle"))
    assert vehicle.autopilot.obstacle is None


@pytest.mark.parametrize("words", [("gps",), ("clear", "gps"), ("clear",)])
def test_an_unknown_fault_is_refused(vehicle, words):
    with pytest.raises(ValueError, match="unknown fault"):
        obey(vehicle, words)


def test_a_fault_without_a_time_begins_at_once(vehicle):
    assert Schedule(vehicle, [scheduled("wind=5,270")]).advance() == ("wind 5 270 begins",)
    assert vehicle.autopilot.wind == (5.0, 270.0)


def test_a_long_fault_is_refused_before_it_is_read():
    with pytest.raises(ValueError, match=r"not \[ROBOT:\]FAULT"):
        scheduled("a:" * 10_000 + "!")
