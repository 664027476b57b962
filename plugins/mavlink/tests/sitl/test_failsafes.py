"""Failsafes of an ArduPilot, as its parameters configure them."""

import pytest
from simulated import Bench

from mmrs_mavlink.sitl.commands import steer

PLACES = {"copter": (30.0, 0.0, 12.0), "rover": (5.0, 0.0, 0.0), "sub": (5.0, 0.0, -5.0)}


def out(kind: str = "copter", **parameters: float) -> Bench:
    """Return a vehicle away from home, in GUIDED."""
    bench, place = Bench(kind=kind, parameters=parameters), PLACES[kind]
    if bench.pilot.flies:
        bench.fly_up(place[2])
    else:
        bench.mode("guided")
        bench.command(400, 1)
    steer(bench.pilot, place, None)
    near = bench.pilot.parameters.get("WP_RADIUS", 0.1)
    assert bench.wait_for(lambda: bench.pilot.body.distance_to(place) < near)
    return bench


def without_link(bench: Bench, seconds: float = 12.0) -> str:
    """Return the mode after that time without a heartbeat."""
    bench.wait_for(lambda: False, seconds, heard=False)
    return bench.pilot.mode_name


@pytest.mark.parametrize(
    ("kind", "parameters", "mode"),
    [
        ("copter", {"FS_GCS_ENABLE": 0}, "guided"),
        ("copter", {"FS_GCS_ENABLE": 1}, "return"),
        ("copter", {"FS_GCS_ENABLE": 3}, "smart_return"),
        ("copter", {"FS_GCS_ENABLE": 4}, "smart_return"),
        ("copter", {"FS_GCS_ENABLE": 5}, "land"),
        ("copter", {"FS_GCS_ENABLE": 7}, "hold"),
        ("rover", {"FS_GCS_ENABLE": 0, "FS_ACTION": 1}, "guided"),
        ("rover", {"FS_GCS_ENABLE": 1, "FS_ACTION": 1}, "return"),
        ("rover", {"FS_GCS_ENABLE": 1, "FS_ACTION": 2}, "hold"),
        ("rover", {"FS_GCS_ENABLE": 1, "FS_ACTION": 0}, "guided"),
        ("rover", {"FS_GCS_ENABLE": 1, "FS_ACTION": 6}, "loiter"),
        ("sub", {"FS_GCS_ENABLE": 1}, "guided"),
        ("sub", {"FS_GCS_ENABLE": 3}, "depth_hold"),
        ("sub", {"FS_GCS_ENABLE": 4}, "surface"),
    ],
)
def test_a_lost_link_is_answered_as_configured(kind, parameters, mode):
    assert without_link(out(kind, **parameters)) == mode


def test_a_submarine_disarms_if_so_configured():
    bench = out("sub", FS_GCS_ENABLE=2)
    without_link(bench)
    assert not bench.pilot.armed


@pytest.mark.parametrize(("parameter", "link_timeout"), [(20.0, 0.0), (5.0, 20.0)])
def test_the_link_failsafe_waits_for_its_timeout_and_for_that_of_the_network(parameter, link_timeout):
    bench = out(FS_GCS_ENABLE=5, FS_GCS_TIMEOUT=parameter)
    bench.pilot.link_timeout = link_timeout
    assert without_link(bench, 19.0) == "guided"
    assert without_link(bench, 2.0) == "land"


def test_a_restored_link_changes_no_mode():
    bench = out(FS_GCS_ENABLE=7)
    without_link(bench)
    bench.wait(2.0)
    assert bench.pilot.mode_name == "hold"
    assert bench.last_text == "GCS Failsafe Cleared"


def test_a_ground_station_that_was_never_connected_is_not_missed():
    bench = out(FS_GCS_ENABLE=1)
    bench.pilot.last_heartbeat = None
    assert without_link(bench) == "guided"


@pytest.mark.parametrize(
    ("kind", "action", "mode"),
    [
        ("copter", 0, "guided"),
        ("copter", 1, "land"),
        ("copter", 2, "return"),
        ("copter", 3, "smart_return"),
        ("rover", 1, "return"),
        ("rover", 2, "hold"),
        ("sub", 3, "surface"),
    ],
)
def test_a_low_battery_is_answered_after_its_timer(kind, action, mode):
    bench = out(kind, BATT_FS_LOW_ACT=action, BATT_LOW_MAH=1500.0, BATT_LOW_VOLT=0.0)
    bench.pilot.battery.level = 0.29
    bench.wait(9.0)
    assert bench.pilot.mode_name == "guided"
    bench.wait(2.0)
    assert bench.pilot.mode_name == mode
    assert any(text.startswith("Battery 1 is low") for _, _, text in bench.pilot.said)


@pytest.mark.parametrize(("action", "mode"), [(0, "guided"), (1, "return"), (2, "land"), (4, "hold")])
def test_a_breached_fence_is_answered_as_configured(action, mode):
    bench = out(FENCE_ENABLE=1, FENCE_ACTION=action, FENCE_RADIUS=50.0)
    steer(bench.pilot, (60.0, 0.0, 12.0), None)
    assert bench.wait_for(lambda: bench.pilot.breached, 20.0)
    assert bench.pilot.mode_name == mode


def test_a_disabled_fence_is_ignored():
    bench = out(FENCE_RADIUS=40.0)
    steer(bench.pilot, (50.0, 0.0, 12.0), None)
    bench.wait(15.0)
    assert not bench.pilot.breached


@pytest.mark.parametrize(("enabled", "breached"), [(7, True), (4, False)])
def test_a_fence_of_polygons_only_has_no_ceiling(enabled, breached):
    bench = out(FENCE_ENABLE=1, FENCE_TYPE=enabled, FENCE_ACTION=0)
    steer(bench.pilot, (0.0, 0.0, 110.0), None)
    bench.wait(60.0)
    assert bench.pilot.breached == breached


@pytest.mark.parametrize(("action", "mode"), [(0, "guided"), (1, "land"), (2, "altitude_hold")])
def test_a_lost_position_is_answered_as_soon_as_by_arducopter(action, mode):
    bench = out(FS_EKF_ACTION=action)
    bench.pilot.located = False
    bench.wait(3.2)
    assert bench.pilot.mode_name == "guided"
    bench.wait(0.3)
    assert bench.pilot.mode_name == mode


@pytest.mark.parametrize(
    ("kind", "parameters", "modes"),
    [
        ("copter", {"FS_GCS_ENABLE": 3}, {"smart_return"}),
        ("rover", {"FS_GCS_ENABLE": 1, "FS_ACTION": 3}, {"smart_return"}),
        ("sub", {"FS_GCS_ENABLE": 4}, {"surface"}),
    ],
)
def test_a_killed_process_is_noticed_as_soon_as_by_real_vehicles(kind, parameters, modes):
    """Controllers of ArduCopter, ArduRover and ArduSub 4.7-dev were killed: answered after 9 to 11 s."""
    bench = out(kind, FS_GCS_TIMEOUT=10.0, **parameters)
    assert without_link(bench, 9.0) == "guided"
    assert without_link(bench, 3.0) in modes
