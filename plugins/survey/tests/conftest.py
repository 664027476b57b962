from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

import pytest
from mmrs_survey import plugin
from mmrs_survey.names import SURVEY

from mmrs_core.contributions.constraints import Constraint
from mmrs_core.languages import mission
from mmrs_core.languages.element import Element, descendants, is_kind
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import Registry, registry_with
from mmrs_core.scene import (
    Area,
    AreaUse,
    Capability,
    Device,
    DeviceAction,
    Frame,
    Kinematics,
    Part,
    Robot,
    RobotType,
    Scene,
    Task,
)

ROBOT = ("urn:mmrs:robot:1.0", "Robot")
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
        camera = Device("camera", {"TakePicture": DeviceAction("TakePicture", 1.0)}, properties)
        probe = Device("probe", {"Sample": DeviceAction("Sample", 2.0, ("seconds",))}, {})
        carried = {"camera": camera, "probe": probe, **(devices or {})}
        capability = Capability(0.0, 1000.0, (slowest, 10.0))
        robot_type = RobotType("Any", (ROBOT,), (), 0.5, None, (capability,), (), carried, Part((), {}))
        made = Robot("Alba", robot_type, (0.0, 0.0, 0.0), True, 0.0, "NORMAL", 0.5)
        limits = Kinematics(5.0, slowest, 10.0, 2.0, 2.0, floor=1.0, ceiling=100.0)
        return replace(made, kinematics=limits)

    return make


@pytest.fixture(scope="session")
def scene(robot: Callable[..., Robot]) -> Callable[..., Scene]:
    """Make a scene with the robot and with square obstacles (centre east, centre north, half side, top)."""

    def make(*squares: tuple[float, float, float, float], surface: float = 0.0) -> Scene:
        areas = tuple(
            Area(
                f"block {index}",
                AreaUse.OBSTACLE,
                ((e - h, n - h), (e + h, n - h), (e + h, n + h), (e - h, n + h)),
                high=top,
                safety_distance=1.0,
            )
            for index, (e, n, h, top) in enumerate(squares)
        )
        return Scene("test", Frame("EPSG:4326", 42.0, 13.0, surface=surface), (), (), (robot(),), areas)

    return make


@pytest.fixture(scope="session")
def task() -> Callable[..., Task]:
    """Make a grounded survey task from its attributes."""

    def make(metaclass: str, **attributes: object) -> Task:
        return Task("task", Part(((SURVEY, metaclass),), attributes))  # type: ignore[arg-type]

    return make


@pytest.fixture(scope="session")
def breaches() -> Callable[..., list[str]]:
    """Return the messages of a constraint over some models."""

    def check(constraint: Constraint, roots: Iterable[Element]) -> list[str]:
        found = list(roots)
        models = ModelSet(
            next((each for each in found if isinstance(each, mission.Mission)), None),  # type: ignore[arg-type]
            None,
            {each.name: each for each in found if is_kind(each, *ROBOT)},  # type: ignore[attr-defined]
            (),
        )
        return [
            finding.message
            for root in found
            for element in (root, *descendants(root))
            if is_kind(element, *constraint.metaclass)
            for finding in constraint.check(element, models)
        ]

    return check
