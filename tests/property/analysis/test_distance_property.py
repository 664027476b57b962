"""Exact distances against sampling, against another implementation, and under motions of the scene."""

from math import cos, inf, pi, sin

import numpy as np
import pytest
import shapely
from counts import many
from hypothesis import given, settings
from hypothesis import strategies as st

from mmrs_core.analysis.distance import contains, prism_distances, segment_distance, segment_distances
from mmrs_core.geometry.segments import prism_distance

LENGTHS = st.floats(-50.0, 50.0).map(lambda x: round(x, 3))
POINTS = st.tuples(LENGTHS, LENGTHS, LENGTHS)
SIZES = st.floats(1.0, 20.0).map(lambda x: round(x, 3))


@st.composite
def rings(draw):
    """Draw a star-shaped polygon, mostly concave."""
    number = draw(st.integers(3, 9))
    e, n = draw(LENGTHS), draw(LENGTHS)
    radii = draw(st.lists(SIZES, min_size=number, max_size=number))
    turn = 2 * pi / number
    return tuple((e + r * cos(i * turn), n + r * sin(i * turn)) for i, r in enumerate(radii))


@st.composite
def bands(draw):
    """Draw lower and upper side of a prism, either of which may be unlimited."""
    low = draw(st.one_of(st.just(-inf), LENGTHS))
    high = draw(st.one_of(st.just(inf), SIZES.map(lambda size: (0.0 if low == -inf else low) + size)))
    return low, high


def distance(a, b, ring, low, high):
    return float(prism_distances(np.array([a]), np.array([b]), ring, low, high)[0])


def sampled(a, b, ring, low, high, number=2001):
    part = np.linspace(0.0, 1.0, number)[:, None]
    points = np.asarray(a) + part * (np.asarray(b) - np.asarray(a))
    level = shapely.distance(shapely.points(points[:, :2]), shapely.Polygon(ring))
    upright = np.maximum(np.maximum(low - points[:, 2], points[:, 2] - high), 0.0)
    return float(np.hypot(level, upright).min())


@settings(max_examples=many(750))
@given(POINTS, POINTS, rings(), bands())
def test_no_point_of_a_leg_is_nearer_than_the_exact_distance_and_one_is_as_near(a, b, ring, band):
    exact = distance(a, b, ring, *band)
    near = sampled(a, b, ring, *band)
    step = float(np.linalg.norm(np.subtract(b, a))) / 2000
    assert exact - 1e-9 <= near <= exact + step / 2 + 1e-9


@settings(max_examples=many(750))
@given(POINTS, POINTS, rings(), bands())
def test_two_implementations_agree(a, b, ring, band):
    other = float(prism_distance([[a, b]], ring, *band)[0])
    assert distance(a, b, ring, *band) == pytest.approx(other, abs=1e-6)


@settings(max_examples=many(500))
@given(POINTS, POINTS, rings(), bands(), POINTS, st.floats(0.0, 2 * pi))
def test_moving_and_turning_the_whole_scene_changes_nothing(a, b, ring, band, by, angle):
    def moved(point):
        e, n = point[0] * cos(angle) - point[1] * sin(angle), point[0] * sin(angle) + point[1] * cos(angle)
        return (e + by[0], n + by[1], *(up + by[2] for up in point[2:]))

    low, high = band[0] + by[2], band[1] + by[2]
    turned = distance(moved(a), moved(b), tuple(moved(corner) for corner in ring), low, high)
    assert turned == pytest.approx(distance(a, b, ring, *band), abs=1e-6)


@settings(max_examples=many(500))
@given(POINTS, POINTS, rings(), bands())
def test_the_way_back_is_as_near_as_the_way_there(a, b, ring, band):
    assert distance(a, b, ring, *band) == pytest.approx(distance(b, a, ring, *band), abs=1e-9)


@settings(max_examples=many(500))
@given(st.tuples(LENGTHS, LENGTHS), rings())
def test_points_inside_a_polygon_are_told_from_those_outside(point, ring):
    polygon = shapely.Polygon(ring)
    if polygon.exterior.distance(shapely.Point(point)) > 1e-9:
        assert bool(contains(np.array(ring), np.array([point]))[0]) == polygon.contains(shapely.Point(point))


@settings(max_examples=many(750))
@given(POINTS, POINTS, POINTS, POINTS)
def test_segments_are_as_near_as_their_nearest_samples(p, q, c, d):
    exact = float(segment_distances(*(np.array([point]) for point in (p, q, c, d)))[0, 0])
    part = np.linspace(0.0, 1.0, 201)[:, None]
    first, second = np.array(p) + part * np.subtract(q, p), np.array(c) + part * np.subtract(d, c)
    near = float(np.sqrt(((first[:, None] - second[None]) ** 2).sum(axis=2).min()))
    step = (float(np.linalg.norm(np.subtract(q, p))) + float(np.linalg.norm(np.subtract(d, c)))) / 400
    assert exact - 1e-9 <= near <= exact + step + 1e-9


def test_many_legs_are_looked_at_in_pieces_with_the_same_result():
    generator = np.random.default_rng(7)
    begins, ends = generator.uniform(-50, 50, (2, 40_000, 3))
    ring = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))
    whole = prism_distances(begins, ends, ring, 0.0, 20.0)
    assert whole[-5:].tolist() == prism_distances(begins[-5:], ends[-5:], ring, 0.0, 20.0).tolist()


def test_no_legs_have_no_distances():
    empty = np.empty((0, 3))
    assert prism_distances(empty, empty, ((0, 0), (1, 0), (0, 1)), 0.0, 1.0).size == 0


@settings(max_examples=many(750))
@given(POINTS, POINTS, POINTS, POINTS)
def test_one_pair_of_segments_is_as_far_apart_as_among_many(p, q, c, d):
    arrays = (np.array([each]) for each in (p, q, c, d))
    assert segment_distance(p, q, c, d) == pytest.approx(float(segment_distances(*arrays)[0, 0]), abs=1e-9)
