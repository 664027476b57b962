from dataclasses import replace
from functools import partial
from itertools import pairwise
from math import inf

import numpy as np
import pytest

from mmrs_core.planning.proximity import legs_apart, near_pairs, track_of
from mmrs_core.planning.timeline import HomeRelation, Ride

WEST, EAST = (0.0, 0.0, 20.0), (100.0, 0.0, 20.0)
FAR_HOME = (-1000.0, 0.0, 0.0)
SOUTH, NORTH = (50.0, -50.0, 20.0), (50.0, 50.0, 20.0)


def ride(*points, early=0.0, slow=0.0, radius=0.0):
    """Return a ride at 10 m/s that may take `slow` seconds longer."""
    least = tuple(float(np.linalg.norm(np.subtract(a, b)) / 10.0) for a, b in pairwise(points))
    return Ride(points, early, early + sum(least) + slow, least, radius)


def track(*rides, home=FAR_HOME):
    return track_of(rides, home)


def near(one, two, least=5.0, **features):
    return near_pairs(track(one), track(two), least, finest=0.5, **features)


def apart(one, two):
    return float(legs_apart(np.array([one], float), np.array([two], float))[0])


@pytest.mark.parametrize(
    ("one", "two", "metres"),
    [
        ((WEST, EAST), (SOUTH, NORTH), 0.0),
        ((WEST, EAST), ((50.0, -50.0, 27.0), (50.0, 50.0, 27.0)), 7.0),
        ((WEST, EAST), ((0.0, 3.0, 20.0), (100.0, 3.0, 20.0)), 3.0),
        ((WEST, EAST), ((103.0, 4.0, 20.0), (200.0, 4.0, 20.0)), 5.0),
        ((WEST, WEST), ((3.0, 4.0, 20.0), (3.0, 4.0, 20.0)), 5.0),
        ((WEST, EAST), ((30.0, 0.0, 30.0), (30.0, 0.0, 90.0)), 10.0),
    ],
)
def test_the_distance_between_legs_is_exact(one, two, metres):
    assert apart(one, two) == pytest.approx(metres)
    assert apart(two, one) == pytest.approx(metres)


def test_the_distance_between_legs_is_never_more_than_between_any_of_their_points():
    rng = np.random.default_rng(4)
    one, two = rng.uniform(-9, 9, (300, 2, 3)), rng.uniform(-9, 9, (300, 2, 3))
    found = legs_apart(one, two)
    shares = np.linspace(0.0, 1.0, 41)
    p = one[:, None, 0] + shares[:, None] * (one[:, 1] - one[:, 0])[:, None]
    q = two[:, None, 0] + shares[:, None] * (two[:, 1] - two[:, 0])[:, None]
    sampled = np.linalg.norm(p[:, :, None] - q[:, None], axis=3).min(axis=(1, 2))
    assert (found <= sampled + 1e-9).all()
    assert (found >= sampled - 0.6).all()


def test_robots_that_cross_at_one_time_are_near():
    assert near(ride(WEST, EAST), ride(SOUTH, NORTH), spare=0.0).distance.min() == pytest.approx(0.0)


def test_robots_that_cross_one_after_the_other_are_apart():
    assert len(near(ride(WEST, EAST), ride(SOUTH, NORTH, early=3.0), spare=0.0).distance) == 0


def test_robots_that_may_be_slower_need_more_time_between_them():
    late = ride(SOUTH, NORTH, early=3.0)
    assert len(near(ride(WEST, EAST, slow=2.5), late, spare=0.0).distance) > 0
    assert len(near(ride(WEST, EAST, slow=0.5), late, spare=0.0).distance) == 0


def test_without_regard_to_time_ways_that_cross_are_near():
    assert len(near(ride(WEST, EAST), ride(SOUTH, NORTH, early=1000.0)).distance) > 0


def test_each_piece_has_its_own_span_of_time():
    pieces = track(ride(WEST, EAST, slow=2.0)).cut(10.0)
    assert pieces.times[:, 0].tolist() == pytest.approx([float(k) for k in range(10)])
    assert pieces.times[:, 1].tolist() == pytest.approx([float(k + 3) for k in range(10)])


def test_a_place_that_is_not_certain_is_near_from_further_away():
    stay = Ride(((0.0, 8.0, 20.0),), 0.0, 9.0, (), radius=4.0)
    assert near(ride(WEST, EAST), stay, spare=0.0).distance.min() == pytest.approx(4.0)


def test_a_robot_that_goes_nowhere_is_near_nobody():
    assert len(near_pairs(track(), track(ride(WEST, EAST)), 5.0, finest=0.5, spare=0.0).distance) == 0


def stands(home, *, early=-inf, late=inf):
    return Ride((home,), early, late, (), relation=HomeRelation.HOME)


def column(home, early):
    return replace(ride(home, (home[0], home[1], 20.0), early=early), relation=HomeRelation.COLUMN)


@pytest.mark.parametrize(
    ("one", "two", "metres", "counted"),
    [
        (stands, stands, 3.0, False),
        (stands, partial(column, early=9.0), 3.0, False),
        (partial(column, early=9.0), stands, 3.0, False),
        (partial(column, early=9.0), partial(column, early=9.0), 3.0, True),
        (stands, lambda home: Ride((home,), 0.0, inf), 3.0, True),
    ],
)
def test_only_a_robot_at_home_and_one_at_or_over_a_neighbouring_home_are_excused(one, two, metres, counted):
    here, there = (0.0, 0.0, 0.0), (metres, 0.0, 0.0)
    first, second = track(one(here), home=here), track(two(there), home=there)
    assert bool(len(near_pairs(first, second, 5.0, finest=0.5, spare=0.0).distance)) == counted


@pytest.mark.parametrize(
    ("there", "counted"),
    [((0.0, 0.0, 2.0), True), ((0.05, 0.0, 2.9), True), ((0.0, 0.0, 0.0), True), ((0.0, 2.0, 0.4), False)],
)
def test_a_robot_over_its_home_is_excused_only_as_far_from_another_as_their_homes_are(there, counted):
    here = (0.0, 0.0, 0.0)
    over, parked = track(column(here, early=9.0), home=here), track(stands(there), home=there)
    for one, two in ((over, parked), (parked, over)):
        assert bool(len(near_pairs(one, two, 3.0, finest=0.5, spare=0.0).distance)) == counted


def test_a_robot_that_stands_at_home_for_ever_is_near_at_any_time():
    home = (50.0, 3.0, 19.0)
    idle = track(stands(home), home=home)
    assert len(near_pairs(idle, track(ride(WEST, EAST, early=1e6)), 5.0, finest=0.5, spare=0.0).distance) > 0
