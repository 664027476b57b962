from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest
from mmrs_auv.names import AUV_TASKS

from mmrs_core.scene import Device, Kinematics, Part, Robot, Scene, Task
from mmrs_core.testing.scenes import (
    sample_device,
    sample_robot,
    sample_scene,
    sample_task,
    sample_type,
    square,
)

SWIMMER = Kinematics(1.0, 0.0, 2.0, 0.5, 0.5, floor=-53.0, ceiling=-3.0)
SURFACE = -3.0


@pytest.fixture(scope="session")
def robot() -> Callable[..., Robot]:
    """Make a vehicle that swims between the surface, 3 m below the origin, and 50 m of depth."""

    def make(devices: Mapping[str, Device] | None = None, slowest: float = 0.0, sonar: str = "8") -> Robot:
        carried = {
            "sonar": sample_device("sonar", "Record", properties={"sonar.swath": sonar}),
            "camera": sample_device("camera", "TakePicture"),
        }
        limits = replace(SWIMMER, slowest=slowest)
        found = sample_type(devices=carried if devices is None else devices, speed=(slowest, 2.0))
        return sample_robot(found, home=(0.0, 0.0, SURFACE - 1.0), kinematics=limits)

    return make


@pytest.fixture(scope="session")
def scene(robot: Callable[..., Robot]) -> Callable[..., Scene]:
    """Make a scene with square obstacles (centre east, centre north, half side) and elements."""

    def make(*squares: tuple[float, float, float], elements: tuple[Part, ...] = ()) -> Scene:
        areas = tuple(square(f"block {index}", *each) for index, each in enumerate(squares))
        return sample_scene(robot(), areas=areas, elements=elements, surface=SURFACE)

    return make


@pytest.fixture(scope="session")
def task() -> Callable[..., Task]:
    """Make a grounded task under water from its attributes."""

    def make(metaclass: str, **attributes: object) -> Task:
        return sample_task((AUV_TASKS, metaclass), **attributes)  # type: ignore[arg-type]

    return make
