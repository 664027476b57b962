from math import acos, atan2, cos, degrees, dist, hypot, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mmrs_solar.views import LARGEST_OFF_NORMAL, PARALLAX, SWING, View, aim_beyond, before, view_of

from mmrs_core.errors import InfeasibleError

AZIMUTHS, TILTS = st.floats(0.0, 360.0), st.floats(0.0, 90.0)


def normal_of(azimuth, tilt):
    facing, slope = radians(azimuth), radians(tilt)
    return sin(facing) * sin(slope), cos(facing) * sin(slope), cos(slope)


def angle_between(one, other):
    product = sum(a * b for a, b in zip(one, other, strict=True))
    cosine = product / hypot(*one) / hypot(*other)
    return degrees(acos(max(-1.0, min(1.0, cosine))))


def way(begin, end):
    return tuple(b - a for a, b in zip(begin, end, strict=True))


@given(AZIMUTHS, st.floats(5.0, 90.0), st.floats(1.0, 100.0))
def test_a_gimbal_looks_at_panels_along_their_normal(azimuth, tilt, distance):
    place = before((1.0, 2.0, 3.0), view_of(azimuth, tilt, -90.0, 30.0), distance)
    assert dist(place, (1.0, 2.0, 3.0)) == pytest.approx(distance)
    assert angle_between(way((1.0, 2.0, 3.0), place), normal_of(azimuth, tilt)) < 1e-3


@given(AZIMUTHS, TILTS, st.floats(-90.0, 90.0), st.floats(0.0, 120.0))
def test_what_a_view_says_to_be_off_the_normal_is_so(azimuth, tilt, lowest, reach):
    try:
        view = view_of(azimuth, tilt, lowest, min(90.0, lowest + reach))
    except InfeasibleError:
        return
    place = before((0.0, 0.0, 0.0), view, 10.0)
    assert angle_between(place, normal_of(azimuth, tilt)) == pytest.approx(view.off_normal, abs=1e-3)
    assert view.off_normal <= LARGEST_OFF_NORMAL + 1e-6


def test_flat_panels_are_seen_a_little_from_the_side():
    assert view_of(180.0, 0.0, -90.0, 30.0) == View(180.0, -85.0, 5.0)


def test_a_camera_that_looks_down_sees_tilted_panels_off_their_normal():
    assert view_of(180.0, 25.0, -90.0, -90.0).off_normal == 25.0


def test_a_camera_that_would_look_too_far_off_the_normal_is_refused_with_the_angle():
    with pytest.raises(InfeasibleError, match=r"a tilt of 35 degrees 35\.0 degrees off their normal, 30 are"):
        view_of(180.0, 35.0, -90.0, -90.0)


@given(AZIMUTHS, TILTS, st.floats(0.0, 150.0))
def test_whoever_looks_at_the_aim_keeps_heading_and_pitch_all_along_a_row(azimuth, tilt, length):
    view = view_of(azimuth, tilt, -90.0, 30.0)
    middle, along = (5.0, 6.0, 40.0), (cos(radians(azimuth)), -sin(radians(azimuth)))
    aim = aim_beyond(middle, view, length)
    for share in (-0.5, -0.25, 0.0, 0.25, 0.5):
        here = (middle[0] + share * length * along[0], middle[1] + share * length * along[1], middle[2])
        look = way(here, aim)
        assert angle_between(look, way(middle, aim)) <= PARALLAX + 1e-6
        heading = degrees(atan2(look[0], look[1]))
        assert abs((heading - azimuth - 180.0 + 180.0) % 360.0 - 180.0) <= SWING + 1e-6
