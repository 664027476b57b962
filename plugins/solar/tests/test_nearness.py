from dataclasses import replace
from math import cos, dist, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mmrs_solar.groups import laid_out
from mmrs_solar.nearness import panel_distance, refuse_near

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Part


def any_group(azimuth, tilt, width, climb):
    end = (50.0 * cos(radians(azimuth)), -50.0 * sin(radians(azimuth)), climb)
    return laid_out(
        Part((), {"points": ((0.0, 0.0, 0.0), end), "azimuth": azimuth, "tilt": tilt, "rowWidth": width})
    )


@given(
    st.floats(0.0, 360.0),
    st.floats(0.0, 90.0),
    st.floats(1.0, 6.0),
    st.tuples(st.floats(0.0, 1.0), st.floats(-8.0, 8.0), st.floats(-8.0, 8.0)),
)
def test_the_distance_to_a_row_is_that_to_the_nearest_of_its_lines(azimuth, tilt, width, place):
    group = any_group(azimuth, tilt, width, 0.0)
    share, before, up = place
    facing = radians(azimuth)
    here = (share * group.end[0] + before * sin(facing), share * group.end[1] + before * cos(facing), up)
    lines = [group.row(1, (step / 400.0 - 0.5) * width) for step in range(401)]
    points = [tuple(a + share * (b - a) for a, b in zip(*line, strict=True)) for line in lines]
    sampled = min(dist(here, point) for point in points)
    assert panel_distance(group, 1, here) == pytest.approx(sampled, abs=width / 400.0)


@given(st.floats(-5.0, 5.0), st.floats(0.0, 1.0))
def test_a_row_that_climbs_is_as_near_all_along(climb, share):
    group = any_group(180.0, 30.0, 4.0, climb)
    places = [(at * group.end[0], at * group.end[1] - 2.0, at * climb + 5.0) for at in (0.0, share)]
    near, same = (panel_distance(group, 1, place) for place in places)
    assert near == pytest.approx(same, abs=1e-6)


def test_the_row_in_front_is_told_where_it_is_the_one_that_is_too_near(robot, group):
    steep = laid_out(group(tilt=60.0, pitch=5.0))
    place = (50.0, steep.row(2)[0][1] - 4.5, 1.5)
    with pytest.raises(InfeasibleError, match=r"it comes .* m too near to the panels of row 1"):
        refuse_near(robot(), steep, place, "it")


@given(north=st.floats(-10.0, 40.0), up=st.floats(0.0, 5.0), clearance=st.floats(0.1, 6.0))
def test_a_place_is_refused_if_any_row_is_too_near(robot, group, north, up, clearance):
    laid, place = laid_out(group()), (50.0, north, up)
    near = min(panel_distance(laid, row, place) for row in range(1, laid.rows + 1))
    try:
        refuse_near(replace(robot(), clearance=clearance), laid, place, "it")
    except InfeasibleError:
        assert near < clearance
    else:
        assert near >= clearance - 1e-5


def test_a_place_that_keeps_the_clearance_is_no_fault(robot, group):
    flat = laid_out(group(tilt=0.0))
    maker = replace(robot(), clearance=2.0)
    assert refuse_near(maker, flat, (50.0, 0.0, 3.5), "it") is None
    with pytest.raises(InfeasibleError, match=r"it comes 0\.01 m too near"):
        refuse_near(maker, flat, (50.0, 0.0, 3.49), "it")
