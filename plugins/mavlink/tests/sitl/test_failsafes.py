"""What the vehicle answers by itself, as its parameters say."""

from __future__ import annotations

import pytest
from simulated import Bench

from mmrs_mavlink.sitl.commands import steer


def out(place=(30.0, 0.0, 12.0), **settings) -> Bench:
    bench = Bench(**settings)
    if bench.pilot.flies:
        bench.fly_up(place[2])
    else:
        bench.mode("guided")
        bench.command(400, 1)
    steer(bench.pilot, place, None)
    assert bench.wait_for(
        lambda: bench.pilot.body.distance_to(place) < bench.pilot.parameters.get("WP_RADIUS", 0.1)
    )
    return bench


def silent(bench: Bench, seconds: float = 12.0) -> str:
    """Return the mode after the ground was not heard for a while."""
    bench.wait_for(lambda: False, seconds, heard=False)
    return bench.pilot.mode_name


@pytest.mark.parametrize(
    ("enabled", "mode"),
    [(0, "guided"), (1, "return"), (3, "smart_return"), (4, "smart_return"), (5, "land"), (7, "brake")],
)
def test_a_copter_answers_a_silent_ground_station_as_it_is_set_up(enabled, mode):
    assert silent(out(parameters={"FS_GCS_ENABLE": enabled})) == mode


def test_it_waits_for_as_long_as_it_is_set_up_to():
    bench = out(parameters={"FS_GCS_ENABLE": 5, "FS_GCS_TIMEOUT": 20.0})
    assert silent(bench, 19.0) == "guided"
    assert silent(bench, 2.0) == "land"


def test_a_ground_station_that_comes_back_changes_no_mode():
    bench = out(parameters={"FS_GCS_ENABLE": 7})
    silent(bench)
    bench.wait(2.0)
    assert bench.pilot.mode_name == "brake"
    assert bench.pilot.said[-1][2] == "GCS Failsafe Cleared"


def test_a_ground_station_that_was_never_there_is_not_missed():
    bench = Bench(parameters={"FS_GCS_ENABLE": 1})
    bench.fly_up(10.0)
    bench.pilot.last_heartbeat = None
    assert silent(bench) == "guided"


@pytest.mark.parametrize(
    ("enabled", "action", "mode"),
    [(0, 1, "guided"), (1, 1, "return"), (1, 2, "brake"), (1, 0, "guided"), (1, 6, "loiter")],
)
def test_a_rover_heeds_its_action_only_where_it_heeds_the_ground_station(enabled, action, mode):
    given = {"FS_GCS_ENABLE": enabled, "FS_ACTION": action}
    assert silent(out((5.0, 0.0, 0.0), kind="rover", parameters=given)) == mode


@pytest.mark.parametrize(("enabled", "mode"), [(1, "guided"), (3, "alt_hold"), (4, "surface")])
def test_a_sub_comes_up_if_it_is_set_up_to(enabled, mode):
    given = {"FS_GCS_ENABLE": enabled}
    assert silent(out((5.0, 0.0, -5.0), kind="sub", parameters=given)) == mode


@pytest.mark.parametrize(("options", "mode"), [(16, "return"), (18, "auto")])
def test_a_copter_may_go_on_with_its_mission_when_its_ground_station_is_silent(options, mode):
    bench = out(parameters={"FS_GCS_ENABLE": 1, "FS_OPTIONS": options})
    bench.load(bench.item(16, (500.0, 0.0, 12.0)))
    bench.mode("auto")
    assert silent(bench) == mode
    assert bench.pilot.said[-1][2] == (
        "GCS Failsafe - Continuing Auto Mode" if mode == "auto" else "GCS Failsafe"
    )


def test_a_sub_says_in_words_of_its_own_that_it_hears_no_ground_station():
    bench = out((5.0, 0.0, -5.0), kind="sub", parameters={"FS_GCS_ENABLE": 4})
    silent(bench)
    bench.wait(2.0)
    assert [text for _, _, text in bench.pilot.said][-1] == "MYGCS: 255, heartbeat lost"


@pytest.mark.parametrize(
    ("kind", "action", "mode"), [("rover", 1, "return"), ("rover", 2, "brake"), ("sub", 3, "surface")]
)
def test_actions_for_a_low_battery_mean_something_else_to_others_than_copters(kind, action, mode):
    given = {"BATT_FS_LOW_ACT": action, "BATT_LOW_MAH": 1500.0, "BATT_LOW_VOLT": 0.0}
    bench = out((5.0, 0.0, -5.0 if kind == "sub" else 0.0), kind=kind, parameters=given)
    bench.pilot.battery.change(0.29)
    bench.wait(11.0)
    assert bench.pilot.mode_name == mode


def test_a_sub_may_stop_its_thrust():
    bench = out((5.0, 0.0, -5.0), kind="sub", parameters={"FS_GCS_ENABLE": 2})
    silent(bench)
    assert not bench.pilot.armed


@pytest.mark.parametrize(("action", "mode"), [(0, "guided"), (1, "land"), (2, "return"), (3, "smart_return")])
def test_a_low_battery_is_answered_after_its_time(action, mode):
    bench = out(parameters={"BATT_FS_LOW_ACT": action, "BATT_LOW_MAH": 1500.0, "BATT_LOW_VOLT": 0.0})
    bench.pilot.battery.change(0.29)
    bench.wait(9.0)
    assert bench.pilot.mode_name == "guided"
    bench.wait(2.0)
    assert bench.pilot.mode_name == mode
    assert any(text.startswith("Battery 1 is low") for _, _, text in bench.pilot.said)


def test_a_critical_battery_is_answered_over_a_low_one():
    given = {"BATT_FS_LOW_ACT": 2, "BATT_LOW_MAH": 1500.0, "BATT_FS_CRT_ACT": 1, "BATT_CRT_MAH": 1000.0}
    bench = out(parameters=given)
    bench.pilot.battery.change(0.28)
    bench.wait(12.0)
    assert bench.pilot.mode_name == "return"
    bench.pilot.battery.change(0.15)
    bench.wait(12.0)
    assert bench.pilot.mode_name == "land"


@pytest.mark.parametrize(("action", "mode"), [(0, "guided"), (1, "return"), (2, "land"), (4, "brake")])
def test_a_fence_is_answered_as_it_is_set_up(action, mode):
    bench = out(parameters={"FENCE_ENABLE": 1, "FENCE_ACTION": action, "FENCE_RADIUS": 50.0})
    steer(bench.pilot, (60.0, 0.0, 12.0), None)
    bench.wait_for(lambda: bench.pilot.breached, 20.0)
    assert bench.pilot.breached
    assert bench.pilot.mode_name == mode


def polygon(bench: Bench, command: int, *corners: tuple[float, float]) -> None:
    count = float(len(corners))
    bench.pilot.stores[1] = [bench.item(command, (*corner, 0.0), count) for corner in corners]


BOX = ((40.0, -10.0), (40.0, 10.0), (60.0, 10.0), (60.0, -10.0))


def test_an_area_to_stay_out_of_is_noticed_when_it_is_entered():
    bench = out(parameters={"FENCE_ENABLE": 1, "FENCE_ACTION": 4})
    polygon(bench, 5002, *BOX)
    steer(bench.pilot, (80.0, 0.0, 12.0), None)
    assert bench.wait_for(lambda: bench.pilot.breached, 30.0)
    assert 40.0 <= bench.pilot.body.position[0] <= 47.0
    assert bench.pilot.mode_name == "brake"


def test_a_fence_that_is_off_is_not_heeded():
    bench = out()
    polygon(bench, 5002, *BOX)
    steer(bench.pilot, (50.0, 0.0, 12.0), None)
    bench.wait(15.0)
    assert not bench.pilot.breached


def test_what_a_fence_forbids_is_no_place_to_be_armed():
    bench = Bench(parameters={"FENCE_ENABLE": 1})
    polygon(bench, 5001, *BOX)
    bench.mode("guided")
    assert bench.command(400, 1) != 0
    assert bench.pilot.said[-1][2] == "Arm: vehicle outside Polygon fence"


@pytest.mark.parametrize(("heeded", "breached"), [(7, True), (4, False)])
def test_a_fence_of_polygons_only_has_no_ceiling(heeded, breached):
    bench = out((0.0, 0.0, 12.0), parameters={"FENCE_ENABLE": 1, "FENCE_TYPE": heeded, "FENCE_ACTION": 0})
    steer(bench.pilot, (0.0, 0.0, 110.0), None)
    bench.wait(60.0)
    assert bench.pilot.breached == breached


@pytest.mark.parametrize(("action", "mode"), [(0, "guided"), (1, "land"), (2, "alt_hold")])
def test_a_lost_position_is_answered_after_a_second(action, mode):
    bench = out(parameters={"FS_EKF_ACTION": action})
    bench.pilot.located = False
    bench.wait(0.9)
    assert bench.pilot.mode_name == "guided"
    bench.wait(0.3)
    assert bench.pilot.mode_name == mode


def test_it_is_patient_with_networks_that_do_not_become_faster_with_its_time():
    bench = out(parameters={"FS_GCS_ENABLE": 5})
    bench.pilot.link_timeout = 40.0
    assert silent(bench, 39.0) == "guided"
    assert silent(bench, 2.0) == "land"
