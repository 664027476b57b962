"""How near a robot came to areas, as drawn."""

import numpy as np
import pytest
from shapely.geometry import LineString, Polygon

from mmrs_core.pictures.flights.positions import Locator
from mmrs_core.pictures.report.distances import approaches_of
from mmrs_core.scene import Area, AreaUse, Frame

SQUARE = ((10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0))
SCHOOL = Area("school", AreaUse.FORBIDDEN, SQUARE, safety_distance=3.0)
TOWER = Area("tower", AreaUse.OBSTACLE, SQUARE, 0.0, 30.0)
PLACES = Locator(Frame("EPSG:4326", None, None))


def nearest(track, *areas, own=0.5):
    return {found.area: found for found in approaches_of("alpha", track, areas, own, PLACES.of)}


def test_between_two_fixes_a_robot_may_be_nearer_than_at_either(make):
    found = nearest(make.track([(0, 0, 5, 9), (1, 40, 5, 9)]), SCHOOL)["school"]
    assert found.kept == pytest.approx(5.0)
    assert found.required == 3.5
    assert not found.too_near


def test_nearer_than_required_is_too_near(make):
    found = nearest(make.track([(0, 0, 7, 9), (1, 40, 7, 9)]), SCHOOL)["school"]
    assert found.too_near
    assert found.where.position[1] == pytest.approx(7.0)


def test_the_position_error_may_be_used_up(make):
    track = make.track([(0, 0, 6.8, 9), (1, 40, 6.8, 9)])
    (found,) = approaches_of("alpha", track, [SCHOOL], 0.5, PLACES.of, 0.4)
    assert (found.too_near, found.within_error) == (False, True)
    (found,) = approaches_of("alpha", track, [SCHOOL], 0.5, PLACES.of, 0.2)
    assert (found.too_near, found.within_error) == (True, False)


@pytest.mark.parametrize(
    ("points", "broken", "area", "kept"),
    [
        ([(0, 15, 15, 9), (1, 16, 16, 9)], (), SCHOOL, 0.0),
        ([(0, 0, 15, 42), (1, 40, 15, 42)], (), TOWER, 12.0),
        ([(0, 0, 15, 9), (9, 40, 15, 9)], [0], SCHOOL, 10.0),
        ([(0, 0, 15, 9)], (), SCHOOL, 10.0),
    ],
    ids=["inside", "above an obstacle", "unknown between the ends of a gap", "a lone fix"],
)
def test_the_closest_approach_is_measured_in_three_dimensions_as_far_as_it_is_known(
    make, points, broken, area, kept
):
    assert nearest(make.track(points, broken=broken), area)[area.name].kept == pytest.approx(kept)


def test_emergency_areas_are_not_kept_off(make):
    meadow = Area("meadow", AreaUse.EMERGENCY, SQUARE)
    assert nearest(make.track([(0, 0, 15, 9)]), meadow) == {}


def test_without_a_track_nothing_is_told(make):
    assert nearest(make.track([]), SCHOOL) == {}


def test_what_is_required_of_an_unknown_robot_is_not_known(make):
    found = nearest(make.track([(0, 12, 12, 9)]), SCHOOL, own=None)["school"]
    assert found.required is None
    assert not found.too_near


def test_long_ways_agree_with_shapely(make):
    generator = np.random.default_rng(3)
    points = generator.uniform(-200.0, 200.0, (4000, 2)) + np.array([300.0, 0.0])
    found = nearest(make.track([(i, *point, 9.0) for i, point in enumerate(points)]), SCHOOL)["school"]
    assert found.kept == pytest.approx(LineString(points).distance(Polygon(SQUARE)), abs=1e-6)
