"""Changes of speed, and the S-curves that they are taken for."""

from itertools import pairwise

import numpy as np
import pytest
from flown_curves import ramp
from hypothesis import given, settings
from hypothesis import strategies as st

from mmrs_mavlink.calibration.curves import extremes, plateaus_in, ramps_in, smoothed, with_jerk
from mmrs_runtime.s_curves import speeding

RATES = [4.0, 10.0, 50.0]


def speeds_of(top, acceleration, jerk, rate, noise=0.0):
    """Return times and speeds from a stop to a speed, which is kept, and back."""
    up = ramp(top, acceleration, jerk, 1.0 / rate)
    still, even = np.zeros(round(2 * rate)), np.full(round(4 * rate), top)
    speeds = np.concatenate([still, up, even, up[::-1], still])
    speeds = np.abs(speeds + np.random.default_rng(1).normal(0.0, noise, len(speeds)))
    return np.arange(len(speeds)) / rate, speeds


@pytest.mark.parametrize("rate", RATES)
@settings(max_examples=10, deadline=None)
@given(top=st.floats(4.0, 15.0), acceleration=st.floats(1.0, 3.0), share=st.floats(2.0, 8.0))
def test_a_curve_is_found_again_from_samples_of_any_rate(rate, top, acceleration, share):
    jerk = share * acceleration**2 / top
    times, speeds = speeds_of(top, acceleration, jerk, rate)
    found = list(ramps_in(times, speeds, 1.0))
    assert [each.rising for each in found] == [True, False]
    for each in found:
        assert each.fits
        assert each.keeps
        assert each.acceleration == pytest.approx(acceleration, rel=0.12)
        assert with_jerk(times, speeds, each, jerk) == pytest.approx(acceleration, rel=0.12)


@pytest.mark.parametrize("rate", RATES)
def test_acceleration_and_jerk_bear_the_noise_of_satellites(rate):
    times, speeds = speeds_of(8.0, 2.0, 1.5, rate, noise=0.08)
    for each in ramps_in(times, speeds, 1.0):
        assert each.acceleration == pytest.approx(2.0, rel=0.15)
        assert each.jerk == pytest.approx(1.5, rel=0.4)


def test_a_ramp_that_is_all_jerk_does_not_count_as_the_largest_acceleration():
    times, speeds = speeds_of(2.0, 2.5, 1.0, 10.0)
    (up, _) = ramps_in(times, speeds, 0.5)
    assert not up.keeps
    assert up.jerk == pytest.approx(1.0, rel=0.15)


def test_a_jump_is_no_curve():
    times = np.arange(100) / 10.0
    speeds = np.where((times > 3.0) & (times < 6.0), 5.0, 0.0) + np.where(times > 4.0, 1.5, 0.0)
    assert not [each for each in ramps_in(times, speeds, 1.0) if each.fits]


@settings(deadline=None)
@given(speed=st.floats(0.1, 20.0), acceleration=st.floats(0.5, 5.0), jerk=st.floats(0.1, 50.0))
def test_the_seconds_of_a_ramp_are_those_of_its_integral(speed, acceleration, jerk):
    step = 0.01
    speeds = ramp(speed, acceleration, jerk, step)
    assert (len(speeds) - 1) * step == pytest.approx(
        speeding(speed, acceleration, jerk), abs=3.0 * step, rel=0.01
    )


@given(st.lists(st.floats(-10.0, 10.0), max_size=40), st.floats(0.1, 3.0))
def test_extremes_alternate_and_differ(values, least):
    found = extremes(np.array(values), least)
    assert found == sorted(found)
    for before, after in pairwise(found):
        assert abs(values[after] - values[before]) >= least
    signs = [values[after] > values[before] for before, after in pairwise(found)]
    assert all(a != b for a, b in pairwise(signs))


def test_a_speed_counts_as_kept_only_for_long_enough():
    times, speeds = speeds_of(6.0, 2.0, 4.0, 10.0)
    (kept,) = plateaus_in(times, speeds, 0.5, 3.0)
    assert kept.value == pytest.approx(6.0)
    assert list(plateaus_in(times, speeds, 0.5, 8.0)) == []


@given(st.lists(st.floats(-5.0, 5.0), min_size=3, max_size=30))
def test_a_mean_over_less_than_two_samples_changes_nothing(values):
    times = np.arange(len(values), dtype=float)
    assert smoothed(times, np.array(values)).tolist() == pytest.approx(values)
