"""Vehicles that fall silent in the middle of an exchange, and vehicles that do not what they are ordered.

Both executions share what does this; each is flown all the same in the thorough profile.
"""

import time
from contextlib import ExitStack

import pytest
from fault_table.fleet import GENERATED, Fleet
from fault_table.project import Pad
from patience import wait_for
from stalls import Stalls

from mmrs_runtime.orders.ordering import give

pytestmark = pytest.mark.real_time("faults")

PATIENCE = 60.0
SPEEDUP = 10.0
MISSION_COUNT = "MISSION_COUNT"


@pytest.fixture
def fly(tmp_path):
    """Return a function that switches a vehicle on, and starts what flies it."""
    with ExitStack() as stack:

        def start(*policies, speedup: float = SPEEDUP, **settings):
            pads = (Pad("a", policies=policies, stay=60.0),)
            fleet = stack.enter_context(
                Fleet(tmp_path, pads, GENERATED, speedup=speedup, settings={"a": settings})
            )
            fleet.start()
            return fleet, fleet.vehicles["a"]

        yield start


def uploading(vehicle) -> bool:
    return any(kind == MISSION_COUNT for _, kind in vehicle.received)


def test_a_vehicle_that_is_silent_during_an_upload_is_waited_for_as_the_policy_says(fly):
    """Three and a half seconds of silence are more than all tries take."""
    fleet, vehicle = fly(("LINK_LOST", "HOLD", 60.0))
    assert wait_for(lambda: uploading(vehicle), PATIENCE), fleet.process.said
    vehicle.faults.begin("link-down")
    time.sleep(3.5)
    assert fleet.process.running(), fleet.process.said
    vehicle.faults.end("link-down")
    assert wait_for(lambda: vehicle.autopilot.airborne, PATIENCE), fleet.process.said


def test_a_vehicle_that_stays_silent_during_an_upload_is_lost_when_the_policy_says(fly):
    fleet, vehicle = fly(("LINK_LOST", "HOLD", 25.0))
    assert wait_for(lambda: uploading(vehicle), PATIENCE), fleet.process.said
    vehicle.faults.begin("link-down")
    begun = time.monotonic()
    assert fleet.process.end(PATIENCE) == 5, fleet.process.said
    assert time.monotonic() - begun > 24.0 / SPEEDUP
    assert any("the vehicle has been silent for 2" in line for line in fleet.process.said), fleet.process.said


def deafen(vehicle) -> None:
    """Have a vehicle heed no set-points any more, but answer everything else."""
    taken = vehicle._take

    def take(message) -> None:
        if message.get_type() != "SET_POSITION_TARGET_GLOBAL_INT":
            taken(message)

    vehicle._take = take


def drift_home(vehicle) -> None:
    """Have something drive a vehicle two metres towards its home, at what a gust may do."""
    with vehicle.lock:
        body = vehicle.autopilot.body
        north, east, up = body.position
        body.target, body.speed = (north - 2.0, east, up), 0.6


def test_a_vehicle_that_is_driven_home_but_does_not_obey_confirms_no_return(fly):
    fleet, vehicle = fly(speedup=4.0)
    assert wait_for(lambda: any(step["move"] == "stay" for step in fleet.steps("a")), PATIENCE)
    deafen(vehicle)
    before = vehicle.autopilot.body.position[0]
    drift_home(vehicle)
    (reply,) = give(fleet.logs, "return", seconds=4.0)
    assert not reply["confirmed"], reply
    assert vehicle.autopilot.body.position[0] < before - 1.0


@pytest.mark.thorough
def test_a_vehicle_that_obeys_confirms_a_return_within_a_second(fly):
    fleet, vehicle = fly(speedup=1.0)
    assert wait_for(lambda: vehicle.autopilot.airborne and vehicle.autopilot.body.position[2] > 5.0, PATIENCE)
    stalls = Stalls()
    (reply,) = give(fleet.logs, "return", seconds=4.0)
    assert reply["confirmed"], reply
    assert reply["seconds"] < 1.0 + stalls.seconds


def test_a_vehicle_that_does_nothing_about_its_link_is_told_the_response_once_it_is_heard_again(fly):
    fleet, vehicle = fly(("LINK_LOST", "LAND", 5.0))
    assert wait_for(lambda: any(step["move"] == "stay" for step in fleet.steps("a")), PATIENCE)
    with vehicle.lock:
        vehicle.autopilot.parameters["FS_GCS_ENABLE"] = 0.0
    vehicle.radio.mute = True
    assert wait_for(lambda: any("LINK_LOST" in line for line in fleet.process.said), PATIENCE)
    time.sleep(10.0 / SPEEDUP)
    assert vehicle.autopilot.mode_name == "guided"
    vehicle.radio.mute = False
    assert fleet.process.end(PATIENCE) == 5, fleet.process.said
    assert not vehicle.autopilot.armed, fleet.process.said
    assert vehicle.autopilot.mode_name == "land"


def test_lost_telemetry_is_answered_as_soon_as_by_arducopter(fly):
    """ArduCopter 4.7-dev retraced its path 20 s after its telemetry alone was lost, for a policy of 10 s."""
    fleet, vehicle = fly(("LINK_LOST", "RETURN", 10.0), speedup=4.0)
    assert wait_for(lambda: any(step["move"] == "stay" for step in fleet.steps("a")), PATIENCE)
    began, modes = vehicle.autopilot.time, len(vehicle.autopilot.modes)
    vehicle.radio.mute = True
    assert wait_for(lambda: len(vehicle.autopilot.modes) > modes, PATIENCE), fleet.process.said
    answered, _ = vehicle.autopilot.modes[modes]
    assert vehicle.autopilot.mode_name == "smart_return"
    assert answered - began == pytest.approx(20.0, abs=2.0)
