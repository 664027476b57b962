from collections.abc import Callable

import pytest
from mmrs_rover import plugin
from mmrs_rover.names import ROVER, TERRAIN

from mmrs_core.languages.registry import Registry, registry_with
from mmrs_core.scene import Part, Robot, Scene, Value
from mmrs_core.testing.models import sample_tasks
from mmrs_core.testing.scenes import sample_robot, sample_scene, sample_type

ROBOT = ("urn:mmrs:robot:1.0", "Robot")


@pytest.fixture(scope="session")
def contributions():
    """Return what the installed plug-ins contribute."""
    from mmrs_core.plugins import load_plugins

    return load_plugins().contributions


@pytest.fixture(scope="session")
def registry() -> Registry:
    return registry_with((*plugin.mmrs_metamodels(), sample_tasks()))


@pytest.fixture(scope="session")
def rover() -> Callable[..., Robot]:
    """Make a rover at a height, with what its type and its movement state."""

    def make(up: float = 2.0, movement: dict[str, float] | None = None, **stated: Value) -> Robot:
        robot_type = sample_type(
            name="Field rover",
            metaclasses=(ROVER, ROBOT),
            attributes={"drive": "WHEELS", **stated},
            speed=(0.0, 2.0),
            **(movement or {}),
        )
        return sample_robot(robot_type, home=(1.0, 1.0, up), kinematics=None, travel_mode="SAFE")

    return make


@pytest.fixture(scope="session")
def field() -> Scene:
    return sample_scene()


@pytest.fixture(scope="session")
def ditch() -> Callable[..., Part]:
    """Make terrain, ten metres square."""

    def make(**stated: Value) -> Part:
        shell = ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 10.0, 0.0), (0.0, 10.0, 0.0))
        return Part((TERRAIN,), {"name": "ditch", "shell": shell, **stated})

    return make
