import pytest
from mmrs_survey.camera import Footprint, footprint_at, footprint_of

from mmrs_core.errors import InfeasibleError

OPTICS = {"sensor.width": "12.0", "sensor.height": "8.0", "focal.length": "8.0"}
PIXELS = {"image.width": "6000", "image.height": "4000"}


def test_a_footprint_grows_with_the_distance():
    assert footprint_at(OPTICS, 40.0) == Footprint(60.0, 40.0)


@pytest.mark.parametrize("value", ["", "wide", "-8", "0", "nan", "inf"])
def test_a_footprint_is_not_known_where_the_optics_are_no_numbers(value):
    assert footprint_at({**OPTICS, "focal.length": value}, 40.0) is None


def test_a_camera_on_the_ground_has_no_footprint():
    assert footprint_at(OPTICS, 0.0) is None


def test_a_resolution_and_the_image_size_make_a_footprint():
    assert footprint_of(PIXELS, 40.0, 0.01, "camera") == Footprint(60.0, 40.0)


def test_a_camera_that_is_finer_than_asked_for_sees_less_than_its_pixels_would_allow():
    assert footprint_of({**OPTICS, **PIXELS}, 20.0, 0.01, "camera") == Footprint(30.0, 20.0)


def test_a_camera_that_is_too_coarse_is_refused_with_what_it_reaches():
    with pytest.raises(
        InfeasibleError, match=r"resolves 0\.02 m on the ground from 80 m, 0\.01 m is asked for: 40 m would"
    ):
        footprint_of({**OPTICS, **PIXELS}, 80.0, 0.01, "camera")
    assert footprint_of({**OPTICS, **PIXELS}, 40.0, 0.01, "camera")
    with pytest.raises(InfeasibleError):
        footprint_of({**OPTICS, **PIXELS}, 40.1, 0.01, "camera")


def test_a_resolution_without_an_image_size_is_refused():
    with pytest.raises(InfeasibleError, match=r"'camera' does not state image\.width and image\.height"):
        footprint_of(OPTICS, 40.0, 0.01, "camera")
