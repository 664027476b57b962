"""Borders that hold no area are drawn around their vertices."""

from math import cos, radians

import pytest
from shapely.geometry import Point, Polygon

from mmrs_core.migration.building.shapes import METRES_PER_DEGREE, widened


def flat(corners, north, east):
    """Return corners as metres east and north of a place."""
    scale = METRES_PER_DEGREE * cos(radians(north))
    return [((y - east) * scale, (x - north) * METRES_PER_DEGREE) for x, y in corners]


def test_a_border_with_an_area_stays_as_it_is():
    assert widened(((46.0, 11.0), (46.001, 11.0), (46.001, 11.001)), 1.0) is None


@pytest.mark.parametrize("north", [0.0, 46.0, -70.0])
def test_a_point_becomes_a_square(north):
    ring = Polygon(flat(widened(((north, 11.0),), 2.0), north, 11.0))
    assert ring.area == pytest.approx(16.0, rel=1e-6)
    assert ring.centroid.distance(Point(0, 0)) == pytest.approx(0.0, abs=1e-6)


def test_a_line_becomes_a_strip_that_holds_all_its_vertices():
    corners = ((46.0, 11.0), (46.001, 11.001), (46.0005, 11.0005))
    ring = Polygon(flat(widened(corners, 1.0), 46.0, 11.0))
    assert ring.is_valid
    assert all(ring.contains(Point(corner)) for corner in flat(corners, 46.0, 11.0))
    assert ring.area == pytest.approx(
        2.0 * (Point(flat(corners, 46.0, 11.0)[1]).distance(Point(0, 0)) + 2), rel=0.01
    )
