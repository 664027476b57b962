"""Borders that bound no area are mended, and what is drawn for them holds all their vertices."""

from math import cos, radians

import pytest
from mmrs_flyaq.building.borders import METRES_PER_DEGREE, border_of
from shapely.geometry import Point, Polygon


def flat(corners, north, east):
    """Return corners as metres east and north of a place."""
    scale = METRES_PER_DEGREE * cos(radians(north))
    return [((y - east) * scale, (x - north) * METRES_PER_DEGREE) for x, y in corners]


@pytest.mark.parametrize(
    "corners",
    [
        ((46.0, 11.0), (46.001, 11.0), (46.001, 11.001)),
        ((46.0, 11.0), (46.001, 11.0), (46.001, 11.001), (46.0005, 11.0002)),
    ],
)
def test_a_border_with_an_area_stays_as_it_is(corners):
    assert border_of(corners, 1.0) is None


@pytest.mark.parametrize("north", [0.0, 46.0, -70.0])
def test_a_point_becomes_a_square(north):
    ring = Polygon(flat(border_of(((north, 11.0),), 2.0).corners, north, 11.0))
    assert ring.area == pytest.approx(16.0, rel=1e-6)
    assert ring.centroid.distance(Point(0, 0)) == pytest.approx(0.0, abs=1e-6)


def test_a_line_becomes_a_strip_that_holds_all_its_vertices():
    corners = ((46.0, 11.0), (46.001, 11.001), (46.0005, 11.0005))
    ring = Polygon(flat(border_of(corners, 1.0).corners, 46.0, 11.0))
    assert ring.is_valid
    assert all(ring.contains(Point(corner)) for corner in flat(corners, 46.0, 11.0))
    assert ring.area == pytest.approx(
        2.0 * (Point(flat(corners, 46.0, 11.0)[1]).distance(Point(0, 0)) + 2), rel=0.01
    )


def test_corners_that_lie_nearly_on_a_line_are_all_held():
    corners = ((45.3, 34.3), (45.2, 34.2), (45.0, 34.0))
    ring = Polygon(border_of(corners, 1.0).corners)
    assert all(ring.contains(Point(corner)) for corner in corners)


def test_a_border_that_crosses_itself_becomes_the_hull_of_its_lobes():
    mended = border_of(((46.0, 11.0), (46.001, 11.001), (46.0, 11.001), (46.001, 11.0)), 1.0)
    assert set(mended.corners) == {(46.0, 11.0), (46.001, 11.001), (46.0, 11.001), (46.001, 11.0)}
    assert mended.reason.startswith("the border crosses or touches itself")


@pytest.mark.parametrize("corner", [(90.0, 0.0), (-90.0, 12.0), (0.0, 180.0), (45.0, -180.0)])
def test_a_border_at_the_edge_of_the_map_stays_on_it(corner):
    ring = Polygon(border_of((corner,), 1.0).corners)
    assert ring.covers(Point(corner))
    assert max(abs(north) for north, _ in ring.exterior.coords) <= 90.0
    assert max(abs(east) for _, east in ring.exterior.coords) <= 180.0
