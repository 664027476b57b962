"""The ground that a stroke covers."""

import pytest
from shapely.geometry import Polygon

from mmrs_core.pictures.preview.from_plan import along, footprints
from mmrs_core.scene import ActionAt, Coverage, Stroke

SHELL = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
EAST = ((0.0, 0.0, 5.0), (30.0, 0.0, 5.0))


def coverage(width, length):
    return Coverage(SHELL, (), (), width, length)


def test_an_action_covers_a_rectangle_around_it_along_the_way():
    stroke = Stroke(EAST, (ActionAt(10.0, "Photo"),))
    (ring,) = footprints(stroke, coverage(8.0, 4.0))
    assert Polygon(ring).bounds == pytest.approx((8.0, -4.0, 12.0, 4.0))


def test_a_strip_covers_each_leg_where_actions_do_not_matter():
    bent = Stroke(((0.0, 0.0, 5.0), (30.0, 0.0, 5.0), (30.0, 20.0, 5.0)))
    rings = list(footprints(bent, coverage(8.0, 0.0)))
    assert [Polygon(ring).area for ring in rings] == pytest.approx([240.0, 160.0])


def test_rectangles_turn_the_same_way_whatever_the_way():
    points = [(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (0.0, 5.0, 0.0), (-7.0, -9.0, 0.0), (1.0, 1.0, 0.0)]
    rings = footprints(Stroke(tuple(points)), coverage(2.0, 0.0))
    assert {Polygon(ring).exterior.is_ccw for ring in rings} == {True}


def test_a_climb_covers_no_strip():
    assert list(footprints(Stroke(((0.0, 0.0, 0.0), (0.0, 0.0, 9.0))), coverage(2.0, 0.0))) == []


def test_an_action_at_a_single_point_has_a_footprint():
    (ring,) = footprints(Stroke(((3.0, 4.0, 5.0),), (ActionAt(0.0, "Photo"),)), coverage(2.0, 2.0))
    assert Polygon(ring).bounds == pytest.approx((2.0, 3.0, 4.0, 5.0))


@pytest.mark.parametrize(("at", "east"), [(-5.0, 0.0), (0.0, 0.0), (12.0, 12.0), (30.0, 30.0), (99.0, 30.0)])
def test_positions_beyond_the_ends_are_the_ends(at, east):
    assert along(EAST, at)[0] == pytest.approx((east, 0.0, 5.0))
