from math import inf, sqrt

import numpy as np
import pytest

from mmrs_core.geometry.segments import legs_of, nearest_to_prism, prism_distance

SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))


@pytest.mark.parametrize(
    ("begin", "end", "distance"),
    [
        ((-5, 5, 5), (-5, 6, 5), 5.0),
        ((-5, 5, 5), (15, 5, 5), 0.0),
        ((-5, 5, 25), (15, 5, 25), 5.0),
        ((5, 5, 30), (5, 5, 22), 2.0),
        ((5, 5, -3), (5, 5, -8), 3.0),
        ((-3, -4, 24), (-3, -9, 24), sqrt(9 + 16 + 16)),
        ((5, 5, 5), (6, 5, 5), 0.0),
        ((-10, 5, 15), (0, 5, 25), sqrt(12.5)),
        ((13, 5, 5), (13, 5, 5), 3.0),
        ((-5, 5, 20), (15, 5, 20), 0.0),
        ((12, -20, 5), (12, 30, 5), 2.0),
    ],
)
def test_distance_to_a_box(begin, end, distance):
    assert prism_distance([[begin, end]], SQUARE, 0.0, 20.0)[0] == pytest.approx(distance, abs=1e-12)


def test_unlimited_heights_leave_only_the_sideways_distance():
    legs = [[(-5, 5, 1e6), (-5, 6, -1e6)], [(5, 5, 1e6), (6, 6, 1e6)]]
    assert prism_distance(legs, SQUARE, -inf, inf).tolist() == [5.0, 0.0]


def test_a_half_limited_prism_is_passed_above():
    assert prism_distance([[(-5, 5, 23), (15, 5, 23)]], SQUARE, -inf, 20.0)[0] == 3.0


def test_the_notch_of_a_bent_area_is_outside():
    bent = ((0, 0), (10, 0), (10, 10), (6, 10), (6, 4), (4, 4), (4, 10), (0, 10))
    assert prism_distance([[(5, 9, 5), (5, 7, 5)]], bent, 0.0, 10.0)[0] == pytest.approx(1.0)


def test_the_nearest_point_of_the_leg_is_told():
    distance, point = nearest_to_prism([[(-5, -5, 5), (-5, 30, 5)]], ((0, 3), (4, 0), (4, 6)), 0.0, 20.0)
    assert distance[0] == pytest.approx(5.0)
    assert point[0].tolist() == pytest.approx([-5.0, 3.0, 5.0])


def test_no_legs_have_no_distances():
    assert prism_distance(np.empty((0, 2, 3)), SQUARE, 0.0, 1.0).shape == (0,)


def test_a_single_point_is_a_leg_of_no_length():
    assert legs_of([(1, 2, 3)]).tolist() == [[[1, 2, 3], [1, 2, 3]]]
