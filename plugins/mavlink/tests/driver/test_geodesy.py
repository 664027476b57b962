"""Distances and differences of places anywhere on the Earth, judged by PROJ's geodesics."""

from math import isclose

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pyproj import Geod

from mmrs_mavlink import Geographic
from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.settings import Settings
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


GEOD = Geod(ellps="WGS84")

latitudes = st.floats(-80.0, 80.0)
longitudes = st.one_of(st.floats(-180.0, 180.0), st.floats(179.99, 180.0), st.floats(-180.0, -179.99))
azimuths = st.floats(0.0, 360.0)
lengths = st.floats(1.0, 2000.0)


def beyond(latitude: float, longitude: float, azimuth: float, metres: float) -> tuple[float, float]:
    there, north, _ = GEOD.fwd(longitude, latitude, azimuth, metres)
    return north, there


@given(latitudes, longitudes, azimuths, lengths)
def test_a_flight_measures_what_geodesics_do(latitude, longitude, azimuth, metres):
    a = Geographic(latitude, longitude, 0.0)
    b = Geographic(*beyond(latitude, longitude, azimuth, metres), 0.0)
    assert isclose(distance(a, b), metres, rel_tol=2e-5, abs_tol=1e-6)


@given(latitudes, longitudes, azimuths, lengths, st.floats(0.0, 1.0))
def test_a_part_of_a_way_is_as_far_along_and_on_the_map(latitude, longitude, azimuth, metres, part):
    a = Geographic(latitude, longitude, 0.0)
    b = Geographic(*beyond(latitude, longitude, azimuth, metres), 0.0)
    here = between(a, b, part)
    assert isinstance(here, Geographic)
    assert abs(here.longitude) <= 180.0
    assert isclose(distance(a, here), part * metres, rel_tol=1e-4, abs_tol=1e-3)


@given(latitudes, longitudes, azimuths, lengths)
def test_simulated_vehicles_know_their_places_anywhere(latitude, longitude, azimuth, metres):
    pilot = SimulatedAutopilot(Settings("copter", latitude, longitude))
    there = beyond(latitude, longitude, azimuth, metres)
    assume(abs(there[0]) < 80.0)
    place = pilot.local(*there, 0.0)
    _, _, away = GEOD.inv(longitude, latitude, there[1], there[0])
    assert (place[0] ** 2 + place[1] ** 2) ** 0.5 == pytest.approx(away, rel=2e-3)
    assert abs(pilot.degrees_at(place)[1]) <= 180.0
    assert pilot.degrees_at(place)[0] == pytest.approx(there[0])
