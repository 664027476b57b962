from math import cos, dist, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mmrs_solar.groups import group_of, laid_out, outlines_of

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Part


def test_the_first_row_is_above_the_points(group):
    assert laid_out(group()).row(1) == ((0.0, 0.0, 1.5), (100.0, 0.0, 1.5))


def test_other_rows_stand_behind_the_first_seen_from_where_the_panels_face(group):
    begin, end = laid_out(group()).row(3)
    assert begin == pytest.approx((0.0, 16.0, 1.5))
    assert end == pytest.approx((100.0, 16.0, 1.5))


def test_a_panel_is_found_by_row_column_and_tier(group):
    middle = laid_out(group()).panel(2, 1, 2)
    assert middle == pytest.approx((1.0, 8.0 + cos(radians(30.0)), 1.5 + 0.5))


def test_panels_of_one_tier_are_in_the_middle_of_the_row(group):
    assert laid_out(group(tiers=1)).panel(1, 50, 1) == pytest.approx((99.0, 0.0, 1.5))


@pytest.mark.parametrize("address", [(0, 1, 1), (5, 1, 1), (1, 51, 1), (1, 1, 3)])
def test_a_panel_that_is_not_there_is_refused_by_its_address(group, address):
    with pytest.raises(InfeasibleError, match=f"row {address[0]}, column {address[1]}, tier {address[2]}"):
        laid_out(group()).panel(*address)


@given(st.floats(0.0, 360.0), st.floats(0.0, 90.0), st.floats(0.5, 8.0))
def test_upper_and_lower_edge_are_a_row_width_apart_in_the_plane_of_the_panels(azimuth, tilt, width):
    attributes = {
        "name": "any",
        "points": ((0.0, 0.0, 0.0), (10.0 * cos(radians(azimuth)), -10.0 * sin(radians(azimuth)), 0.0)),
        "azimuth": azimuth,
        "tilt": tilt,
        "rowWidth": width,
    }
    laid = laid_out(Part((), attributes))
    (lower, _), (upper, _) = laid.row(1, -width / 2), laid.row(1, width / 2)
    assert dist(lower, upper) == pytest.approx(width)
    assert upper[2] - lower[2] == pytest.approx(width * sin(radians(tilt)))


def test_more_rows_than_anybody_could_tell_apart_are_one_outline(group):
    (outline,) = outlines_of(group(rows=2_000_000_000, tilt=0.0))
    assert outline[2] == pytest.approx((100.0, 1_999_999_999 * 8.0 + 2.0))


def test_each_row_is_an_outline_on_the_map(group):
    outlines = outlines_of(group())
    half = 2.0 * cos(radians(30.0))
    assert len(outlines) == 4
    corners = [(0.0, -half), (100.0, -half), (100.0, half), (0.0, half)]
    assert all(dist(one, other) < 1e-9 for one, other in zip(outlines[0], corners, strict=True))


@pytest.mark.parametrize("name", ["azimuth", "tilt", "rowWidth", "pitch", "points"])
def test_a_group_that_lacks_a_figure_is_refused_and_has_no_outline(group, name):
    with pytest.raises(InfeasibleError, match="panel group 'south'"):
        laid_out(group(**{name: None}))
    assert outlines_of(group(**{name: None})) == ()


def test_one_row_needs_no_pitch(group):
    assert laid_out(group(rows=1, pitch=None)).rows == 1


def test_a_task_finds_its_group_among_other_elements(scene, group):
    pole = Part((("urn:other:1.0", "Pole"),), {"name": "south"})
    found = group_of(Part((), {"group": "south"}), scene(groups=(pole, group())))
    assert found.azimuth == 180.0


@pytest.mark.parametrize(("count", "told"), [(0, "no panel groups"), (2, "2 panel groups")])
def test_a_group_must_be_one_of_its_name(scene, group, count, told):
    with pytest.raises(InfeasibleError, match=f"{told} of the context are called 'south'"):
        group_of(Part((), {"group": "south"}), scene(groups=(group(),) * count))
