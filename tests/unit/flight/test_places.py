"""Distances against an independent implementation: PROJ's geodesics."""

from __future__ import annotations

import pytest
from pyproj import Geod

from mmrs_core.flight import Geographic
from mmrs_core.flight.places import bearing, distance


@pytest.mark.parametrize("latitude", [0.0, 42.37, -33.9, 65.0, 80.0])
@pytest.mark.parametrize(("north", "east"), [(0.004, 0.0), (0.0, 0.006), (0.003, -0.004)])
def test_distances_and_directions_are_those_on_the_ellipsoid(latitude, north, east):
    azimuth, _, metres = Geod(ellps="WGS84").inv(13.35, latitude, 13.35 + east, latitude + north)
    a, b = Geographic(latitude, 13.35, 10.0), Geographic(latitude + north, 13.35 + east, 10.0)
    assert distance(a, b) == pytest.approx(metres, rel=2e-6)
    assert distance(a, b) == distance(b, a)
    assert abs((bearing(a, b) - azimuth + 180.0) % 360.0 - 180.0) < 0.05
