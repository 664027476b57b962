"""Latitudes and longitudes in metres east and north."""

from math import hypot

import pytest
from grounded import faults, geo, point_of, relative, scene, simple

from mmrs_core.languages import context


def test_geographic_coordinates_in_a_local_mission_are_refused(registry):
    assert "local one" in faults(simple(registry, relative(), point=geo()))[0]


def test_unknown_crs_is_refused(registry):
    assert "EPSG:1" in faults(simple(registry, geo(), crs="EPSG:1"))[0]


def test_context_in_another_crs_lands_where_the_mission_sees_it(registry):
    # ED50 to WGS 84: the datum shift moves the same numbers by more than 100 m
    corners = [geo(42.37, 13.35), geo(42.371, 13.35), geo(42.371, 13.351)]
    place = context.Context(crs="EPSG:4230", forbiddenAreas=[context.Area(shell=corners)])
    shifted = scene(simple(registry, geo()), place).areas[0].shell[0]
    assert 80 < hypot(*shifted) < 250


def test_latitude_beyond_the_pole_is_refused(registry):
    assert "-90 to 90" in faults(simple(registry, geo(), point=geo(91.0)))[0]


def test_coordinate_that_cannot_be_projected_is_refused_by_name(registry):
    found = faults(simple(registry, geo(0.0, 0.0), point=geo(0.0, 90.0)))
    assert found[0].startswith("GeoCoordinate tasks[0]/point cannot be placed")


@pytest.mark.parametrize("latitude", [-77.8, 0.0, 42.37, 69.6])
@pytest.mark.parametrize(("north", "east"), [(0.03, 0.0), (0.0, 0.05), (-0.02, 0.04)])
def test_distances_are_those_on_the_ellipsoid(registry, latitude, north, east):
    from pyproj import Geod

    far = geo(latitude + north, 13.35 + east)
    x, y, _ = point_of(simple(registry, geo(latitude, 13.35), point=far))
    *_, metres = Geod(ellps="WGS84").inv(13.35, latitude, 13.35 + east, latitude + north)
    assert hypot(x, y) == pytest.approx(metres, abs=0.02)
