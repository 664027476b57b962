"""`mmrs run --resume` goes on where a run was broken off."""

import signal
from math import dist

import pytest
from fault_table.project import OUT, TOUR, Pad, home_of
from patience import wait_for
from real_runs import (
    AT_HOME,
    HOLDING,
    PATIENCE,
    SYNCHRONISED,
    TAKE_OFF,
    UNHURRIED,
    begun,
    fly_by_hand,
    judged,
    landed,
    least_distance,
    ordered,
)

from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("runs")

STAYS = ("LINK_LOST", "HOLD", 5.0)
"""Has a vehicle be in the air still when its run is resumed, however long that takes on a busy machine."""


def broken_off(flown, **moves):
    """Kill a run once its robots have begun these moves; nobody hears `b` from then on."""
    killed = flown.start()
    for robot, move in moves.items():
        begun(flown, robot, move)
    killed.signal(signal.SIGKILL)
    killed.end(PATIENCE)
    flown.vehicles["b"].faults.begin("link-down")


@pytest.mark.thorough
def test_a_battery_that_was_not_changed_is_not_flown_with_by_a_new_process_either(fleet):
    flown = fleet(Pad("a", policies=(("BATTERY_LOW", "RETURN", None),)))
    process = flown.start()
    vehicle = begun(flown, "a", "tour 1")
    vehicle.faults.begin("battery", 0.15)
    assert process.end(PATIENCE) == 1, process.said
    assert any("came home for its battery" in line for line in process.said), process.said
    take_offs = sum(number == TAKE_OFF for _, number, _ in vehicle.autopilot.history)
    again = flown.start("--resume")
    assert again.end(PATIENCE) == 1, again.said
    assert any("its battery is still at 1" in line for line in again.said), again.said
    assert sum(number == TAKE_OFF for _, number, _ in vehicle.autopilot.history) == take_offs


@pytest.mark.parametrize("move", [pytest.param("out", marks=pytest.mark.thorough), "tour 0"])
def test_a_killed_run_is_resumed_where_its_log_ends(fleet, move):
    flown = fleet(
        Pad("a", stay=2.0), *(Pad(p.robot + "2", p.program, (), 8.0, p.gives and "a2") for p in SYNCHRONISED)
    )
    killed = flown.start()
    begun(flown, "a", move)
    killed.signal(signal.SIGKILL)
    killed.end(PATIENCE)
    resumed = flown.start("--resume")
    assert resumed.end(PATIENCE) == 0, resumed.said
    assert judged(flown) is Outcome.SUCCESS
    assert landed(flown)


def test_a_robot_in_the_air_obeys_before_another_is_heard_that_then_goes_on_too(fleet):
    flown = fleet(Pad("a", policies=(STAYS,)), Pad("b", stay=2.0), speedup=UNHURRIED)
    broken_off(flown, a="out", b="out")
    resumed = flown.start("--resume", "--backend-option", "patience=120")
    vehicle = flown.vehicles["a"].autopilot
    assert wait_for(lambda: any("waits for a vehicle" in line for line in resumed.said), PATIENCE)
    assert ordered(flown, "hold")["confirmed"], resumed.said
    assert wait_for(lambda: vehicle.mode == HOLDING, PATIENCE), resumed.said
    landing = ordered(flown, "land")
    assert landing["confirmed"]
    assert landing["seconds"] < 1.0
    assert wait_for(lambda: not vehicle.armed, PATIENCE)
    flown.vehicles["b"].faults.end("link-down")
    assert resumed.end(PATIENCE) == 130, resumed.said
    assert flown.steps("b")[-1]["move"] == "stop"
    assert judged(flown) is Outcome.FAILED


@pytest.mark.thorough
def test_a_robot_in_the_air_comes_home_by_its_policy_where_another_is_never_heard_again(fleet):
    flown = fleet(
        Pad("a", "wait", (STAYS, ("PEER_LOST", "RETURN", 2.0))), Pad("b", "give", stay=100.0, gives="a")
    )
    broken_off(flown, a="out", b="stay")
    before = flown.steps("b")
    resumed = flown.start("--resume", "--backend-option", "patience=3")
    assert resumed.end(PATIENCE) == 5, resumed.said
    assert any("'b': does not get ready" in line for line in resumed.said)
    assert flown.steps("a")[-1]["detail"] == "PEER_LOST"
    vehicle = flown.vehicles["a"].autopilot
    assert not vehicle.armed
    assert vehicle.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)
    assert flown.steps("b") == before


def test_a_changed_battery_lets_a_run_go_on_where_it_stopped(fleet):
    flown = fleet(Pad("a", stay=2.0, policies=(("BATTERY_LOW", "RETURN", None),)))
    first = flown.start()
    vehicle = begun(flown, "a", "tour 1")
    vehicle.faults.begin("battery", 0.15)
    assert first.end(PATIENCE) == 1, first.said
    assert not any("internal error" in line for line in first.said)
    assert "fault" not in {step["label"] for step in flown.steps("a")}
    assert not vehicle.autopilot.armed
    assert vehicle.autopilot.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)
    vehicle.faults.begin("battery", 1.0)
    before = len(vehicle.autopilot.track)
    second = flown.start("--resume")
    assert second.end(PATIENCE) == 0, second.said
    assert any(line.startswith("'a': continues with ") for line in second.said)
    assert any(line.get("what") == "resume" for line in flown.box("a"))
    assert judged(flown) is Outcome.SUCCESS
    again = vehicle.autopilot.track[before:]
    assert min(dist((n, e), TOUR[0][:2]) for _, n, e, _ in again) < 2.0
    assert all(least_distance(vehicle, place) < 2.0 for place in (OUT, *TOUR))


@pytest.mark.parametrize(
    ("system", "why"),
    [pytest.param(7, "was system 1", marks=pytest.mark.thorough), (1, "a pilot may have it")],
)
def test_a_vehicle_that_is_not_the_robots_is_not_touched_by_a_resumed_run(fleet, system, why):
    flown = fleet(Pad("a"))
    killed = flown.start()
    own = begun(flown, "a", "out")
    killed.signal(signal.SIGKILL)
    killed.end(PATIENCE)
    own.stop()
    latitude, longitude = home_of(0)
    settings = Settings("copter", latitude, longitude, system)
    with SimulatedVehicle(int(flown._links["a"].rpartition(":")[2]), settings, speedup=10.0) as other:
        fly_by_hand(other)
        before = dict(other.autopilot.parameters), len(other.autopilot.stores[0])
        resumed = flown.start("--resume")
        assert resumed.end(PATIENCE) == 1, resumed.said
        assert why in resumed.said[-1]
        assert (dict(other.autopilot.parameters), len(other.autopilot.stores[0])) == before
        assert other.autopilot.mode_name == "loiter"
