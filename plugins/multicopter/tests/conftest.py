from collections.abc import Callable
from dataclasses import replace

import pytest
from mmrs_multicopter import plugin
from mmrs_multicopter.names import DRONE

from mmrs_core.languages.registry import Registry, registry_with
from mmrs_core.scene import Battery, Robot, Scene
from mmrs_core.testing.models import sample_tasks
from mmrs_core.testing.scenes import ROBOT, sample_robot, sample_scene, sample_type


@pytest.fixture(scope="session")
def registry() -> Registry:
    return registry_with((*plugin.mmrs_metamodels(), sample_tasks()))


@pytest.fixture(scope="session")
def drone() -> Callable[..., Robot]:
    """Make a drone: 4 to 16 m/s, 1000 s on 500 kJ, 100 m high, with at most a kilogram."""

    def make(**changes: object) -> Robot:
        plain = sample_type(
            name="Quad",
            metaclasses=(DRONE, ROBOT),
            attributes={"maxAltitude": 100.0},
            speed=(4.0, 16.0),
            climb_rate=3.0,
            descent_rate=2.0,
        )
        robot_type = replace(plain, max_payload=1.0, batteries=(Battery(500_000.0, 90.0),))
        made = sample_robot(robot_type, home=(10.0, 20.0, 5.0), kinematics=None)
        return replace(made, **changes)  # type: ignore[arg-type]

    return make


@pytest.fixture
def scene() -> Scene:
    return sample_scene(reserve=0.25)
