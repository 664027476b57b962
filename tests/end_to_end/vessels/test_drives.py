"""A vehicle whose drives are the generated ones in C, as a program on its bus."""

import subprocess
import time
from itertools import pairwise
from pathlib import Path

import pytest
from c_drives import need_compiler, written
from patience import wait_for
from sample_vessels import pool_sheet
from vessel_processes import Boat, boat

from auv_vessel.control import failsafe

pytestmark = pytest.mark.real_time("vessels")

BUSY = 0.6
"""Seconds that this machine may make everything late: other tests run beside."""


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> Path:
    need_compiler()
    made = written(pool_sheet(), tmp_path_factory.mktemp("drives"))
    subprocess.run(["make", "-C", str(made)], check=True, capture_output=True, timeout=120)
    return made / "drives"


def goes(vehicle: Boat, north: float, depth: float) -> None:
    """Wait until the vehicle knows where it is; send it there."""
    assert wait_for(lambda: vehicle.craft.state().trusted, 30)
    vehicle.craft.go_to(north, 0.0, depth)


@pytest.mark.thorough
def test_a_dive_is_made_with_them(drives: Path, tmp_path: Path) -> None:
    with boat(pool_sheet(), tmp_path, drives) as vehicle:
        goes(vehicle, 0.6, 0.6)
        assert wait_for(lambda: vehicle.craft.state().progress == "REACHED", 60)
        assert vehicle.craft.state().depth == pytest.approx(0.6, abs=0.15)
        assert vehicle.craft.state().emergency is None
        says = [said for _, said in vehicle.ear.said("Thruster") if said.name.endswith("Status")]
        sequences = [said.sequence for said in says if said.name == "Thruster0Status"]
        assert {(after - before) % 256 for before, after in pairwise(sequences)} == {1}

        vehicle.craft.go_to(20.0, 0.0, 0.6)
        begun = time.monotonic()
        assert wait_for(lambda: vehicle.ear.last_thrust(begun) > begun + 1.0, 20)
        killed = vehicle.kill("actuators")
        time.sleep(pool_sheet().watchdog + failsafe.MARGIN + BUSY + 0.5)
        assert (
            0.0 < vehicle.ear.last_thrust(killed) - killed <= pool_sheet().watchdog + failsafe.MARGIN + BUSY
        )
        last = [said for _, said in vehicle.ear.said("Thruster")][-6:]
        assert {said.values["Drive"] for said in last} <= {"WATCHDOG", "OFF"}
