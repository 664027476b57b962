from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from mmrs_rover import plugin
from mmrs_rover.names import ROVER, TERRAIN

from mmrs_core.contributions.constraints import Constraint
from mmrs_core.languages import context, mission
from mmrs_core.languages.element import Element, descendants, is_kind
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import MetamodelSource, Registry, registry_with
from mmrs_core.scene import Capability, Frame, Part, Robot, RobotType, Scene

ROBOT = ("urn:mmrs:robot:1.0", "Robot")


@pytest.fixture(scope="session")
def registry() -> Registry:
    visits = MetamodelSource("urn:test:visits:1.0", Path(__file__).parent / "visits.ecore")
    return registry_with((*plugin.mmrs_metamodels(), visits))


@pytest.fixture(scope="session")
def rover() -> Callable[..., Robot]:
    """Make a rover at a height, with what its type states."""

    def make(
        up: float = 2.0, turn_rate: float | None = None, acceleration: float | None = None, **stated: object
    ) -> Robot:
        figures = Capability(0.0, 3600.0, (0.0, 2.0), acceleration=acceleration, turn_rate=turn_rate)
        robot_type = RobotType(
            name="Field rover",
            metaclasses=(ROVER, ROBOT),
            capability_metaclasses=(),
            half_diagonal=0.8,
            max_payload=None,
            capabilities=(figures,),
            batteries=(),
            devices={},
            part=Part((ROVER, ROBOT), {"drive": "WHEELS", **stated}),
        )
        return Robot("Rex", robot_type, (1.0, 1.0, up), True, 0.0, "SAFE", 0.8)

    return make


@pytest.fixture(scope="session")
def field() -> Scene:
    return Scene("test", Frame("EPSG:4326", 42.0, 13.0), (), (), (), reserve=0.25)


@pytest.fixture(scope="session")
def ditch() -> Callable[..., Part]:
    """Make terrain, ten metres square."""

    def make(**stated: object) -> Part:
        shell = ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 10.0, 0.0), (0.0, 10.0, 0.0))
        return Part((TERRAIN,), {"name": "ditch", "shell": shell, **stated})

    return make


@pytest.fixture(scope="session")
def breaches() -> Callable[..., list[str]]:
    """Return the messages of a constraint over some models."""

    def check(constraint: Constraint, roots: Iterable[Element]) -> list[str]:
        found = list(roots)
        models = ModelSet(
            next((each for each in found if isinstance(each, mission.Mission)), None),  # type: ignore[arg-type]
            next((each for each in found if isinstance(each, context.Context)), None),
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
