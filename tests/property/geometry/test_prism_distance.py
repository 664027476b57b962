"""The closed form against brute force."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from mmrs_core.geometry.segments import nearest_to_prism

coordinate = st.floats(-50, 50).map(lambda value: round(value, 3))
point = st.tuples(coordinate, coordinate, coordinate)


@st.composite
def star(draw):
    count = draw(st.integers(3, 9))
    radii = draw(st.lists(st.floats(1, 30), min_size=count, max_size=count))
    angles = np.linspace(0.0, 2 * np.pi, count, endpoint=False) + draw(st.floats(0, 1))
    return np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])


def sampled(begin, end, ring, low, high, count=2001):
    places = np.linspace(begin, end, count)
    sideways = shapely.distance(shapely.points(places[:, :2]), shapely.Polygon(ring))
    upright = np.abs(places[:, 2] - np.clip(places[:, 2], low, high))
    return np.hypot(sideways, upright).min()


@settings(max_examples=150, deadline=None)
@given(point, point, star(), st.floats(-30, 30), st.floats(0, 40))
def test_distance_is_the_least_of_all_points_of_the_leg(begin, end, ring, low, height):
    high = low + height
    distance, place = nearest_to_prism([[begin, end]], ring, low, high)
    step = float(np.linalg.norm(np.subtract(end, begin))) / 2000
    brute = sampled(begin, end, ring, low, high)
    assert distance[0] <= brute + 1e-9
    assert distance[0] >= brute - step - 1e-9
    assert abs(sampled(place[0], place[0], ring, low, high, 1) - distance[0]) < 1e-6
