from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from mmrs_multicopter import plugin
from mmrs_multicopter.names import DRONE

from mmrs_core.contributions.constraints import Constraint
from mmrs_core.languages import context, mission
from mmrs_core.languages.element import Element, descendants, is_kind
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import MetamodelSource, Registry, registry_with
from mmrs_core.scene import (
    Battery,
    Capability,
    Frame,
    Part,
    Robot,
    RobotType,
    Scene,
)

ROBOT = ("urn:mmrs:robot:1.0", "Robot")


@pytest.fixture(scope="session")
def registry() -> Registry:
    visits = MetamodelSource("urn:test:visits:1.0", Path(__file__).parent / "visits.ecore")
    return registry_with((*plugin.mmrs_metamodels(), visits))


@pytest.fixture(scope="session")
def drone() -> Callable[..., Robot]:
    """Make a drone: 4 to 16 m/s, 1000 s on 500 kJ, 100 m high."""

    def make(**changes: object) -> Robot:
        capability = Capability(1.0, 1000.0, (4.0, 16.0), climb_rate=3.0, descent_rate=2.0)
        robot_type = RobotType(
            name="Quad",
            metaclasses=(DRONE, ROBOT),
            capability_metaclasses=(),
            half_diagonal=0.5,
            max_payload=1.0,
            capabilities=(capability,),
            batteries=(Battery(500_000.0, 90.0),),
            devices={},
            part=Part((DRONE, ROBOT), {"maxAltitude": 100.0}),
        )
        values: dict[str, object] = {
            "name": "Alba",
            "type": robot_type,
            "home": (10.0, 20.0, 5.0),
            "return_home": True,
            "payload": 0.0,
            "travel_mode": "NORMAL",
            "clearance": 0.5,
        }
        return Robot(**{**values, **changes})  # type: ignore[arg-type]

    return make


@pytest.fixture
def scene() -> Scene:
    return Scene("test", Frame("EPSG:4326", 42.0, 13.0), (), (), (), reserve=0.25)


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
