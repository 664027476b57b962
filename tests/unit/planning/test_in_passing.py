"""How fast robots may go while their cameras take images."""

from dataclasses import replace

import pytest
from plain_scenes import DRONE, robot

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.in_passing import passing_speed
from mmrs_core.scene import Device

SLOW_SHUTTER = {"capture.interval": "2.0", "exposure.time": "0.002"}


def speed(properties=SLOW_SHUTTER, slowest=0.0, **given):
    asked = {"spacing": 10.0, "pixel": 0.01, "blur": 0.5, **given}
    return passing_speed(
        Device("camera", {}, properties),
        replace(robot(), kinematics=replace(DRONE, slowest=slowest)),
        **asked,
    )


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({}, 2.5),
        ({"blur": 5.0}, 5.0),
        ({"pixel": None}, 5.0),
        ({"properties": {"capture.interval": "4"}}, 2.5),
        ({"properties": {"capture.interval": "1"}}, 10.0),
        ({"most": 1.5}, 1.5),
    ],
)
def test_blur_interval_and_the_task_limit_the_speed(given, expected):
    assert speed(**given) == pytest.approx(expected)


def test_a_camera_without_an_interval_takes_no_images_in_passing():
    with pytest.raises(InfeasibleError, match=r"device 'camera' does not state capture\.interval"):
        speed({"exposure.time": "0.002"})


def test_a_robot_that_cannot_go_so_slowly_is_refused():
    with pytest.raises(InfeasibleError, match=r"overlap up to 2\.50 m/s, .* smallest speed is 3\.00 m/s"):
        speed(slowest=3.0)
