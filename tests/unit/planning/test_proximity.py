from dataclasses import replace
from functools import partial
from itertools import pairwise
from math import inf

import numpy as np
import pytest

from mmrs_core.planning.proximity import Proximity, joined, pieces_of
from mmrs_core.planning.timeline import HomeRelation, Ride

WEST, EAST = (0.0, 0.0, 20.0), (100.0, 0.0, 20.0)
FAR_HOME = (-1000.0, 0.0, 0.0)
SOUTH, NORTH = (50.0, -50.0, 20.0), (50.0, 50.0, 20.0)


def ride(*points, early=0.0, slow=0.0, radius=0.0):
    """Return a ride at 10 m/s that may take `slow` seconds longer."""
    least = tuple(float(np.linalg.norm(np.subtract(a, b)) / 10.0) for a, b in pairwise(points))
    return Ride(points, early, early + sum(least) + slow, least, radius)


def proximity(*rides, homes=(FAR_HOME, FAR_HOME), least=5.0):
    return Proximity(joined([pieces_of([each], i) for i, each in enumerate(rides)]), homes, least)


def meet(*rides, **features):
    return len(proximity(*rides, **features).meetings(0.0)[0]) > 0


def apart(*rides, **features):
    found = proximity(*rides, **features)
    return float(found.nearest(*found.meetings(0.0), 0.0).min())


def blocked(*rides, **features):
    """Return between which delays of the second robot the two meet."""
    (begin,), (end,) = proximity(*rides, **features).delays(np.array([0]), np.array([1]), 0.0)
    return float(begin), float(end)


@pytest.mark.parametrize(
    ("points", "metres"),
    [
        ((SOUTH, NORTH), 0.0),
        (((50.0, -50.0, 23.0), (50.0, 50.0, 23.0)), 3.0),
        (((0.0, 3.0, 20.0), (100.0, 3.0, 20.0)), 3.0),
        (((103.0, 4.0, 20.0), (3.0, 4.0, 20.0)), 4.0),
        (((101.0, 0.0, 20.0), (201.0, 0.0, 20.0)), 1.0),
        (((30.0, 0.0, 22.0), (30.0, 0.0, 90.0)), 2.0),
    ],
)
def test_robots_that_may_be_late_are_as_near_as_their_paths(points, metres):
    assert apart(ride(WEST, EAST, slow=99.0), ride(*points, slow=99.0)) == pytest.approx(metres, abs=1e-6)


def test_robots_in_a_row_stay_as_far_apart_as_they_begin():
    behind = ride((-4.0, 0.0, 20.0), (96.0, 0.0, 20.0))
    assert apart(ride(WEST, EAST), behind) == pytest.approx(4.0, abs=1e-6)


def test_a_crossing_is_blocked_for_as_long_as_both_take_to_clear_it():
    begin, end = blocked(ride(WEST, EAST), ride(SOUTH, NORTH))
    assert (begin, end) == pytest.approx((-0.5 * 2**0.5, 0.5 * 2**0.5))


def test_a_robot_that_may_be_slower_blocks_later_delays_for_longer():
    late = ride(WEST, EAST, slow=2.0)
    assert blocked(late, ride(SOUTH, NORTH)) == pytest.approx((-0.5 * 2**0.5, 2.0 + 0.5 * 2**0.5))


def test_no_delay_is_blocked_where_paths_are_apart():
    begin, end = blocked(ride(WEST, EAST), ride((0.0, 5.0, 20.0), (100.0, 5.0, 20.0)))
    assert begin > end


def test_a_robot_that_stays_for_ever_blocks_every_later_delay():
    begin, end = blocked(Ride((EAST,), 10.0, inf), ride(SOUTH, EAST))
    assert (begin, end) == (pytest.approx(-((50.0**2 * 2) ** 0.5) / 10.0 + 10.0), inf)


def test_robots_that_cross_at_one_time_are_near():
    assert apart(ride(WEST, EAST), ride(SOUTH, NORTH)) == pytest.approx(0.0, abs=1e-6)


def test_robots_that_cross_one_after_the_other_are_apart():
    assert not meet(ride(WEST, EAST), ride(SOUTH, NORTH, early=3.0))


def test_robots_that_may_be_slower_need_more_time_between_them():
    late = ride(SOUTH, NORTH, early=3.0)
    assert meet(ride(WEST, EAST, slow=2.5), late)
    assert not meet(ride(WEST, EAST, slow=0.5), late)


def test_a_place_that_is_not_certain_is_near_from_further_away():
    stay = Ride(((0.0, 8.0, 20.0),), 0.0, 9.0, (), radius=4.0)
    assert apart(ride(WEST, EAST), stay) == pytest.approx(4.0, abs=1e-6)


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
    assert meet(one(here), two(there), homes=(here, there)) == counted


@pytest.mark.parametrize(
    ("there", "counted"),
    [((0.0, 0.0, 2.0), True), ((0.05, 0.0, 2.9), True), ((0.0, 0.0, 0.0), True), ((0.0, 2.0, 0.4), False)],
)
def test_a_robot_over_its_home_is_excused_only_as_far_from_another_as_their_homes_are(there, counted):
    here = (0.0, 0.0, 0.0)
    over, parked = column(here, early=9.0), stands(there)
    assert meet(over, parked, homes=(here, there), least=3.0) == counted
    assert meet(parked, over, homes=(there, here), least=3.0) == counted


def test_a_robot_that_stands_at_home_for_ever_is_near_at_any_time():
    home = (50.0, 3.0, 19.0)
    assert meet(stands(home), ride(WEST, EAST, early=1e6), homes=(home, FAR_HOME))
