from math import cos, pi

import numpy as np
import pytest
import shapely

from mmrs_core.geometry.clearance import circumscribed, grow, shrink

SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))


def test_the_circle_in_pieces_holds_the_true_circle():
    radius = circumscribed(5.0, 2)
    assert radius * cos(pi / 8) == pytest.approx(5.0)


def test_every_point_of_the_grown_edge_keeps_the_distance():
    edge = grow(SQUARE, 5.0).exterior
    points = shapely.line_interpolate_point(edge, np.linspace(0.0, edge.length, 5000))
    assert shapely.distance(points, shapely.Polygon(SQUARE)).min() >= 5.0


def test_growing_gives_little_away():
    edge = grow(SQUARE, 5.0)
    assert shapely.hausdorff_distance(edge.exterior, shapely.Polygon(SQUARE).exterior) < 5.0 * 1.006 + 0.002


def test_shrinking_keeps_the_distance_from_the_edge():
    rest = shrink(SQUARE, 3.0)
    assert 0 < rest.area <= 16.0
    assert shapely.distance(shapely.boundary(rest), shapely.Polygon(SQUARE).exterior) >= 3.0


def test_nothing_is_left_of_an_area_that_is_too_small():
    assert shrink(SQUARE, 5.0).is_empty


def test_a_court_within_a_bent_ring_stays_open():
    ring = ((0, 0), (60, 0), (60, 60), (31, 60), (31, 50), (50, 50), (50, 10), (10, 10), (10, 50), (29, 50))
    grown = grow((*ring, (29, 60), (0, 60)), 3.0)
    assert len(grown.interiors) == 1


def test_a_negative_distance_is_refused():
    with pytest.raises(ValueError, match="-1"):
        grow(SQUARE, -1.0)
    with pytest.raises(ValueError, match="-1"):
        shrink(SQUARE, -1.0)
