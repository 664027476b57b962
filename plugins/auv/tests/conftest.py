from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from mmrs_auv import plugin
from mmrs_auv.names import AUV_MOVEMENT

from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import Registry, registry_with
from mmrs_core.scene import Part, Robot, Scene
from mmrs_core.testing.models import sample_tasks
from mmrs_core.testing.scenes import sample_robot, sample_scene, sample_type


@pytest.fixture(scope="session")
def registry() -> Registry:
    return registry_with((*plugin.mmrs_metamodels(), sample_tasks()))


@pytest.fixture(scope="session")
def vehicle() -> Callable[..., Robot]:
    """Make an underwater vehicle whose thrusters bear those depths and whose hull bears that pressure."""

    def make(depths: Iterable[float] = (), pressure: float | None = None) -> Robot:
        thrusters = tuple(Part((), {"id": str(each), "maxDepth": depth}) for each, depth in enumerate(depths))
        robot_type = sample_type(
            name="Diver",
            attributes={"maxOperatingPressure": pressure, "thrusters": thrusters},
            movement=Part((AUV_MOVEMENT,), {"thrusters": tuple(map(str, range(len(thrusters))))}),
            speed=(0.0, 2.0),
        )
        return sample_robot(robot_type, home=(0.0, 0.0, -3.0), kinematics=None, travel_mode="SAFE")

    return make


@pytest.fixture(scope="session")
def lake() -> Callable[..., Scene]:
    """Make a scene whose water surface is at a height, with water of a density."""

    def make(surface: float = -3.0, density: float | None = 1000.0) -> Scene:
        environment = {} if density is None else {"waterDensity": density}
        return sample_scene(surface=surface, environment=environment)

    return make


@pytest.fixture(scope="session")
def project_types() -> list[object]:
    """Return the types of underwater vehicle of the examples."""
    examples = Path(__file__).parents[3] / "examples"
    files = (examples / "pool/robots/pool-auv.xmi", examples / "mixed-team/robots/inspection-auv.xmi")
    known = registry_with(plugin.mmrs_metamodels())
    return [root for file in files for root in read_model(file, known).roots]
