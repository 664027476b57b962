from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from mmrs_auv import plugin
from mmrs_auv.names import AUV_MOVEMENT

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
def vehicle() -> Callable[..., Robot]:
    """Make an underwater vehicle whose thrusters bear those depths and whose hull bears that pressure."""

    def make(depths: Iterable[float] = (), pressure: float | None = None) -> Robot:
        thrusters = tuple(Part((), {"maxDepth": depth}) for depth in depths)
        movement = Part((AUV_MOVEMENT,), {"thrusters": thrusters})
        robot_type = RobotType(
            name="Diver",
            metaclasses=(ROBOT,),
            capability_metaclasses=(AUV_MOVEMENT,),
            half_diagonal=0.4,
            max_payload=1.0,
            capabilities=(Capability(1.0, 3600.0, (0.0, 2.0), climb_rate=0.5, part=movement),),
            batteries=(),
            devices={},
            part=Part((ROBOT,), {"maxOperatingPressure": pressure}),
        )
        return Robot("Otter", robot_type, (0.0, 0.0, -3.0), True, 0.0, "SAFE", 0.4)

    return make


@pytest.fixture(scope="session")
def lake() -> Callable[..., Scene]:
    """Make a scene whose water surface is at a height, with water of a density."""

    def make(surface: float = -3.0, density: float | None = 1000.0) -> Scene:
        frame = Frame("EPSG:4326", 42.0, 13.0, surface=surface)
        environment = {} if density is None else {"waterDensity": density}
        return Scene("test", frame, (), (), (), environment=environment)

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
