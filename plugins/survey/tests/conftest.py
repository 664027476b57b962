from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest
from mmrs_survey import plugin
from mmrs_survey.names import SURVEY

from mmrs_core.languages.registry import Registry, registry_with
from mmrs_core.scene import Device, DeviceAction, Robot, Scene, Task
from mmrs_core.testing.scenes import (
    FLYER,
    sample_device,
    sample_robot,
    sample_scene,
    sample_task,
    sample_type,
    square,
)

CAMERA = {"sensor.width": "12.0", "sensor.height": "8.0", "focal.length": "8.0"}


@pytest.fixture(scope="session")
def registry() -> Registry:
    return registry_with(plugin.mmrs_metamodels())


@pytest.fixture(scope="session")
def robot() -> Callable[..., Robot]:
    """Make a robot at the origin, between 1 and 100 m, with a camera, a probe and whatever else is given."""

    def make(
        devices: Mapping[str, Device] | None = None,
        properties: Mapping[str, str] = CAMERA,
        slowest: float = 0.0,
    ) -> Robot:
        camera = sample_device("camera", "TakePicture", properties=properties)
        probe = sample_device("probe", "Sample", "seconds")
        carried = {"camera": camera, "probe": probe, **(devices or {})}
        limits = replace(FLYER, slowest=slowest)
        return sample_robot(sample_type(devices=carried, speed=(slowest, 10.0)), kinematics=limits)

    return make


@pytest.fixture(scope="session")
def snapper(robot: Callable[..., Robot]) -> Callable[..., Robot]:
    """Make a robot whose camera takes a photo each second in passing; more of its properties may be given."""

    def make(slowest: float = 0.0, **properties: str) -> Robot:
        stated = {**CAMERA, "capture.interval": "1.0", **properties}
        actions = {
            "TakePicture": DeviceAction("TakePicture", 1.0),
            "TriggerByDistance": DeviceAction("TriggerByDistance", 0.0, ("distance",)),
        }
        return robot(devices={"camera": Device("camera", actions, stated)}, slowest=slowest)

    return make


@pytest.fixture(scope="session")
def scene(robot: Callable[..., Robot]) -> Callable[..., Scene]:
    """Make a scene with the robot and with square obstacles (centre east, centre north, half side, top)."""

    def make(*squares: tuple[float, float, float, float], surface: float = 0.0) -> Scene:
        areas = tuple(square(f"block {index}", *each) for index, each in enumerate(squares))
        return sample_scene(robot(), areas=areas, surface=surface)

    return make


@pytest.fixture(scope="session")
def task() -> Callable[..., Task]:
    """Make a grounded survey task from its attributes."""

    def make(metaclass: str, **attributes: object) -> Task:
        return sample_task((SURVEY, metaclass), **attributes)  # type: ignore[arg-type]

    return make
