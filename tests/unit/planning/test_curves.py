"""Routes around corners for robots that need room to turn."""

from itertools import pairwise
from math import atan2, degrees, dist, inf

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.planning.paths import Space
from mmrs_core.scene import Area, AreaUse, Kinematics

BOX = Area("box", AreaUse.OBSTACLE, ((40, -30), (60, -30), (60, 30), (40, 30)), -inf, inf, 1.0)
WALL = Area("wall", AreaUse.OBSTACLE, ((20, 34.6), (80, 34.6), (80, 36), (20, 36)), -inf, inf, 1.0)


def turns(route):
    """Return by how many degrees a level route turns at each of its corners, to the left."""
    headings = [atan2(b[1] - a[1], b[0] - a[0]) for a, b in pairwise(route)]
    return [(degrees(b - a) + 180.0) % 360.0 - 180.0 for a, b in pairwise(headings)]


def test_a_robot_that_turns_on_the_spot_follows_the_sides_of_an_arc():
    route = Space((BOX,), 3.0).route((0.0, 0.0, 0.0), (100.0, 0.0, 0.0))
    assert len(route) > 8


def test_around_a_corner_no_leg_is_shorter_than_the_turning_circle_is_wide():
    space = Space((BOX,), 3.0, turning_radius=1.2)
    route = space.route((0.0, 0.0, 0.0), (100.0, 0.0, 0.0))
    assert space.is_clear(route)
    assert min(dist(a, b) for a, b in pairwise(route)) >= 2.4


def test_corners_stay_as_they_are_where_fewer_would_lead_too_near_to_something_else():
    alone, beside = (
        Space(areas, 1.0, turning_radius=1.0).route((0.0, 32.2, 0.0), (100.0, 0.0, 0.0))
        for areas in ((BOX,), (BOX, WALL))
    )
    assert len(beside) >= len(alone)
    assert Space((BOX, WALL), 1.0).is_clear(beside)


@given(
    radius=st.floats(0.2, 5.0),
    more=st.floats(0.3, 10.0),
    start=st.tuples(st.floats(-80.0, 10.0), st.floats(-80.0, 80.0)),
    goal=st.tuples(st.floats(85.0, 150.0), st.floats(-80.0, 80.0)),
)
def test_short_legs_are_left_only_between_corners_that_together_turn_by_more_than_a_right_angle(
    radius, more, start, goal
):
    space = Space((BOX,), radius + more, turning_radius=radius)
    route = space.route((*start, 0.0), (*goal, 0.0))
    assert (route[0], route[-1]) == ((*start, 0.0), (*goal, 0.0))
    assert space.is_clear(route)
    bends = turns(route)
    for (one, two), (a, b) in zip(pairwise(bends), pairwise(route[1:-1]), strict=True):
        assert dist(a, b) >= 2.0 * radius or abs(one + two) > 90.0


@pytest.mark.parametrize(("turn", "leg", "fits"), [(90.0, 2.4, True), (90.0, 2.3, False), (45.0, 1.0, True)])
def test_a_curve_fits_where_its_tangents_are_no_longer_than_half_a_leg(turn, leg, fits):
    kinematics = Kinematics(1.0, 0.0, 2.0, 1.0, 1.0, turning_radius=1.2)
    assert kinematics.fits_curve(turn * 3.141592653589793 / 180.0, leg) is fits
