"""Laws of the model of legs, for all lengths, speeds, accelerations and jerks."""

from dataclasses import replace
from itertools import pairwise
from math import cos, dist, hypot, inf, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mmrs_core.scene import Kinematics
from mmrs_core.scene.headings import bearing
from mmrs_core.scene.passing import Passage, overlap, passed
from mmrs_core.scene.timing import Rates
from mmrs_runtime.s_curves import curve
from mmrs_runtime.timing import IDEAL, LegTiming

HERE = (0.0, 0.0, 10.0)
NONE = (0.0, 0.0, 0.0)
LENGTHS = st.floats(0.01, 2000.0)
SPEEDS = st.floats(0.1, 30.0)
LIMITS = st.floats(0.1, 20.0)


@st.composite
def timings(draw):
    return LegTiming(
        acceleration=draw(LIMITS),
        deceleration=draw(st.none() | LIMITS),
        jerk=draw(st.just(inf) | LIMITS),
        corner_radius=draw(st.floats(0.0, 20.0)),
        turning=draw(st.just(0.0) | st.floats(0.1, 1.0)),
        level_within=draw(st.just(inf) | st.floats(0.1, 2.0)),
        settling=draw(st.floats(0.0, 5.0)),
        overshoot=draw(st.floats(0.0, 0.3)),
        spread=draw(st.floats(0.0, 0.5)),
    )


def rates(timing, speed=5.0):
    return Rates(speed, speed, speed, timing)


def east(length, begin=HERE):
    return (begin[0] + length, begin[1], begin[2])


def seconds(timing, length, speed=5.0):
    return rates(timing, speed).from_stop_to_stop(HERE, east(length))


def integrated(timing, length, speed):
    """Return how far a leg leads and how fast it ends, by integrating its acceleration."""
    whole = seconds(replace(timing, settling=0.0, overshoot=0.0), length, speed)
    fastest = _largest(timing, length, speed)
    times = np.linspace(0.0, whole, 200_001)
    change = _acceleration(times, fastest, timing.acceleration, timing.jerk)
    change -= _acceleration(whole - times, fastest, timing.braking, timing.jerk)
    paces = np.concatenate([[0.0], np.cumsum((change[1:] + change[:-1]) / 2.0) * (times[1] - times[0])])
    return float(np.trapezoid(paces, times)), float(paces[-1])


def _phase(speed, acceleration, jerk):
    """Return the seconds from a stop to a speed: those of the jerk, and those at the acceleration."""
    rise = min(acceleration, (speed * jerk) ** 0.5) / jerk
    return rise, speed / (rise * jerk) - rise


def _acceleration(times, speed, acceleration, jerk):
    rise, steady = _phase(speed, acceleration, jerk)
    return jerk * np.clip(np.minimum(times, 2.0 * rise + steady - times), 0.0, rise)


def _largest(timing, length, speed):
    """Return the largest speed of a leg by bisection."""
    low, high = 0.0, speed
    for _ in range(100):
        middle = (low + high) / 2.0
        phases = (
            _phase(middle, limit, timing.jerk) if middle else (0.0, 0.0)
            for limit in (timing.acceleration, timing.braking)
        )
        needed = sum(middle * (2.0 * rise + steady) / 2.0 for rise, steady in phases)
        low, high = (middle, high) if needed <= length else (low, middle)
    return low


@given(timings(), st.floats(0.5, 500.0), st.floats(0.5, 20.0))
def test_a_leg_takes_as_long_as_its_jerk_integrated(timing, length, speed):
    assume(timing.jerk < inf)
    place, pace = integrated(timing, length, speed)
    assert place == pytest.approx(length, rel=1e-3)
    assert pace == pytest.approx(0.0, abs=1e-3 * speed)


@given(timings(), LENGTHS, st.floats(0.0, 100.0), SPEEDS)
def test_a_longer_leg_takes_no_less_time(timing, length, more, speed):
    assert seconds(timing, length, speed) <= seconds(timing, length + more, speed) + 1e-9


@given(timings(), LENGTHS, SPEEDS)
def test_a_hair_of_length_takes_a_hair_of_time(timing, length, speed):
    shorter, longer = seconds(timing, length, speed), seconds(timing, length * (1.0 + 1e-9), speed)
    assert longer - shorter < 1e-5 * (1.0 + shorter)


@given(timings(), LENGTHS, SPEEDS, st.floats(1.0, 3.0))
def test_a_higher_speed_takes_no_more_time_but_for_settling(timing, length, speed, faster):
    settled = replace(timing, overshoot=0.0)
    assert seconds(settled, length, speed * faster) <= seconds(settled, length, speed) + 1e-9


@given(timings(), LENGTHS, SPEEDS)
def test_no_leg_is_quicker_than_at_even_speed(timing, length, speed):
    assert seconds(timing, length, speed) >= length / speed - 1e-9


@given(timings(), LENGTHS, SPEEDS)
def test_less_jerk_takes_no_less_time(timing, length, speed):
    assert seconds(replace(timing, jerk=inf), length, speed) <= seconds(timing, length, speed) + 1e-9


@given(timings(), LENGTHS, LENGTHS, st.floats(0.0, 179.0), SPEEDS)
def test_passing_a_corner_takes_no_more_time_than_stopping_there(timing, first, second, turn, speed):
    corner = east(first)
    end = (corner[0] + second * sin(radians(90.0 - turn)), corner[1] + second * sin(radians(turn)), corner[2])
    found = rates(timing, speed)
    stopping = found.from_stop_to_stop(HERE, corner) + found.from_stop_to_stop(corner, end)
    passage = passed(found, (HERE, corner), (corner, end))
    saved = passage.saved + passage.onward
    assert 0.0 <= saved <= stopping + 1e-9
    assert stopping - saved >= found.eased(HERE, corner) / 2.0 - 1e-6


@given(timings(), st.lists(st.tuples(LENGTHS, st.floats(-179.0, 179.0)), min_size=2, max_size=6), SPEEDS)
def test_a_robot_that_slows_down_for_places_takes_each_leg_at_speeds_that_fit(timing, ways, speed):
    """None is quicker than at even speed to where it counts as passed, and none is entered faster."""
    assume(timing.slows_down)
    found, here, course, legs = rates(timing, speed), HERE, 0.0, []
    for length, aside in ways:
        course += radians(aside)
        there = (here[0] + length * cos(course), here[1] + length * sin(course), here[2])
        legs.append((here, there))
        here = there
    entered = Passage(0.0, 0.0)
    for before, after in pairwise(legs):
        passage = passed(found, before, after, entered)
        level = dist(entered.start or before[0], before[1])
        seconds = found.from_stop_to_stop(*before) - entered.onward - passage.saved
        assert seconds >= max(0.0, level - timing.corner_radius) / speed - 1e-6
        assert 0.0 <= passage.speed <= speed
        entered = passage


@given(LIMITS, LIMITS, LIMITS | st.just(inf), LENGTHS, SPEEDS, SPEEDS, SPEEDS)
def test_a_leg_between_two_speeds_is_no_shorter_than_the_way_that_it_takes(
    up, down, jerk, length, speed, enters, leaves
):
    leaves = min(leaves, speed)
    found = curve(length, speed, (up, down, jerk), enters, leaves)
    whole = curve(length, speed, (up, down, jerk))
    assert length / max(speed, enters) - 1e-9 <= found.seconds
    assert enters > speed or found.seconds <= whole.seconds + 1e-6
    assert found.leaves <= max(leaves, speed)
    assert max(enters, found.leaves) <= found.fastest <= max(speed, enters) + 1e-9
    assert whole.seconds == pytest.approx(
        rates(LegTiming(up, down, jerk=jerk), speed).from_stop_to_stop(HERE, east(length)), rel=1e-6
    )


@given(timings(), st.floats(5.0, 500.0), SPEEDS)
def test_a_turn_keeps_within_the_corner_radius(timing, length, speed):
    """In half of the overlap the robot speeds up from the corner on; half of the turn is at right angles."""
    assume(timing.jerk == inf and timing.corner_radius > 0.0)
    corner = east(length)
    after = (corner, (corner[0], length, corner[2]))
    both = overlap(rates(timing, speed), (HERE, corner), after)
    travelled = timing.acceleration * (both / 2.0) ** 2 / 2.0
    assert travelled * tan(radians(45.0)) * 2.0**0.5 <= timing.corner_radius + 1e-6


@given(timings(), LENGTHS)
def test_bounds_are_around_what_is_expected(timing, length):
    found = rates(timing)
    soonest, latest = found.soonest(), found.latest()
    expected = found.from_stop_to_stop(HERE, east(length))
    assert soonest.from_stop_to_stop(HERE, east(length)) == pytest.approx(expected * (1.0 - timing.spread))
    assert soonest.eased(HERE, east(length)) <= soonest.from_stop_to_stop(HERE, east(length))
    most = latest.from_stop_to_stop(HERE, east(length))
    if timing.slows_down:  # the place before may count as passed a radius before it
        assert most >= expected * (1.0 + timing.spread) - 1e-9
    else:
        assert most == pytest.approx(expected * (1.0 + timing.spread))


@given(timings(), LENGTHS, SPEEDS, st.floats(0.0, 1.0), st.floats(0.0, 10.0), st.floats(1.0, 30.0))
def test_bounds_stay_around_what_is_expected_of_a_robot_that_is_inexact(
    timing, length, speed, still, lag, within
):
    found = rates(replace(timing, acceptance=1.0, still=still, lag=lag, lag_within=within), speed)
    least, most = (level.from_stop_to_stop(HERE, east(length)) for level in (found.soonest(), found.latest()))
    assert 0.0 <= least <= found.from_stop_to_stop(HERE, east(length)) <= most


@given(timings(), LENGTHS, SPEEDS, st.floats(0.0, 10.0), st.floats(1.0, 30.0))
def test_a_robot_that_lags_takes_so_much_longer_at_most(timing, length, speed, lag, within):
    late = seconds(replace(timing, lag=lag, lag_within=within), length, speed) - seconds(
        timing, length, speed
    )
    assert -1e-9 <= late <= lag + 1e-9


@given(LENGTHS, SPEEDS)
def test_an_ideal_robot_takes_its_length_over_its_speed(length, speed):
    assert seconds(IDEAL, length, speed) == pytest.approx(length / speed)


def test_a_place_takes_no_time():
    assert rates(LegTiming(2.0, settling=3.0)).from_stop_to_stop(HERE, HERE) == 0.0


def test_a_climb_is_limited_by_its_own_rate_and_acceleration():
    climbing = Rates(10.0, 2.5, 1.5, LegTiming(5.0, vertical_acceleration=1.0))
    assert climbing.rise(25.0) == pytest.approx(10.0 + 2.5)
    assert climbing.rise(-15.0) == pytest.approx(10.0 + 1.5)
    assert climbing.from_stop_to_stop(NONE, (100.0, 0.0, 0.0)) == pytest.approx(10.0 + 2.0)


def test_a_sloping_leg_is_as_slow_as_its_slower_part():
    sloping = Rates(10.0, 1.0, 1.0, LegTiming(5.0, vertical_acceleration=1.0))
    assert sloping.from_stop_to_stop(NONE, (10.0, 0.0, 50.0)) > 50.0


def test_a_robot_that_overshoots_comes_back():
    quick, slow = LegTiming(5.0), LegTiming(5.0, overshoot=0.2)
    assert seconds(slow, 500.0, 2.0) == seconds(quick, 500.0, 2.0)
    assert seconds(slow, 500.0, 10.0) > seconds(quick, 500.0, 10.0) + 1.0


def test_a_robot_that_turns_first_is_soonest_where_it_need_not():
    rover = Rates(1.0, 1.0, 1.0, LegTiming(1.0), shunting=9.0)
    assert rover.from_stop_to_stop(NONE, (10.0, 0.0, 0.0)) == pytest.approx(20.0)
    assert rover.soonest().from_stop_to_stop(NONE, (10.0, 0.0, 0.0)) == pytest.approx(11.0)
    rounds = replace(rover, rounds=True)
    assert rounds.from_stop_to_stop(NONE, (10.0, 0.0, 0.0)) == pytest.approx(11.0)
    assert rounds.latest().from_stop_to_stop(NONE, (10.0, 0.0, 0.0)) == pytest.approx(20.0)


@given(st.floats(9.0, 60.0), st.floats(0.0, 180.0), st.floats(0.5, 3.0))
def test_a_car_drives_round_by_a_curve_and_a_tangent(metres, aside, radius):
    rover = Rates(2.0, 1.0, 1.0, shunting=9.0, rounds=True, shunts_within=0.0, circling=pi * radius)
    seconds = rover.turning(NONE, east(metres, NONE), 90.0 - aside)
    heading, place, left = radians(90.0 - aside), (0.0, 0.0), 0.0
    while cos(heading - radians(bearing((*place, 0.0), east(metres, NONE)))) < 1.0 - 1e-6:
        step = 1e-3
        heading += step
        place = (place[0] + step * radius * sin(heading), place[1] + step * radius * cos(heading))
        left += step * radius
    driven = left + hypot(metres - place[0], place[1])
    assert seconds == pytest.approx((driven - metres) / 2.0, abs=0.02)


def test_a_car_shunts_to_what_is_near_and_aside_by_whole_arcs():
    timing = LegTiming(1.0, aside=15.0, spread=0.1)
    rover = Rates(1.0, 1.0, 1.0, timing, shunting=36.0, halt=4.0, rounds=True, shunts_within=10.0)
    assert rover.turning(NONE, east(5.0, NONE), 90.0) == 0.0
    assert rover.turning(NONE, east(5.0, NONE), 76.0) == 0.0
    assert rover.turning(NONE, east(5.0, NONE), 0.0) == pytest.approx(8.0 + 3 * 4.0)
    assert rover.turning(NONE, east(5.0, NONE), 270.0) == pytest.approx(36.0)
    assert rover.latest().turning(NONE, east(5.0, NONE), 0.0) == pytest.approx(39.6)
    assert rover.turning(NONE, east(11.0, NONE), 0.0) < 4.0


def test_a_leg_that_may_stall_takes_longer_at_most():
    plain, stalling = Rates(2.0, 1.0, 1.0, LegTiming(1.0)), Rates(2.0, 1.0, 1.0, LegTiming(1.0, stall=35.0))
    leg = (HERE, east(9.0))
    assert stalling.from_stop_to_stop(*leg) == plain.from_stop_to_stop(*leg)
    assert stalling.latest().from_stop_to_stop(*leg) == plain.latest().from_stop_to_stop(*leg) + 35.0


def test_legs_within_the_acceptance_are_taken_together():
    rates = Rates(5.0, 1.0, 1.0, LegTiming(1.0), accepts=1.0)
    assert rates.from_stop_to_stop(HERE, east(0.6)) == pytest.approx(seconds(LegTiming(1.0), 1.2) / 2.0)
    assert rates.latest().from_stop_to_stop(HERE, east(0.6)) == seconds(LegTiming(1.0), 0.6)


@given(timings(), st.floats(0.02, 0.5), st.floats(0.5, 20.0))
def test_passed_legs_that_are_taken_together_save_no_more_than_as_one(timing, length, speed):
    """Else what a stop costs would be saved at each of them, though there is none."""
    found = replace(rates(timing, speed), accepts=0.5)
    many = found.together(HERE, east(length))
    long = many * length
    whole = passed(found, (HERE, east(long)), (east(long), east(2 * long)))
    each = passed(found, (HERE, east(length)), (east(length), east(2 * length)))
    assert many * each.saved == pytest.approx(whole.saved)
    assert many * each.onward == pytest.approx(whole.onward)
    assert found.from_stop_to_stop(HERE, east(length)) >= each.saved + each.onward - 1e-9


@given(metres=st.floats(9.7, 60.0), radius=st.floats(0.5, 3.0), speed=st.floats(0.5, 3.0))
def test_the_latest_seconds_of_a_car_cover_a_target_behind_it(metres, radius, speed):
    rover = Kinematics(
        cruise=speed,
        slowest=0.0,
        fastest=speed,
        climb=1.0,
        descent=1.0,
        timing=LegTiming(acceleration=1.0, shunts_within=0.0),
        turning_radius=radius,
        rounds=True,
    )
    rates = rover.rates()
    straight = rates.from_stop_to_stop(NONE, (metres, 0.0, 0.0))
    # half of the circle leads abreast of where it stood; from there it drives straight on
    detour = pi * radius + hypot(metres, 2.0 * radius) - metres
    assert rates.latest().from_stop_to_stop(NONE, (metres, 0.0, 0.0)) >= straight + detour / speed - 1e-9
