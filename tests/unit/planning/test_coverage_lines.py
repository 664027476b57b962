"""Where swaths go and where along them something is done."""

from math import pi

import numpy as np
import pytest
import shapely
import shapely.affinity

from mmrs_core.planning.footprints import needed, uncovered_by
from mmrs_core.planning.levels import legs_over
from mmrs_core.planning.lines import Swath, spots_over
from mmrs_core.planning.slabs import Band, Cell
from mmrs_core.planning.strips import swaths_along_x
from mmrs_core.planning.swaths import _Reach, _repaired, swaths

FIELD = shapely.box(0, 0, 60, 12)


def comb(teeth, tooth, gap, depth):
    """A comb with a back below."""
    back = shapely.box(0, 0, teeth * (tooth + gap) - gap, 12)
    return shapely.union_all(
        [back, *(shapely.box(i * (tooth + gap), 12, i * (tooth + gap) + tooth, depth) for i in range(teeth))]
    )


def ragged(noise, corners=400, radius=150.0):
    rng = np.random.default_rng(5)
    angles = np.linspace(0.0, 2 * np.pi, corners, endpoint=False)
    radii = radius + rng.uniform(-noise, noise, corners)
    return shapely.Polygon(np.c_[radii * np.cos(angles), radii * np.sin(angles)])


def spots(lines):
    return sum(len(line.spots) for line in lines)


@pytest.mark.parametrize("count", [1, 3, 10])
def test_lengths_that_fit_exactly_touch(count):
    assert spots_over([(5.0, 5.0 + 4.0 * count)], 4.0) == pytest.approx([7.0 + 4.0 * i for i in range(count)])


def test_a_need_a_little_longer_takes_one_more_and_shares_the_overlap():
    assert spots_over([(0.0, 10.0)], 9.0) == pytest.approx([2.5, 7.5])


def test_one_length_covers_needs_on_both_sides_of_a_gap():
    assert spots_over([(0.0, 3.0), (6.0, 9.0)], 9.0) == pytest.approx([4.5])


def test_nothing_is_done_in_a_gap_longer_than_a_length():
    assert spots_over([(0.0, 3.0), (50.0, 53.0)], 9.0) == pytest.approx([1.5, 51.5])


def test_a_swath_with_actions_runs_from_the_first_to_the_last():
    (line,) = swaths_along_x([FIELD], 12.0, length=12.0)
    assert line.points.tolist() == pytest.approx(np.array([[6.0, 6.0], [54.0, 6.0]]))
    assert line.spots == pytest.approx((0.0, 12.0, 24.0, 36.0, 48.0))


def test_a_swath_that_covers_by_itself_runs_from_edge_to_edge():
    (line,) = swaths_along_x([FIELD], 12.0)
    assert line.points.tolist() == pytest.approx(np.array([[0.0, 6.0], [60.0, 6.0]]))
    assert line.spots == ()


def test_a_single_action_that_sees_all_whichever_way_it_faces_is_a_point():
    (line,) = swaths_along_x([shapely.box(0, 0, 8, 8)], 12.0, length=12.0)
    assert line.points.tolist() == pytest.approx(np.array([[4.0, 4.0]]))
    assert line.spots == (0.0,)


def test_a_single_action_that_must_face_along_its_swath_is_reached_along_it():
    (line,) = swaths_along_x([shapely.box(0, 0, 12, 12)], 12.0, length=12.0)
    assert line.points.tolist() == pytest.approx(np.array([[5.5, 6.0], [6.0, 6.0]]))
    assert line.spots == pytest.approx((0.5,))


def test_the_way_to_a_single_action_is_from_the_side_that_is_clear():
    closed = shapely.box(-20, -20, 5.9, 40)
    (line,) = swaths_along_x([shapely.box(5.9, 0, 6.1, 20)], 20.0, length=12.0, closed=closed)
    assert line.points[:, 0].tolist() == pytest.approx([6.5, 6.0])


def test_teeth_with_narrow_gaps_are_crossed_by_straight_swaths():
    field = comb(8, 6.0, 6.0, 72.0)
    lines = swaths([field], 12.0, length=12.0, angle=0.0)
    assert len(lines) == 6
    assert all(len(line.points) == 2 for line in lines)
    assert uncovered_by([field], lines, 12.0, 12.0).area < 1e-6


@pytest.mark.parametrize("length", [0.0, 4.0])
def test_legs_aside_cover_nothing_in_the_direction_of_their_swath(length):
    step = Swath(np.array([[2.0, 2.0], [20.0, 2.0], [20.0, 22.0], [38.0, 22.0]]), tuple(range(0, 57, 2)))
    field = shapely.box(18.0, 6.0, 22.0, 18.0)
    assert uncovered_by([field], [step], 4.0, length).area < 1e-6
    assert uncovered_by([field], [step], 4.0, length, pi / 2.0).area < 1e-6
    assert uncovered_by([field], [step], 4.0, length, 0.0).area > 0.9 * field.area
    assert uncovered_by([field], [step, *swaths([field], 4.0, angle=0.0)], 4.0, 0.0, pi).area < 1e-6


def test_photos_that_show_nothing_but_what_others_show_are_not_made():
    row = Swath(np.array([[4.98, 5.0], [25.0, 5.0]]), (0.0, 0.02, 10.02, 20.02))
    again = Swath(np.array([[15.004, 9.0], [15.004, 5.0]]), (4.0,))
    (line,) = needed([shapely.box(0, 0, 30, 10)], [row, again], 10.0, 10.0)
    assert line.points.tolist() == [[5.0, 5.0], [25.0, 5.0]]
    assert line.spots == pytest.approx((0.0, 10.0, 20.0))


def test_photos_in_a_direction_that_is_asked_for_are_not_made_up_for_by_others():
    row = Swath(np.array([[5.0, 5.0], [25.0, 5.0]]), (0.0, 10.0, 20.0))
    up = Swath(np.array([[15.0, 9.0], [15.0, 5.004]]), (3.996,))
    only = needed([shapely.box(0, 0, 30, 10)], [row, up], 10.0, 10.0, 0.0)
    assert [line.spots for line in only] == [row.spots]
    across = needed([shapely.box(0, 0, 30, 10)], [row, up], 10.0, 10.0, pi / 2.0)
    assert [line.points[-1].tolist() for line in across][-1] == [15.0, 5.004]


def test_the_only_photo_left_of_a_swath_is_made_from_where_it_was():
    bend = Swath(np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]]), (9.0, 13.0, 18.0))
    line = bend.only([13.0])
    assert (line.points.tolist(), line.spots) == ([[9.0, 0.0], [9.0, 4.0]], (4.0,))


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.7, 2.0])
def test_a_rectangle_of_whole_strips_takes_no_more_of_them_when_turned(angle):
    field = shapely.affinity.rotate(shapely.box(0, 0, 600, 200), angle, (9.0, 7.0), use_radians=True)
    lines = swaths([shapely.set_precision(field, 1e-6)], 20.0)
    assert len(lines) == 10
    assert uncovered_by([field], lines, 20.0, 0.0).area < 1e-5 * field.area


def test_a_gap_much_wider_than_a_strip_is_not_crossed():
    two = [shapely.box(0, 0, 40, 12), shapely.box(100, 0, 140, 12)]
    assert len(swaths(two, 12.0, angle=0.0)) == 2


def test_a_swath_does_not_cross_what_is_closed():
    two = [shapely.box(0, 0, 40, 12), shapely.box(44, 0, 84, 12)]
    assert len(swaths(two, 12.0, angle=0.0)) == 1
    assert len(swaths(two, 12.0, angle=0.0, closed=shapely.box(40, -50, 44, 50))) == 2


def test_a_swath_steps_aside_where_its_middle_is_closed():
    closed = shapely.box(20, 5, 40, 50)
    (line,) = swaths_along_x([shapely.difference(FIELD, closed)], 12.0, closed=closed)
    assert not shapely.LineString(line.points).intersects(shapely.buffer(closed, -1e-3))
    assert line.points[:, 1].min() <= 5.0 < 6.0 == line.points[:, 1].max()


@pytest.mark.parametrize(
    ("noise", "most"),
    [(0.0, 1.1), pytest.param(2.0, 1.15, marks=pytest.mark.thorough), (5.0, 1.25), (15.0, 1.4)],
)
def test_a_ragged_edge_takes_few_more_actions_than_its_area(noise, most):
    field = ragged(noise)
    lines = swaths([field], 12.0, length=12.0)
    assert spots(lines) <= most * field.area / 144.0
    assert uncovered_by([field], lines, 12.0, 12.0).area <= 1e-5 * field.area


def test_a_target_smaller_than_a_centimetre_is_still_visited():
    (line,) = swaths([shapely.box(3, 4, 3.004, 4.004)], 5.0)
    assert line.points[0].tolist() == pytest.approx([3.0, 4.0], abs=0.01)


def test_a_swath_followed_from_its_end_acts_at_the_same_places():
    line = Swath(np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 5.0]]), (0.0, 4.0, 15.0))
    assert line.reversed().spots == (0.0, 11.0, 15.0)
    assert line.reversed().reversed().points.tolist() == line.points.tolist()


def test_a_thin_rising_cell_is_covered_level_by_level():
    band = Band((0.0, 8.0), (2.0, 10.0))
    legs = legs_over([Cell(0.0, 100.0, band, band)], 12.0)
    assert len(legs) > 1
    assert [leg.begin[1] for leg in legs] == [leg.end[1] for leg in legs]
    assert legs[0].begin[0] == 0.0
    assert legs[-1].end[0] == 100.0


def test_a_triangle_whose_flat_side_is_off_by_rounding_has_a_leg():
    band = Band((-378.7143138039397, -398.5425289127978), (-378.7143138039398, -378.7143138039398))
    legs = legs_over([Cell(-254.5, -248.3, band, band)], 20.0)
    assert legs[0].begin[0] == -254.5
    assert legs[-1].end[0] == -248.3


def test_what_swaths_leave_out_is_covered_in_the_direction_that_is_asked_for():
    piece = shapely.box(0, 0, 60, 20)
    first = Swath(np.array([[5.0, 0.0], [5.0, 20.0]]))
    reach = _Reach(10.0, 0.0, shapely.Polygon(), strict=False)
    asked = _repaired([piece], [first], reach, np.pi / 2.0)
    assert all(np.ptp(line.points[:, 0]) < 1e-9 for line in asked)
    assert uncovered_by([piece], asked, 10.0, 0.0).area < 1e-6
    assert len(_repaired([piece], [first], reach, None)) < len(asked)
