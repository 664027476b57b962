"""What the vehicle does in its modes, and which it lets nobody enter."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, degrees, hypot

import pytest
from pyproj import Geod
from simulated import Bench

from mmrs_mavlink.sitl.commands import steer

OUT = (40.0, 30.0, 12.0)


def out(**settings) -> Bench:
    bench = Bench(**settings)
    bench.fly_up(12.0)
    steer(bench.pilot, OUT, None)
    assert bench.wait_for(lambda: bench.pilot.body.distance_to(OUT) < 0.1)
    return bench


def rally(bench: Bench, place) -> None:
    bench.pilot.stores[2] = [replace(bench.item(5100, place), frame=3)]


def test_its_metres_are_those_of_the_ellipsoid():
    bench = Bench()
    latitude, longitude = bench.pilot.degrees_at((1000.0, -2000.0, 0.0))
    azimuth, _, length = Geod(ellps="WGS84").inv(13.35, 42.37, longitude, latitude)
    assert length == pytest.approx(hypot(1000.0, 2000.0), abs=0.3)
    assert azimuth == pytest.approx(degrees(atan2(-2000.0, 1000.0)), abs=0.02)
    assert bench.pilot.local(latitude, longitude, 0.0) == pytest.approx((1000.0, -2000.0, 0.0))


def test_guided_goes_where_it_is_steered_and_looks_where_it_is_told():
    bench = out()
    steer(bench.pilot, OUT, 200.0)
    bench.wait(5.0)
    assert bench.pilot.body.heading == pytest.approx(200.0)


def test_return_climbs_comes_home_and_lands():
    bench = out()
    bench.mode("return")
    assert bench.wait_for(lambda: not bench.pilot.armed)
    assert hypot(*bench.pilot.body.position[:2]) < 1.5
    assert max(point[3] for point in bench.pilot.track) == pytest.approx(15.0, abs=0.6)


def test_a_copter_heeds_the_newer_names_of_its_speed_and_height():
    bench = out(parameters={"WP_SPD": 3.0, "RTL_ALT_M": 20.0})
    bench.mode("return")
    assert bench.wait_for(lambda: not bench.pilot.armed)
    assert max(point[3] for point in bench.pilot.track) == pytest.approx(20.0, abs=0.6)
    assert bench.pilot.usual_speed() == 3.0


def test_return_goes_to_the_nearest_of_home_and_the_rally_points():
    bench = out()
    rally(bench, (45.0, 40.0, 10.0))
    bench.mode("return")
    assert bench.wait_for(lambda: not bench.pilot.armed)
    assert hypot(bench.pilot.body.position[0] - 45.0, bench.pilot.body.position[1] - 40.0) < 1.5


@pytest.mark.parametrize(("with_home", "north"), [(1.0, 0.0), (0.0, 200.0)])
def test_home_counts_among_the_havens_or_not(with_home, north):
    bench = out(parameters={"RALLY_INCL_HOME": with_home})
    rally(bench, (200.0, 0.0, 10.0))
    bench.mode("return")
    assert bench.wait_for(lambda: not bench.pilot.armed)
    assert bench.pilot.body.position[0] == pytest.approx(north, abs=1.5)


def test_smart_return_goes_back_by_the_way_it_came():
    bench = out()
    steer(bench.pilot, (0.0, 60.0, 12.0), None)
    assert bench.wait_for(lambda: bench.pilot.body.distance_to((0.0, 60.0, 12.0)) < 0.1)
    since = bench.pilot.time
    bench.mode("smart_return")
    assert bench.wait_for(lambda: not bench.pilot.armed)
    way = [point for point in bench.pilot.track if point[0] > since]
    assert min(hypot(point[1] - OUT[0], point[2] - OUT[1]) for point in way) < 2.0
    assert hypot(*bench.pilot.body.position[:2]) < 1.5


def test_brake_and_loiter_stand_still():
    for mode in ("brake", "loiter"):
        bench = out()
        steer(bench.pilot, (0.0, 0.0, 12.0), None)
        bench.wait(3.0)
        bench.mode(mode)
        bench.wait(5.0)
        assert bench.pilot.body.pace == 0.0


def test_modes_that_need_a_position_are_refused_without_one():
    bench = out()
    bench.pilot.located = False
    assert bench.mode("return") != 0
    assert bench.mode("alt_hold") == 0


def test_auto_is_refused_without_a_mission():
    assert out().mode("auto") != 0


def test_it_disarms_where_it_stands_about():
    bench = Bench(disarm_delay=10.0)
    bench.mode("guided")
    bench.command(400, 1)
    assert not bench.wait_for(lambda: not bench.pilot.armed, 9.0)
    assert bench.wait_for(lambda: not bench.pilot.armed, 2.0)


def test_it_is_not_disarmed_in_the_air_but_by_force():
    bench = out()
    assert bench.command(400, 0) != 0
    assert bench.command(400, 0, 21_196) == 0
    bench.wait(5.0)
    assert bench.pilot.body.position[2] == 0.0


def test_it_cannot_be_armed_in_auto_unless_a_parameter_allows_it():
    for options, result in ((0.0, 4), (1.0, 0)):
        bench = Bench(parameters={"AUTO_OPTIONS": options})
        bench.load(bench.item(22, (0.0, 0.0, 10.0)))
        bench.mode("auto")
        assert bench.command(400, 1) == result


def test_home_is_where_it_is_armed():
    bench = out()
    bench.mode("land")
    assert bench.wait_for(lambda: not bench.pilot.armed)
    bench.mode("guided")
    bench.command(400, 1)
    assert bench.pilot.home[:2] == bench.pilot.degrees()


def test_a_home_that_it_was_told_stays_until_it_starts_anew_and_heights_count_from_there():
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


def test_a_sub_dives_and_surfaces():
    bench = Bench(kind="sub")
    bench.mode("guided")
    assert bench.command(400, 1) == 0
    steer(bench.pilot, (5.0, 0.0, -8.0), None)
    assert bench.wait_for(lambda: bench.pilot.body.position[2] < -7.9)
    bench.mode("surface")
    assert bench.wait_for(lambda: bench.pilot.body.position[2] > -0.1)


def test_the_home_of_a_submarine_stays_at_the_surface_wherever_it_is_armed_or_starts_anew():
    bench = Bench(kind="sub")
    bench.pilot.body.rest_at(-3.0)
    bench.pilot.arm()
    armed = bench.pilot.home[2]
    bench.pilot.restart()
    assert (armed, bench.pilot.home[2]) == (bench.pilot.settings.altitude, bench.pilot.settings.altitude)
