"""Programs that land away from home and go on from there, with another battery or in another process."""

import json
import re
import signal
import subprocess
from math import hypot

import pytest
from fault_table.fleet import GENERATED, Fleet
from fault_table.project import LATITUDE, LONGITUDE, OUT, Pad
from patience import wait_for
from warm_python import python

from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("runs")

PATIENCE = 60.0
SPEEDUP = 30.0
PERCHED = Pad("a", "perch", stay=40.0)
LANDS_WITHIN = 0.8
"""Metres beside its place within which a vehicle lands: as far as it goes beyond it."""

BEYOND = 5.0
"""Metres beyond the perch, eastwards, from which on the second sortie has begun its leg."""


@pytest.fixture
def flown(tmp_path):
    """Return a robot that lands on its way, and its vehicle."""
    with Fleet(tmp_path, [PERCHED], GENERATED, speedup=SPEEDUP) as fleet:
        yield fleet


def resume(fleet) -> dict[str, object]:
    """Order the robot to go on; return its answer."""
    command = [python(), "-m", "mmrs_core", "control", "resume", "--log", str(fleet.logs), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    (reply,) = json.loads(done.stdout)["robots"]
    return reply


def carry(vehicle, north: float, east: float) -> None:
    with vehicle.lock:
        vehicle.autopilot.body.position = (north, east, 0.0)


def perched(fleet):
    """Wait until the robot has landed on its way; return its vehicle."""
    vehicle = fleet.vehicles["a"]
    assert wait_for(lambda: any(step["move"] == "stay" for step in fleet.steps("a")), PATIENCE)
    assert wait_for(lambda: not vehicle.autopilot.armed, PATIENCE)
    return vehicle


def change_battery(vehicle) -> None:
    """Switch the vehicle off, and on with a full battery."""
    vehicle.faults.begin("battery", 1.0)
    vehicle.faults.begin("restart")


def ended_well(fleet) -> bool:
    result = fleet.replayed()
    return result.complaints == () and result.outcome is Outcome.SUCCESS


def sorties(vehicle) -> list[float]:
    """Return how far from home each take-off was, metres."""
    track, gaps = vehicle.autopilot.track, []
    for before, after in zip([None, *track], track, strict=False):
        if after[3] > 0.5 and (before is None or before[3] <= 0.5):
            gaps.append(hypot(*after[1:3]))
    return gaps


def test_a_new_battery_where_the_program_landed_is_flown_on_with(flown):
    process = flown.start("--battery-patience", "600")
    vehicle = perched(flown)
    perch = vehicle.autopilot.body.position
    place = ", ".join(f"{degrees:.6f}" for degrees in vehicle.autopilot.degrees())
    change_battery(vehicle)
    assert wait_for(lambda: vehicle.autopilot.body.position[1] > BEYOND, PATIENCE), process.said
    assert vehicle.autopilot.home[:2] == pytest.approx((LATITUDE, LONGITUDE), abs=1e-5)
    vehicle.faults.begin("battery", 0.15)
    came = "came down for its battery where its sortie began, away from home; change it"
    assert wait_for(lambda: any(came in line for line in process.said), PATIENCE), process.said
    change_battery(vehicle)
    carry(vehicle, 0.0, 0.0)
    there = rf"it stands {hypot(*perch[:2]):.0f} m from where its program has landed it: carry it to {place}"
    assert wait_for(lambda: re.fullmatch(there, str(resume(flown)["why"])), PATIENCE), process.said
    carry(vehicle, OUT[0], OUT[1])
    assert wait_for(lambda: resume(flown)["confirmed"], PATIENCE), process.said
    assert process.end(PATIENCE) == 0, process.said
    assert sorties(vehicle) == pytest.approx([0.0, 30.0, 30.0], abs=LANDS_WITHIN)
    assert vehicle.autopilot.home[:2] == pytest.approx((LATITUDE, LONGITUDE), abs=1e-5)
    assert ended_well(flown)


def test_a_killed_run_goes_on_where_its_program_landed_also_with_a_new_battery(flown):
    killed = flown.start()
    vehicle = perched(flown)
    killed.signal(signal.SIGKILL)
    killed.end(PATIENCE)
    change_battery(vehicle)
    carry(vehicle, 0.0, 0.0)
    refused = flown.start("--resume")
    assert refused.end(PATIENCE) == 1, refused.said
    there = r"the vehicle is 30 m from where its program has landed it: carry it to 42\.3702\d\d, 13\.350000"
    assert re.search(there, "".join(refused.said))
    carry(vehicle, OUT[0], OUT[1])
    resumed = flown.start("--resume")
    assert resumed.end(PATIENCE) == 0, resumed.said
    assert sorties(vehicle) == pytest.approx([0.0, 30.0], abs=LANDS_WITHIN)
    assert vehicle.autopilot.home[:2] == pytest.approx((LATITUDE, LONGITUDE), abs=1e-5)
    assert ended_well(flown)
