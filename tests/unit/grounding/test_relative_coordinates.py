"""Coordinates in metres from another place."""

import pytest
from grounded import faults, geo, point_of, relative, scene, simple

from mmrs_core.languages import context


def test_relative_coordinates_count_from_the_origin(registry):
    assert point_of(simple(registry, geo(altitude=700.0))) == (1.0, 2.0, 3.0)


def test_relative_coordinates_count_from_their_reference_through_a_chain(registry):
    first = geo(altitude=700.0)
    second = relative(10.0, 0.0, 1.0, reference=first)
    assert point_of(simple(registry, first, second, point=relative(1, 1, 1, reference=second))) == (11, 1, 2)


def test_relative_coordinates_of_a_context_count_from_its_own_origin(registry):
    corners = [relative(0, 0), relative(10, 0), relative(10, 10)]
    place = context.Context(origin=geo(42.371), forbiddenAreas=[context.Area(shell=corners)])
    area = scene(simple(registry, geo()), place).areas[0]
    assert area.shell[2] == pytest.approx((10.0, 121.08), abs=0.01)


def test_origin_of_a_context_may_count_from_that_of_the_mission(registry):
    corners = [relative(0, 0), relative(10, 0), relative(10, 10)]
    place = context.Context(origin=relative(100, 0, 7), obstacles=[context.Obstacle(shell=corners)])
    assert scene(simple(registry, geo()), place).areas[0].shell[0] == (100.0, 0.0)


def test_relative_coordinates_in_a_circle_are_refused(registry):
    one, two = relative(1.0), relative(2.0)
    one.reference, two.reference = two, one
    found = faults(simple(registry, geo(), one, point=two))
    assert "cycle" in found[0]


def test_coordinate_beside_a_circle_says_what_it_counts_from(registry):
    one, two = relative(1.0), relative(2.0)
    one.reference, two.reference = two, two
    found = faults(simple(registry, geo(), one, point=two))
    assert sorted("cycle" in each for each in found) == [False, True]


def test_relative_origin_makes_a_local_mission(registry):
    found = scene(simple(registry, relative(5.0, 6.0), origin=relative()))
    assert found.frame.is_local
    assert found.robots[0].home == (5.0, 6.0, 0.0)


def test_relative_home_alone_counts_from_the_origin_of_a_local_mission(registry):
    found = scene(simple(registry, relative(5.0, 6.0)))
    assert found.frame.is_local
    assert found.robots[0].home == (5.0, 6.0, 0.0)


def test_relative_origin_elsewhere_than_at_the_origin_is_refused(registry):
    assert "x = y = z = 0" in faults(simple(registry, relative(), origin=relative(1.0)))[0]
