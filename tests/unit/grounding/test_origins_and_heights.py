"""Where a mission's origin is, and from where heights count."""

import pytest
from grounded import faults, geo, point_of, scene, simple

from mmrs_core.grounding.scenes import ground_of
from mmrs_core.languages import behaviour, context, mission
from mmrs_core.languages.registry import core_registry


def test_home_of_the_first_robot_is_the_origin_where_the_mission_names_none(registry):
    found = scene(simple(registry, geo(altitude=700.0), geo(42.371, altitude=710.0)))
    assert found.robots[0].home == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert found.robots[1].home == pytest.approx((0.0, 111.08, 10.0), abs=0.01)
    assert (found.frame.latitude, found.frame.altitude) == (42.37, 700.0)


def test_origin_of_the_mission_goes_before_homes(registry):
    found = scene(simple(registry, geo(42.371), origin=geo()))
    assert found.robots[0].home == pytest.approx((0.0, 111.08, 0.0), abs=0.01)


def test_coordinate_without_height_is_at_the_height_of_the_origin(registry):
    assert point_of(simple(registry, geo(altitude=700.0), point=geo()))[2] == 0.0


@pytest.mark.parametrize("reference", ["ELLIPSOID", "MSL"])
def test_altitude_is_counted_from_that_of_the_origin(registry, reference):
    made = simple(registry, geo(altitude=700.0), point=geo(altitude=725.5), altitudeReference=reference)
    assert point_of(made)[2] == 25.5


def test_altitude_above_the_origin_is_taken_as_it_is(registry):
    made = simple(registry, geo(), point=geo(altitude=25.5), altitudeReference="ORIGIN")
    assert point_of(made)[2] == 25.5
    assert scene(made).frame.altitude == 0.0


def test_depth_is_counted_from_the_surface(registry):
    place = context.Context(surfaceHeight=4.0)
    assert point_of(simple(registry, geo(), point=geo(depth=10.0)), place)[2] == -6.0


def test_altitude_needs_an_origin_with_one(registry):
    assert "the origin has none" in faults(simple(registry, geo(), point=geo(altitude=5.0)))[0]


def test_altitude_and_depth_together_are_refused(registry):
    made = simple(registry, geo(altitude=0.0), point=geo(altitude=5.0, depth=5.0))
    assert "both an altitude and a depth" in faults(made)[0]


def test_origin_above_itself_is_refused(registry):
    assert "must be 0" in faults(simple(registry, geo(altitude=3.0), altitudeReference="ORIGIN"))[0]


def test_origin_at_a_depth_that_contradicts_the_surface_is_refused(registry):
    assert "depth of 3 m" in faults(simple(registry, geo(depth=3.0)))[0]


def test_context_is_laid_beside_a_behaviour(registry):
    home = behaviour.GeoCoordinate(latitude=42.37, longitude=13.35)
    made = behaviour.Behaviour(
        targets=[behaviour.RelativeCoordinate(x=3.0, y=4.0), home],
        robots=[behaviour.Robot(id="r1"), behaviour.Robot(id="r2", home=home)],
        surfaceHeight=2.0,
    )
    place = context.Context(origin=geo(42.371), surfaceHeight=9.0, forbiddenAreas=[])
    laid = ground_of(made, place)
    assert laid.positions[home] == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert laid.positions[made.targets[0]] == (3.0, 4.0, 0.0)
    assert laid.positions[place.origin] == pytest.approx((0.0, 111.08, 0.0), abs=0.01)
    assert laid.frame.surface == 2.0


def test_ground_of_half_a_mission_places_what_it_can():
    made = mission.Mission(team=mission.Team(robots=[mission.Robot(home=geo()), mission.Robot()]))
    made.tasks = [core_registry().create("urn:mmrs:mission:1.0", "Fork")]
    assert list(ground_of(made, None).positions) == [made.team.robots[0].home]
