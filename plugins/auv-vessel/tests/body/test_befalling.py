from dataclasses import replace
from queue import SimpleQueue

import pytest
from sample_vessels import pool_sheet

from auv_vessel.body.befalling import Befallen, befalling, status_of
from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.wire.codec import Codec

SHEET = pool_sheet()


@pytest.fixture
def vehicle() -> Vehicle:
    return Vehicle(SHEET, Codec(SHEET), Surroundings(noise=False), place=(1.0, 2.0, 3.0))


def befall(vehicle: Vehicle, line: str) -> str:
    befalling(SHEET, line.split())(vehicle)
    return status_of(SHEET, vehicle)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("thruster-dead T3", "thruster T3 dead"),
        ("thruster-dead 2", "thruster T3 dead"),
        ("frozen Pressure", "Pressure frozen"),
        ("silent Attitude", "Attitude silent"),
        ("noisy Rates 50", "Rates noisy"),
        ("leak", "leak"),
    ],
)
def test_what_is_typed_befalls_the_vehicle_until_it_is_mended(vehicle, line, told):
    sound = status_of(SHEET, vehicle)
    assert befall(vehicle, line) == f"{sound}; {told}"
    fault, *rest = line.split()
    assert befall(vehicle, " ".join(("clear", fault, *rest[:1]))) == sound


@pytest.mark.parametrize("line", ["thruster-dead rear port", "thruster-dead 'rear port'"])
def test_a_thruster_may_have_a_name_of_several_words(vehicle, line):
    thrusters = (replace(SHEET.thrusters[0], id="rear port"), *SHEET.thrusters[1:])
    sheet = replace(SHEET, thrusters=thrusters)
    befalling(sheet, line.split())(vehicle)
    assert status_of(sheet, vehicle).endswith("; thruster rear port dead")
    befalling(sheet, f"clear {line}".split())(vehicle)
    assert not vehicle.faults.dead


def test_a_battery_is_as_full_as_is_typed(vehicle):
    assert "battery 20%" in befall(vehicle, "battery 0.2")
    assert vehicle.charge == pytest.approx(0.2 * SHEET.battery)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("", "no such fault"),
        ("flood", "flood: no such fault; known are thruster-dead THRUSTER"),
        ("leak now", "no such fault"),
        ("clear battery", "no such fault"),
        ("thruster-dead 6", "6: no such thruster; there are T1, T2"),
        ("thruster-dead -1", "-1: no such thruster"),
        ("thruster-dead rear port", "rear port: no such thruster"),
        ("frozen Depth", "Depth: no instrument's message; there are Pressure"),
        ("battery nan", "nan is not a number from 0 to 1"),
        ("battery 1.1", "1.1 is not a number"),
        ("noisy Rates much", "much is not a number"),
    ],
)
def test_what_cannot_befall_a_vehicle_is_said(line, said):
    with pytest.raises(ValueError, match=said):
        befalling(SHEET, line.split())


def test_lines_count_at_the_next_tick(vehicle):
    said: list[str] = []
    lines: SimpleQueue[str] = SimpleQueue()
    node = Befallen(SHEET, vehicle, lines, said.append)
    for line in ("leak\n", "\n", "nonsense\n", "status\n"):
        lines.put(line)
    frames = node.tick(0.0)
    heard = [Codec(SHEET).decode(frame) for frame in frames]
    health = next(each for each in heard if each is not None and each.name == "Health")
    assert health.values["Leak"] is True
    assert said[0].startswith("nonsense: no such fault")
    assert said[1:] == [
        "pool-auv: 0.0 s, 1.0 m north, 2.0 m east, 3.0 m down, thrust 0.0 N, battery 100%; leak"
    ]
