"""Distances against an independent implementation: PROJ's geodesics."""

from __future__ import annotations

import pytest
from pyproj import Geod

from mmrs_mavlink import Geographic
from mmrs_runtime.controllers.geodesy import bearing, between, distance


@pytest.mark.parametrize("latitude", [0.0, 42.37, -33.9, 65.0, 80.0])
@pytest.mark.parametrize(("north", "east"), [(0.004, 0.0), (0.0, 0.006), (0.003, -0.004)])
def test_distances_and_directions_are_those_on_the_ellipsoid(latitude, north, east):
    azimuth, _, metres = Geod(ellps="WGS84").inv(13.35, latitude, 13.35 + east, latitude + north)
    a, b = Geographic(latitude, 13.35, 10.0), Geographic(latitude + north, 13.35 + east, 10.0)
    assert distance(a, b) == pytest.approx(metres, rel=2e-6)
    assert distance(a, b) == distance(b, a)
    assert abs((bearing(a, b) - azimuth + 180.0) % 360.0 - 180.0) < 0.05


def test_a_way_over_the_antimeridian_is_as_short_as_elsewhere():
    a, b = Geographic(-17.0, 179.9999, 5.0), Geographic(-17.0, -179.9999, 5.0)
    assert distance(a, b) == pytest.approx(21.3, abs=0.1)
    assert bearing(a, b) == pytest.approx(90.0)
    assert bearing(b, a) == pytest.approx(270.0)
    assert between(a, b, 0.75) == Geographic(-17.0, pytest.approx(-179.99995), 5.0)


def test_both_names_of_the_antimeridian_are_one_place():
    assert distance(Geographic(0.0, 180.0, 0.0), Geographic(0.0, -180.0, 0.0)) == 0.0
