"""A vehicle as processes on a hub, in real time: it goes, and stops when a part or the bus fails."""

import time
from pathlib import Path

import pytest
from patience import wait_for
from sample_vessels import pool_sheet
from vessel_processes import Boat, boat

from auv_vessel.control import failsafe

pytestmark = pytest.mark.real_time("vessels")

WATCHDOG = 0.5
BUSY = 0.6
"""Seconds that this machine may make everything late: other tests run beside."""


def under_way(vehicle: Boat) -> None:
    assert wait_for(lambda: vehicle.craft.state().trusted, 30)
    vehicle.craft.go_to(30.0, 0.0, 1.5)
    begun = time.monotonic()
    assert wait_for(lambda: vehicle.ear.last_thrust(begun) > begun, 20)
    assert wait_for(lambda: vehicle.craft.state().depth > 0.6, 30)


@pytest.mark.parametrize(
    ("part", "declared"),
    [
        ("movement", failsafe.COMMANDS_SILENT),
        pytest.param("actuators", WATCHDOG, marks=pytest.mark.thorough),
        pytest.param("sensors", failsafe.STATE_SILENT, marks=pytest.mark.thorough),
    ],
)
def test_no_thrust_in_time_when_a_part_is_killed_and_the_vehicle_comes_up(
    part: str, declared: float, tmp_path: Path
) -> None:
    with boat(pool_sheet(), tmp_path) as vehicle:
        under_way(vehicle)
        killed = vehicle.kill(part)
        time.sleep(declared + failsafe.MARGIN + BUSY + 1.0)
        assert vehicle.ear.last_thrust(killed) - killed <= declared + failsafe.MARGIN + BUSY
        if part != "sensors":
            deepest = vehicle.craft.state().depth
            assert wait_for(lambda: vehicle.craft.state().depth < deepest - 0.1, 40)


def test_no_thrust_in_time_when_the_bus_is_cut(tmp_path: Path) -> None:
    """Nobody hears anything meanwhile; the drives tell afterwards that their watchdogs stopped them.

    On a slow computer the sensor controller has given up the dive by then, and they are off.
    """
    with boat(pool_sheet(), tmp_path) as vehicle:
        under_way(vehicle)
        vehicle.kill("actuators")
        vehicle.order("cut")
        time.sleep(WATCHDOG + failsafe.MARGIN + BUSY)
        vehicle.order("clear")
        mended = time.monotonic()
        assert wait_for(lambda: len(vehicle.ear.said("Thruster", mended)) >= 6, 5)
        drives = [said for _, said in vehicle.ear.said("Thruster", mended)]
        assert {said.values["Drive"] for said in drives} <= {"WATCHDOG", "OFF"}
        assert {said.values["Thrust"] for said in drives} == {0.0}


@pytest.mark.thorough
def test_it_arrives_though_frames_are_lost_late_and_wrong(tmp_path: Path) -> None:
    with boat(pool_sheet(), tmp_path) as vehicle:
        for trouble in ("loss 0.05", "delay 0.01", "corruption 0.05"):
            vehicle.order(trouble)
        assert wait_for(lambda: vehicle.craft.state().trusted, 30)
        goal = vehicle.craft.go_to(1.5, 0.5, 1.0)
        assert wait_for(
            lambda: vehicle.craft.state().goal == goal and vehicle.craft.state().progress == "REACHED", 60
        )
        assert vehicle.craft.state().emergency is None
        assert sum(vehicle.ear.codec.faults.values()) > 0
