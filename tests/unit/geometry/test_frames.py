import numpy as np
import pytest
from pyproj import CRS, Geod, Transformer
from pyproj.crs import ProjectedCRS
from pyproj.crs.coordinate_operation import TransverseMercatorConversion

from mmrs_core.geometry.frames import LocalFrame, known_crs


def test_origin_is_at_zero():
    frame = LocalFrame("wgs84", 42.37, 13.35)
    assert np.allclose(frame.to_local(42.37, 13.35), [[0.0, 0.0]], atol=1e-9)


def test_east_comes_first_and_north_second():
    frame = LocalFrame("EPSG:4326", 42.37, 13.35)
    east, north = frame.to_local([42.37, 42.38], [13.36, 13.35])
    assert east.tolist() == pytest.approx([823.7, 0.0], abs=0.1)
    assert north.tolist() == pytest.approx([0.0, 1110.8], abs=0.1)


def test_round_trip_is_within_a_millimetre():
    frame = LocalFrame("wgs84", 42.37, 13.35)
    points = np.random.default_rng(1).uniform(-10_000, 10_000, (1000, 2))
    degrees = frame.to_geographic(points)
    assert np.abs(frame.to_local(degrees[:, 0], degrees[:, 1]) - points).max() < 1e-3


def test_distances_are_those_on_the_ellipsoid_within_a_centimetre():
    frame = LocalFrame("wgs84", 42.37, 13.35)
    points = np.random.default_rng(2).uniform(-5_000, 5_000, (200, 2))
    degrees = frame.to_geographic(points)
    first, second = degrees[:100], degrees[100:]
    true = Geod(ellps="WGS84").inv(first[:, 1], first[:, 0], second[:, 1], second[:, 0])[2]
    assert np.abs(np.linalg.norm(points[:100] - points[100:], axis=1) - true).max() < 1e-2


@pytest.mark.parametrize("alias", ["wgs84", "WGS84", " Wgs84 "])
def test_wgs84_is_known_in_any_case(alias):
    assert known_crs(alias) is None


def test_other_datums_have_their_own_frame():
    assert known_crs("EPSG:4265") is None
    assert np.allclose(LocalFrame("EPSG:4265", 42.0, 13.0).to_local(42.0, 13.0), 0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("crs", "reason"),
    [
        ("EPSG:32633", "projected"),
        ("EPSG:4978", "not geographic"),
        ("EPSG:4807", "counts in grad"),
        ("moon cheese", "not known"),
        ("", "not known"),
    ],
)
def test_a_crs_that_is_not_geographic_in_degrees_is_refused(crs, reason):
    assert reason in (known_crs(crs) or "")
    with pytest.raises(ValueError, match=reason):
        LocalFrame(crs, 0.0, 0.0)


def test_an_origin_off_the_earth_is_refused():
    with pytest.raises(ValueError, match="91"):
        LocalFrame("wgs84", 91.0, 0.0)


@pytest.mark.parametrize("crs", ["EPSG:4326", "EPSG:4267", "EPSG:4813", "+proj=longlat +R=6371000"])
def test_a_frame_is_the_projection_that_proj_itself_makes_of_it(crs):
    geographic = CRS.from_user_input(crs)
    touching = TransverseMercatorConversion(-33.9, 151.2, scale_factor_natural_origin=1.0)
    local = ProjectedCRS(conversion=touching, geodetic_crs=geographic)
    x, y = Transformer.from_crs(geographic, local, always_xy=True).transform([151.2, 151.3], [-33.8, -34.0])
    found = LocalFrame(crs, -33.9, 151.2).to_local([-33.8, -34.0], [151.2, 151.3])
    assert found == pytest.approx(np.column_stack([x, y]), abs=1e-8)


def test_a_coordinate_that_cannot_be_projected_is_named():
    with pytest.raises(ValueError, match=r"coordinate 120\.0, 13\.0"):
        LocalFrame("wgs84", 42.0, 13.0).to_local([42.0, 120.0], [13.0, 13.0])
