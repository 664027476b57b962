"""How far robots get in what time, and at what cost."""

from dataclasses import replace
from itertools import pairwise

import pytest

from mmrs_core.scene import Kinematics
from mmrs_core.scene.headings import bearing, turn
from mmrs_core.simulation.legs import CLIMBING, TimedLeg, cost, current, response_stretches, stretches, wind
from mmrs_runtime.timing import LegTiming

FLYER = Kinematics(cruise=5.0, slowest=0.0, fastest=10.0, climb=2.0, descent=1.0)
HERE, EAST, UP = (0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 0.0, 10.0)


def legs(*path, whole=None, kinematics=FLYER, **more):
    rates = kinematics.rates(5.0)
    whole = sum(rates.from_stop_to_stop(*leg) for leg in pairwise(path)) if whole is None else whole
    return stretches(path, rates, whole, kinematics, **more)


def seconds(*path, **more):
    return sum(each.seconds for each in legs(*path, **more))


def test_level_ways_take_their_length_over_the_speed():
    assert seconds(HERE, EAST) == pytest.approx(20.0)


def test_the_slower_of_level_and_vertical_counts():
    assert seconds(HERE, UP) == pytest.approx(5.0)
    assert seconds(UP, HERE) == pytest.approx(10.0)
    assert seconds(HERE, (100.0, 0.0, 10.0)) == pytest.approx(20.0)
    assert seconds(HERE, (10.0, 0.0, 10.0)) == pytest.approx(5.0)


def test_each_leg_gets_its_share_of_the_whole():
    found = legs(HERE, EAST, (100.0, 50.0, 0.0), whole=60.0)
    assert [leg.seconds for leg in found] == pytest.approx([40.0, 20.0])


def test_wind_slows_down_only_where_the_robot_would_have_to_be_too_fast():
    assert seconds(HERE, EAST, flow=(-4.0, 0.0)) == pytest.approx(20.0)
    assert seconds(HERE, EAST, flow=(-8.0, 0.0)) == pytest.approx(50.0)
    assert seconds(HERE, EAST, flow=(8.0, 0.0)) == pytest.approx(20.0)


def test_wind_from_the_side_takes_part_of_the_speed():
    assert seconds(HERE, EAST, flow=(0.0, 9.6)) == pytest.approx(100.0 / 2.8)


def test_there_is_no_headway_against_more_wind_than_the_largest_speed():
    assert legs(HERE, EAST, flow=(-10.0, 0.0)) == ()
    assert legs(HERE, EAST, flow=(0.0, 11.0)) == ()


def test_power_grows_with_the_climb_and_with_the_square_of_the_headwind():
    assert cost(HERE, EAST, 20.0, FLYER, (0.0, 0.0)) == 1.0
    assert cost(HERE, UP, 5.0, FLYER, (0.0, 0.0)) == pytest.approx(1.0 + CLIMBING)
    assert cost(HERE, EAST, 20.0, FLYER, (-5.0, 0.0)) == pytest.approx(1.25)
    assert cost(HERE, EAST, 20.0, FLYER, (5.0, 0.0)) == 1.0
    assert cost(HERE, HERE, 20.0, FLYER, (3.0, 4.0)) == pytest.approx(1.25)


@pytest.mark.parametrize("descent", [0.5, 1.0, 2.0, 4.0, 6.0])
def test_up_and_down_again_takes_what_the_time_takes_however_fast_the_descent(descent):
    flyer = replace(FLYER, descent=descent)
    way = (*legs(HERE, UP, kinematics=flyer), *legs(UP, HERE, kinematics=flyer))
    assert sum(each.rate * each.seconds for each in way) == pytest.approx(sum(each.seconds for each in way))


def test_no_descent_gives_energy_back_beyond_what_flying_takes():
    assert cost(UP, HERE, 1.0, replace(FLYER, descent=10.0), (0.0, 0.0)) == 0.0


SLOW = replace(FLYER, timing=LegTiming(1.0))


def response(*path, moving):
    made = response_stretches(path, SLOW, (0.0, 0.0), moving=moving)
    return [each.seconds for each in made]


def test_a_response_stops_at_every_corner():
    assert response(UP, (100.0, 0.0, 10.0), EAST, moving=False) == pytest.approx([25.0, 11.0])


def test_a_robot_under_way_has_its_first_start_behind_it():
    assert response(UP, (100.0, 0.0, 10.0), EAST, moving=True) == pytest.approx([20.0, 11.0])


def test_a_robot_that_stays_needs_no_time_to_respond():
    assert response(HERE, moving=False) == []


def test_there_is_no_response_against_too_much_wind():
    assert response_stretches((HERE, EAST, UP), SLOW, (-10.0, 0.0), moving=True) == ()


def test_a_climb_gets_to_its_own_pace_only():
    assert seconds(HERE, (0.0, 0.0, 50.0), kinematics=SLOW) == pytest.approx(25.0 + 2.0)


def test_wind_comes_from_its_direction_and_current_goes_to_it():
    assert wind({"windSpeed": 3.0, "windDirection": 90.0}) == pytest.approx((-3.0, 0.0))
    assert current({"currentSpeed": 3.0, "currentDirection": 90.0}) == pytest.approx((3.0, 0.0))
    assert wind({}) == (0.0, 0.0)


def test_bearings_count_clockwise_from_north():
    assert bearing(HERE, (0.0, 1.0, 0.0)) == 0.0
    assert bearing(HERE, (1.0, 0.0, 5.0)) == 90.0
    assert bearing(HERE, UP) is None


@pytest.mark.parametrize(("first", "last", "by"), [(350, 10, 20), (10, 350, -20), (0, 90, 90)])
def test_turns_go_the_shorter_way_round(first, last, by):
    assert turn(first, last) == by


def test_a_leg_knows_where_the_robot_is_and_what_is_left_at_any_time():
    leg = TimedLeg(10.0, 30.0, HERE, EAST, (350.0, 10.0), charge=15.0, rate=0.5)
    assert leg.position(20.0) == (50.0, 0.0, 0.0)
    assert leg.heading(20.0) == pytest.approx(0.0)
    assert leg.charge_at(20.0) == 10.0
    assert leg.speed == 5.0
    assert leg.empty_at == 40.0
    half = leg.until(20.0)
    assert (half.end, half.finish) == (20.0, (50.0, 0.0, 0.0))
    assert half.heading(20.0) == pytest.approx(0.0)
