"""Flight modes: what a vehicle does in them, which it refuses, and its home."""

from dataclasses import replace
from math import atan2, degrees, hypot

import pytest
from pyproj import Geod
from simulated import Bench

from mmrs_mavlink.sitl.commands import steer

OUT = (40.0, 30.0, 12.0)
OUTSIDE_THE_LIMIT = (200.0, 0.0, 10.0)


def out(**settings) -> Bench:
    """Return a copter away from home."""
    bench = Bench(**settings)
    bench.fly_up(12.0)
    go(bench, OUT)
    return bench


def go(bench: Bench, place) -> None:
    steer(bench.pilot, place, None)
    assert bench.wait_for(lambda: bench.pilot.body.distance_to(place) < 0.1)


def returned(bench: Bench, mode: str = "return") -> tuple[float, float]:
    """Return where a vehicle lands after a return."""
    bench.mode(mode)
    assert bench.wait_for(lambda: not bench.pilot.armed)
    return bench.pilot.body.position[:2]


def highest(bench: Bench) -> float:
    return max(point[3] for point in bench.pilot.track)


def test_metres_are_those_of_the_ellipsoid():
    bench = Bench()
    latitude, longitude = bench.pilot.degrees_at((1000.0, -2000.0, 0.0))
    azimuth, _, length = Geod(ellps="WGS84").inv(13.35, 42.37, longitude, latitude)
    assert length == pytest.approx(hypot(1000.0, 2000.0), abs=0.3)
    assert azimuth == pytest.approx(degrees(atan2(-2000.0, 1000.0)), abs=0.02)
    assert bench.pilot.local(latitude, longitude, 0.0) == pytest.approx((1000.0, -2000.0, 0.0))


def test_guided_follows_positions_and_headings():
    bench = out()
    steer(bench.pilot, OUT, 200.0)
    bench.wait(5.0)
    assert bench.pilot.body.heading == pytest.approx(200.0)


def test_return_climbs_flies_home_and_lands():
    bench = out()
    assert hypot(*returned(bench)) < 1.5
    assert highest(bench) == pytest.approx(15.0, abs=0.6)


@pytest.mark.parametrize(
    ("with_home", "rally", "goal"),
    [
        (1.0, (45.0, 40.0, 10.0), (45.0, 40.0)),
        (1.0, OUTSIDE_THE_LIMIT, (0.0, 0.0)),
        (0.0, OUTSIDE_THE_LIMIT, (200.0, 0.0)),
    ],
)
def test_return_goes_to_the_nearest_of_home_and_the_rally_points(with_home, rally, goal):
    bench = out(parameters={"RALLY_INCL_HOME": with_home})
    bench.pilot.stores[2] = [replace(bench.item(5100, rally), frame=3)]
    assert returned(bench) == pytest.approx(goal, abs=1.5)


def test_smart_return_retraces_its_path():
    bench = out()
    go(bench, (0.0, 60.0, 12.0))
    since = bench.pilot.time
    assert hypot(*returned(bench, "smart_return")) < 1.5
    path = [point for point in bench.pilot.track if point[0] > since]
    assert min(hypot(point[1] - OUT[0], point[2] - OUT[1]) for point in path) < 2.0


@pytest.mark.parametrize("mode", ["hold", "loiter"])
def test_a_vehicle_stops(mode):
    bench = out()
    steer(bench.pilot, (0.0, 0.0, 12.0), None)
    bench.wait(3.0)
    bench.mode(mode)
    bench.wait(5.0)
    assert bench.pilot.body.pace == pytest.approx(0.0, abs=0.05)


def test_modes_are_refused_without_the_position_or_mission_that_they_need():
    bench = out()
    assert bench.mode("auto") != 0
    bench.pilot.located = False
    assert bench.mode("return") != 0
    assert bench.mode("altitude_hold") == 0


def test_an_idle_vehicle_disarms():
    bench = Bench()
    bench.mode("guided")
    bench.command(400, 1)
    assert not bench.wait_for(lambda: not bench.pilot.armed, 9.0)
    assert bench.wait_for(lambda: not bench.pilot.armed, 2.0)


def test_a_vehicle_disarms_in_the_air_only_by_force():
    bench = out()
    assert bench.command(400, 0) != 0
    assert bench.command(400, 0, 21_196) == 0
    bench.wait(5.0)
    assert bench.pilot.body.position[2] == 0.0


@pytest.mark.parametrize(("options", "result"), [(0.0, 4), (1.0, 0)])
def test_a_vehicle_arms_in_auto_only_if_configured(options, result):
    bench = Bench(parameters={"AUTO_OPTIONS": options})
    bench.load(bench.item(22, (0.0, 0.0, 10.0)))
    bench.mode("auto")
    assert bench.command(400, 1) == result


def test_home_is_where_a_vehicle_arms():
    bench = out()
    bench.mode("land")
    assert bench.wait_for(lambda: not bench.pilot.armed)
    bench.mode("guided")
    bench.command(400, 1)
    assert bench.pilot.home[:2] == bench.pilot.degrees()


def test_a_home_that_was_set_stays_until_a_restart_and_altitudes_count_from_it():
    bench = Bench()
    bench.pilot.body.position = (72.0, 0.0, 0.0)
    assert bench.command(179, 0, 0, 0, 0, 42.37, 13.35, 714.0) == 0
    bench.mode("guided")
    bench.command(400, 1)
    assert bench.command(22, 0, 0, 0, 0, 0, 0, 10.0) == 0
    bench.wait(20.0)
    assert bench.pilot.home == (42.37, 13.35, 714.0)
    assert bench.pilot.body.position[2] == pytest.approx(4.0, abs=0.1)
    bench.pilot.restart()
    assert bench.pilot.home[:2] == bench.pilot.degrees()


def test_a_rover_neither_takes_off_nor_lands():
    bench = Bench(kind="rover")
    bench.mode("guided")
    assert bench.command(400, 1) == 0
    assert bench.command(22, 0, 0, 0, 0, 0, 0, 10) != 0
    steer(bench.pilot, (10.0, 0.0, 0.0), None)
    assert bench.wait_for(lambda: bench.pilot.body.distance_to((10.0, 0.0, 0.0)) < 2.0)


def test_a_submarine_dives_and_surfaces():
    bench = Bench(kind="sub")
    bench.mode("guided")
    assert bench.command(400, 1) == 0
    steer(bench.pilot, (5.0, 0.0, -8.0), None)
    assert bench.wait_for(lambda: bench.pilot.body.position[2] < -7.9)
    bench.mode("surface")
    assert bench.wait_for(lambda: bench.pilot.body.position[2] > -0.1)


def test_the_home_of_a_submarine_is_at_the_surface():
    bench = Bench(kind="sub")
    bench.pilot.body.rest_at(-3.0)
    for change in (bench.pilot.arm, bench.pilot.restart):
        change()
        assert bench.pilot.home[2] == bench.pilot.settings.altitude
