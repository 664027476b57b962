from collections.abc import Callable
from dataclasses import replace

import pytest
from mmrs_solar.names import PANEL_GROUP

from mmrs_core.scene import Area, Device, DeviceAction, Part, Robot, Scene
from mmrs_core.testing.scenes import FLYER, sample_robot, sample_scene, sample_type

OPTICS = {
    "sensor.width": "8.0",
    "sensor.height": "6.0",
    "focal.length": "10.0",
    "image.width": "800",
    "image.height": "600",
    "exposure.time": "0.01",
    "capture.interval": "0.5",
    "gimbal.pitch.min": "-90",
    "gimbal.pitch.max": "30",
}
"""A camera that sees 0.8 m by 0.6 m, and pixels of a millimetre, for each metre of distance."""

SOUTH = {
    "name": "south",
    "points": ((0.0, 0.0, 0.0), (100.0, 0.0, 0.0)),
    "rows": 4,
    "pitch": 8.0,
    "azimuth": 180.0,
    "tilt": 30.0,
    "rowWidth": 4.0,
    "height": 1.5,
    "columns": 50,
    "tiers": 2,
    "cellSize": 0.156,
}
ACTIONS = ("StartCapture", "StopCapture", "TakePicture")


@pytest.fixture(scope="session")
def group() -> Callable[..., Part]:
    """Make a group of four rows of 100 m that face south, the first one from the origin eastwards."""
    return lambda **more: Part((PANEL_GROUP,), {**SOUTH, **more})


@pytest.fixture(scope="session")
def robot() -> Callable[..., Robot]:
    """Make a robot that carries a thermal camera; properties that are None are left out."""

    def make(parameter: str = "minimumIrradiance", slowest: float = 0.0, **more: str | None) -> Robot:
        given = {key.replace("_", "."): value for key, value in more.items()}
        properties = {key: value for key, value in {**OPTICS, **given}.items() if value is not None}
        actions = {name: DeviceAction(name, 1.0, (parameter,)) for name in ACTIONS}
        camera = Device("thermal", actions, properties)
        made = sample_robot(sample_type(devices={"thermal": camera}))
        return replace(made, kinematics=replace(FLYER, slowest=slowest))

    return make


@pytest.fixture(scope="session")
def scene(robot: Callable[..., Robot], group: Callable[..., Part]) -> Callable[..., Scene]:
    """Make a scene with the group, or others, and with areas to keep away from."""

    def make(*areas: Area, groups: tuple[Part, ...] | None = None) -> Scene:
        return replace(sample_scene(robot(), areas=areas), elements=(group(),) if groups is None else groups)

    return make
