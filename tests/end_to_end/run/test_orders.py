"""`mmrs run` as a process obeys orders and interrupts."""

import json
import signal
import subprocess
import time

import pytest
from fault_table.project import Pad
from patience import wait_for
from real_runs import AT_HOME, HOLDING, PATIENCE, UNHURRIED, begun, judged, landed, ordered
from stalls import Stalls
from warm_python import python

from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("runs")


def control(fleet, order):
    """Give an order to all robots by `mmrs control`; return its answer by robot."""
    command = [python(), "-m", "mmrs_core", "control", order, "--log", str(fleet.logs), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    assert done.stdout, done.stderr
    return {reply["robot"]: reply for reply in json.loads(done.stdout)["robots"]}


def test_orders_are_obeyed_and_confirmed_by_the_vehicles(fleet):
    stalls = Stalls()
    flown = fleet(Pad("a", stay=60.0), Pad("b", stay=60.0), speedup=UNHURRIED)
    process = flown.start()
    vehicle, other = begun(flown, "a", "out"), begun(flown, "b", "out")
    held = control(flown, "hold")
    assert all(reply["confirmed"] for reply in held.values()), held
    assert all(reply["seconds"] < 1.0 + stalls.seconds for reply in held.values()), held
    assert (vehicle.autopilot.mode, other.autopilot.mode) == (HOLDING, HOLDING)
    assert wait_for(lambda: vehicle.autopilot.body.pace < 0.1, PATIENCE)
    place = vehicle.autopilot.body.position
    time.sleep(1.0)
    assert vehicle.autopilot.body.position == pytest.approx(place, abs=0.3)
    assert ordered(flown, "resume")["confirmed"]
    begun(flown, "a", "stay")
    landing = ordered(flown, "land", "b")
    assert landing["confirmed"]
    assert landing["seconds"] < 1.0 + stalls.seconds
    assert wait_for(lambda: not other.autopilot.armed, PATIENCE)
    assert ordered(flown, "return")["confirmed"]
    assert process.end(PATIENCE) == 130, process.said
    assert vehicle.autopilot.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)
    assert {s["detail"] for r in "ab" for s in flown.steps(r) if s["label"] == "fault"} == {"ORDERED"}
    assert judged(flown) is Outcome.FAILED


@pytest.mark.thorough
def test_a_vehicle_that_hears_nothing_confirms_nothing(fleet):
    flown = fleet(Pad("a"))
    process = flown.start()
    vehicle = begun(flown, "a", "out")
    vehicle.faults.begin("link-down")
    assert not ordered(flown, "return", seconds=1.0)["confirmed"]
    assert process.end(PATIENCE) == 5, process.said


@pytest.mark.thorough
def test_a_robot_whose_link_comes_back_is_heard_again_and_lands_where_it_is_told_to(fleet):
    flown = fleet(Pad("a", policies=(("LINK_LOST", "RETURN", 5.0),)), speedup=8.0)
    process = flown.start()
    vehicle = begun(flown, "a", "tour 1")
    vehicle.faults.begin("link-down")
    assert wait_for(lambda: any(s["detail"] == "LINK_LOST" for s in flown.steps("a")), PATIENCE)
    assert ordered(flown, "land")["why"] == "its link is lost"
    vehicle.faults.end("link-down")
    assert wait_for(lambda: any("is heard again" in line for line in process.said), PATIENCE)
    assert ordered(flown, "hold")["confirmed"]
    assert vehicle.autopilot.mode == HOLDING
    assert ordered(flown, "land")["confirmed"]
    assert process.end(PATIENCE) == 5, process.said
    assert landed(flown)


def test_a_hold_before_the_vehicles_speak_keeps_them_on_the_ground(fleet):
    flown = fleet(Pad("a"))
    flown.vehicles["a"].faults.begin("link-down")
    process = flown.start()
    assert wait_for(lambda: any("waits for a vehicle" in line for line in process.said), PATIENCE)
    assert not ordered(flown, "hold", seconds=0.5)["confirmed"]
    assert ordered(flown, "status")["phase"] == "is held before it begins"
    flown.vehicles["a"].faults.end("link-down")
    assert ordered(flown, "hold")["confirmed"]
    time.sleep(1.0)
    assert not flown.vehicles["a"].autopilot.armed
    assert ordered(flown, "land")["confirmed"]
    assert process.end(PATIENCE) == 130, process.said
    assert not any(number == 400 for _, number, _ in flown.vehicles["a"].autopilot.history)


def test_an_interrupt_stops_every_robot_and_each_confirms(fleet):
    flown = fleet(Pad("a"), Pad("b", "wait"), Pad("g", "give", stay=100.0, gives="b"))
    process = flown.start()
    begun(flown, "a", "tour 0")
    process.signal(signal.SIGINT)
    assert process.end(PATIENCE) == 130, process.said
    assert all(vehicle.autopilot.mode == HOLDING for vehicle in flown.vehicles.values())
    assert {f"'{robot}': has done HOLD" for robot in "abg"} <= set(process.said)
    assert judged(flown) is Outcome.FAILED


@pytest.mark.thorough
def test_a_return_that_is_held_is_watched_until_it_goes_on(fleet):
    flown = fleet(Pad("a"), speedup=UNHURRIED)
    process = flown.start()
    vehicle = begun(flown, "a", "tour 1").autopilot
    assert ordered(flown, "return")["confirmed"]
    assert ordered(flown, "hold")["confirmed"]
    assert wait_for(lambda: "'a': has done HOLD" in process.said, PATIENCE)
    time.sleep(1.0)
    assert process.running()
    assert vehicle.mode == HOLDING
    assert ordered(flown, "resume")["confirmed"]
    assert process.end(PATIENCE) == 130, process.said
    assert vehicle.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)
