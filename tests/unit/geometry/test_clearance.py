import numpy as np
import pytest
import shapely

from mmrs_core.geometry.clearance import circle_about, grow, shrink

SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))


def test_the_circle_in_pieces_holds_the_true_circle():
    drawn = shapely.Polygon(circle_about(5.0))
    assert drawn.exterior.distance(shapely.Point(0.0, 0.0)) == pytest.approx(5.0)


def test_every_point_of_the_grown_edge_keeps_the_distance():
    edge = grow(SQUARE, 5.0).exterior
    points = shapely.line_interpolate_point(edge, np.linspace(0.0, edge.length, 5000))
    assert shapely.distance(points, shapely.Polygon(SQUARE)).min() >= 5.0


@pytest.mark.parametrize("seed", range(20))
def test_corners_of_any_angle_keep_the_distance(seed):
    rng = np.random.default_rng(seed)
    turns = np.sort(rng.uniform(0.0, 2 * np.pi, int(rng.integers(3, 9))))
    ring = rng.uniform(3.0, 25.0, (len(turns), 1)) * np.c_[np.cos(turns), np.sin(turns)]
    edge = grow([tuple(corner) for corner in ring], 4.0).exterior
    points = shapely.line_interpolate_point(edge, np.linspace(0.0, edge.length, 3000))
    assert shapely.distance(points, shapely.Polygon(ring)).min() >= 4.0


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
