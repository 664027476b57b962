"""Logs: those that are read, and those that are refused, each with its cause."""

import json
import re

import pytest
from flight_logs import Sample, dataflash, telemetry
from flown_curves import Curve, flown
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.errors import UnreadableError
from mmrs_mavlink.calibration.reading import flight_in

SQUARE = [(0.0, 0.0, 20.0), (60.0, 0.0, 20.0), (60.0, 60.0, 20.0), (0.0, 60.0, 20.0)]
SAMPLES = list(flown(SQUARE, Curve()))
BIN, TLOG = dataflash(SAMPLES), telemetry(SAMPLES)


@pytest.fixture
def log(tmp_path):
    """Return what writes a log into a file of its own."""

    def write(data: bytes, name: str = "flight.bin"):
        (tmp_path / name).write_bytes(data)
        return tmp_path / name

    return write


@pytest.mark.parametrize("data", [BIN, TLOG], ids=["bin", "tlog"])
def test_logs_of_both_formats_hold_the_flight(data, log):
    flight = flight_in(log(data))
    assert len(flight.times) == len(SAMPLES)
    assert flight.rate == pytest.approx(10.0)
    assert flight.profile is not None
    assert flight.profile.name == "arducopter"
    assert [number for _, number in flight.modes] == [4]
    assert len(flight.targets) >= 2
    moved = flight.places[-1] - flight.places[0]
    assert moved.tolist() == pytest.approx([0.0, 60.0, 0.0], abs=0.3)
    fastest = max(SAMPLES, key=lambda each: each.velocity[0])
    assert flight.velocities[:, 0].max() == pytest.approx(fastest.velocity[0], abs=0.01)
    assert flight.damages == ()


def test_an_item_that_was_reached_ends_a_leg_though_the_next_one_is_told_later(log):
    """A PX4 says where it goes up to a second later over all links but one."""
    at_once, late = (flight_in(log(telemetry(SAMPLES, late=each), "flight.tlog")) for each in (0.0, 0.8))
    assert len(at_once.targets) >= 2
    assert late.targets == at_once.targets


@pytest.mark.parametrize(
    ("firmware", "profile"),
    [("ArduRover V4.6.0", "ardurover"), ("ArduSub V4.5.1", "ardusub"), ("ArduPlane V4.6.0", None)],
)
def test_the_firmware_names_the_profile(firmware, profile, log):
    found = flight_in(log(dataflash(SAMPLES, firmware))).profile
    assert (found.name if found else None) == profile


def black_box(*more) -> bytes:
    """Return a black box of the flight that holds further entries."""
    head = {"run": "r", "robot": "Alba"}
    start = head | {"time": 0.0, "kind": "start", "vehicle": "copter", "firmware": "ARDUPILOTMEGA"}
    lines = [start, *(head | each for each in more)]
    for each in SAMPLES[::2]:
        east, north, up = each.place
        place = {"latitude": 42.37 + north / 111_081.0, "longitude": 13.35 + east / 82_379.0, "height": up}
        speed = sum(part**2 for part in each.velocity) ** 0.5
        lines.append(
            head
            | {"time": each.time, "kind": "fix", "place": place, "speed": speed, "heading": each.heading}
            | {"energy": 0.9, "mode": "guided", "armed": True}
        )
    return "\n".join([*map(json.dumps, lines), ""]).encode()


def test_a_black_box_holds_the_flight(log):
    flight = flight_in(log(black_box(), "Alba.blackbox.ndjson"))
    assert len(flight.times) == len(SAMPLES[::2])
    assert flight.velocities[:, 0].max() == pytest.approx(8.0, rel=0.02)
    assert [number for _, number in flight.modes] == [4]


def test_a_black_box_whose_vehicle_had_another_clock_than_the_run_is_refused(log):
    box = log(black_box({"time": 11.0, "kind": "clock", "rate": 4.98}), "Alba.blackbox.ndjson")
    with pytest.raises(
        UnreadableError, match=f"^{re.escape(str(box))}: its times are .* ran 5 times as fast"
    ):
        flight_in(box)


@pytest.mark.parametrize(
    ("data", "cause"),
    [
        (b"", "empty"),
        (b"ULog\x01\x12\x35" + bytes(100), r"log of PX4 \(.ulg\), which is not read"),
        (b"FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n", "log as text"),
        (b"\x1f\x8b\x08" + bytes(50), "compressed"),
        (b"<?xml version='1.0'?>", "byte 0: not the beginning of a log"),
        (bytes(10_000), "byte 0: not the beginning of a log"),
        (BIN[:3000], r"\d+ positions, too few"),
        (TLOG[:300], r"\d positions, too few"),
        (b"\xa3\x95" + bytes(500), "no positions"),
    ],
)
def test_what_holds_no_flight_is_refused_with_file_and_cause(data, cause, log):
    path = log(data)
    with pytest.raises(UnreadableError, match=f"^{re.escape(str(path))}: .*({cause})"):
        flight_in(path)


def test_folders_and_missing_files_are_refused(tmp_path):
    with pytest.raises(UnreadableError, match="not a file"):
        flight_in(tmp_path)
    with pytest.raises(UnreadableError, match="no such file"):
        flight_in(tmp_path / "none.bin")


@pytest.mark.parametrize("data", [BIN, TLOG], ids=["bin", "tlog"])
def test_a_log_that_is_cut_is_read_up_to_there(data, log):
    path = log(data[: len(data) * 3 // 4 + 5])
    flight = flight_in(path)
    assert len(flight.times) == pytest.approx(0.75 * len(SAMPLES), rel=0.05)
    assert re.match(rf"{re.escape(str(path))}: ends within the message at byte \d+", flight.damages[0])


@pytest.mark.parametrize("data", [BIN, TLOG], ids=["bin", "tlog"])
def test_garbage_in_the_middle_is_counted_and_skipped(data, log):
    middle = len(data) // 2
    flight = flight_in(log(data[:middle] + bytes(777) + data[middle:]))
    assert len(flight.times) >= len(SAMPLES) - 8
    assert "hold no message, the first at byte" in flight.damages[0]


def test_a_format_without_a_length_holds_up_nothing(log):
    hostile = bytearray(BIN)
    hostile[4 + 89] = 0  # the length of the second format
    with pytest.raises(UnreadableError, match="no positions"):
        flight_in(log(bytes(hostile)))


def test_positions_before_the_first_fix_do_not_count(log):
    before = telemetry(
        [Sample(n / 10.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)) for n in range(80)], origin=(0.0, 0.0)
    )
    flight = flight_in(log(before + TLOG))
    assert flight.times[0] == pytest.approx(SAMPLES[0].time)


def test_of_several_vehicles_one_is_chosen(log):
    both = log(TLOG + telemetry(SAMPLES[:100], system=7))
    with pytest.raises(UnreadableError, match="several vehicles: choose one by --system: 1, 7"):
        flight_in(both)
    assert len(flight_in(both, 7).times) == 100
    with pytest.raises(UnreadableError, match="no vehicle with system 3; known are 1, 7"):
        flight_in(both, 3)


def test_of_a_vehicle_that_restarted_the_longest_flight_counts(log):
    flight = flight_in(log(telemetry(SAMPLES[:150]) + TLOG))
    assert len(flight.times) == len(SAMPLES)
    assert "the vehicle restarted" in flight.damages[0]


def test_impossible_samples_are_left_out(log):
    wild = Sample(SAMPLES[100].time + 0.05, (1e9, 0.0, 0.0), (float("inf"), 1e30, 0.0))
    flight = flight_in(log(dataflash([*SAMPLES[:101], wild, *SAMPLES[101:]])))
    assert len(flight.times) == len(SAMPLES)


@pytest.mark.parametrize("data", [BIN, TLOG], ids=["bin", "tlog"])
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow], deadline=None)
@given(changes=st.lists(st.tuples(st.floats(0.0, 1.0), st.binary(min_size=1, max_size=40)), max_size=12))
def test_damaged_logs_are_read_or_refused_and_nothing_else(data, log, changes):
    damaged = bytearray(data[: len(data) // 4])
    for part, other in changes:
        begin = int(part * len(damaged))
        damaged[begin : begin + len(other)] = other
    try:
        flight = flight_in(log(bytes(damaged)))
    except UnreadableError:
        return
    assert (flight.times[1:] > flight.times[:-1]).all()
