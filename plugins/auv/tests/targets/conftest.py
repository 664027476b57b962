from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from mmrs_auv.names import AUV_MOVEMENT

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move, RobotProgram, Target
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import Capability, Device, DeviceAction, Frame, Part, RobotType
from mmrs_core.testing.programs import move, program, robot_program

SEA = Frame("EPSG:4326", 41.18, -8.7, 0.0, "MSL", surface=-2.0)


@pytest.fixture(scope="session")
def swimmer() -> Callable[..., RobotType]:
    """Make a type of underwater vehicle with a sonar of some properties, which takes no time or some."""

    def make(seconds: float = 0.0, **properties: str) -> RobotType:
        names = {name.replace("__", "."): value for name, value in properties.items()}
        actions = {"Record": DeviceAction("Record", seconds), "Stop": DeviceAction("Stop", 0.0)}
        part = Part((AUV_MOVEMENT,), {})
        return RobotType(
            "Diver",
            (("urn:mmrs:robot:1.0", "Robot"),),
            (AUV_MOVEMENT, ("urn:mmrs:robot:1.0", "MovementCapability")),
            0.5,
            None,
            (Capability(0.0, 7200.0, (0.0, 2.0), part=part),),
            (),
            {"sonar": Device("sonar", actions, names)},
            Part((("urn:mmrs:robot:1.0", "Robot"),), {}),
        )

    return make


@pytest.fixture(scope="session")
def dive() -> Callable[..., Move]:
    """Make a GoTo to a place (east, north, depth below the surface at -2 m)."""

    def make(id: str, east: float, north: float, depth: float, **changes: object) -> Move:
        made = move(id, "GoTo")
        place = Target((east, north, SEA.surface - depth))
        return replace(made, **{"target": place, "speed": 1.0, **changes})  # type: ignore[arg-type]

    return make


@pytest.fixture(scope="session")
def given(swimmer: Callable[..., RobotType]) -> Callable[..., TargetInput]:
    """Make what a target gets: robots of one type that make these moves, or robots as they are."""

    def make(
        *parts: Move | RobotProgram, type: RobotType | None = None, frame: Frame = SEA, **options: object
    ) -> TargetInput:
        moves = [each for each in parts if isinstance(each, Move)]
        robots = [each for each in parts if isinstance(each, RobotProgram)]
        options = {"home": (0.0, 0.0, SEA.surface), "type_name": "Diver", **options}
        made = [robot_program("naiad", moves, **options)] if moves else []  # type: ignore[arg-type]
        return TargetInput(program(*made, *robots, frame=frame), {"Diver": type or swimmer()}, {}, {})

    return make


@pytest.fixture(scope="session")
def does() -> Callable[..., Action]:
    """Make an action of the sonar."""

    def make(name: str = "Record") -> Action:
        kinds = ((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action"))
        return Action(kinds, name, "sonar")

    return make
