"""Positions have degrees of WGS 84, whatever the mission's own are."""

import pytest
from pyproj import Transformer

from mmrs_core.pictures.flights.positions import Locator
from mmrs_core.scene import Frame


def test_degrees_of_another_system_become_those_of_wgs_84():
    at = Locator(Frame("EPSG:4277", 51.5, -0.1)).of((0.0, 0.0, 3.0))
    expected = Transformer.from_crs("EPSG:4277", "EPSG:4326").transform(51.5, -0.1)
    assert (at.latitude, at.longitude) == pytest.approx(expected, abs=1e-9)
    assert abs(at.longitude + 0.1) > 0.001


def test_a_local_mission_has_no_degrees():
    assert Locator(Frame("EPSG:4326", None, None)).of((1.0, 2.0, 3.0)).latitude is None
