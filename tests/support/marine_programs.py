"""Behaviours of one underwater vehicle, and what targets are given of them."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from mmrs_auv.names import AUV_MOVEMENT
from mmrs_multicopter.testing import robot_program

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Heading, Move, MoveTarget, RobotProgram, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.scene import Capability, Device, DeviceAction, Frame, Part, RobotType
from mmrs_core.testing.programs import feedback, installed, move, program
from mmrs_core.testing.small_programs import notify

SEA = Frame("EPSG:4326", 41.18, -8.7, 0.0, "MSL", surface=-2.0)

MANY_PROGRAMS = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
    deadline=None,
    max_examples=40,
)
NAMES = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=8)
SLOT = "go on"


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
        place = MoveTarget((east, north, SEA.surface - depth))
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
        return TargetInput(
            program(*made, *robots, frame=frame),
            {"Diver": type or swimmer()},
            installed().robot_kinds,
            installed().move_kinds,
        )

    return make


@pytest.fixture(scope="session")
def does() -> Callable[..., Action]:
    """Make an action of the sonar."""

    def make(name: str = "Record") -> Action:
        kinds = ((BEHAVIOUR, "DeviceAction"), (BEHAVIOUR, "Action"))
        return Action(kinds, name, "sonar")

    return make


@st.composite
def moves(draw):
    """Draw moves of all sorts, with names that nobody would give."""
    names = draw(
        st.lists(NAMES, min_size=1, max_size=6, unique=True).filter(lambda n: not {"start", "stop"} & set(n))
    )
    made = []
    for name in names:
        place = MoveTarget(draw(st.tuples(*[st.floats(-50.0, 50.0)] * 2, st.floats(-9.0, -2.0))))
        went = replace(
            move(name, "GoTo"), target=place, distance=draw(st.sampled_from([0.0, 3.0])), speed=1.0
        )
        held = move(name, "HoldPosition", duration=draw(st.floats(0.0, 99.0)))
        turned = replace(move(name, "HeadTo"), heading=Heading(place))
        lost = replace(went, target=replace(place, description="a } // buoy"))
        chosen = draw(st.sampled_from([went, went, held, turned, lost]))
        after = draw(st.sampled_from([(), (notify(("naiad", SLOT)),), (feedback(name),)]))
        made.append(replace(chosen, after=after))
    return made


@st.composite
def inputs(draw, given):
    """Draw a robot whose moves follow each other in any way, rings and choices included."""
    made = draw(moves())
    last = len(made) + 1
    anywhere = st.integers(1, last)
    changed = {}
    for index in draw(st.sets(st.integers(0, last - 1), max_size=3)):
        kind = draw(st.sampled_from(["waits", "chooses", "jumps"]))
        if kind == "waits":
            changed[index] = Transition(index, index + 1, waits=(SLOT,))
        elif kind == "chooses":
            to, otherwise = draw(anywhere), draw(anywhere)
            changed[index] = Transition(index, to, condition=draw(NAMES), otherwise=otherwise)
        else:
            changed[index] = Transition(index, draw(anywhere))
    robot = robot_program(
        "naiad", made, home=(0.0, 0.0, -2.0), type_name="Diver", slots=(SLOT,), transitions=changed
    )
    return given(robot)


def rendered(target, input):
    """Return the files of a target, or None where a robot does nothing that it expresses."""
    try:
        return {file.path: file.content for file in render(target, input, allow_lossy=True)}
    except UnsupportedError as error:
        if "does nothing" not in str(error):
            raise
        return None
