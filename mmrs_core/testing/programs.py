"""Drones and behaviours made by hand, as targets and backends get them, built on `small_programs`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache

from mmrs_core.behaviour.program import (
    BEHAVIOUR,
    Action,
    Heading,
    Move,
    MoveTarget,
    Program,
    RobotProgram,
    Transition,
)
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.plugins import load_plugins
from mmrs_core.scene import (
    Area,
    AreaUse,
    Battery,
    Capability,
    Device,
    DeviceAction,
    Frame,
    Metaclasses,
    Part,
    Position,
    RobotType,
    Value,
)
from mmrs_core.testing.small_programs import MOVE, notify, robot, use

MULTICOPTER = "urn:mmrs:multicopter:1.0"
ROBOT = "urn:mmrs:robot:1.0"
L_AQUILA = Frame("EPSG:4326", 42.37, 13.35, 720.0, "MSL")
SUPERTYPES: Mapping[tuple[str, str], Metaclasses] = {
    (MULTICOPTER, "GoTo"): ((BEHAVIOUR, "GoTo"),),
    (BEHAVIOUR, "Recharge"): ((BEHAVIOUR, "HoldPosition"),),
}


def move(id: str, kind: str, *, uri: str = BEHAVIOUR, task: str = "", **attributes: Value) -> Move:
    """Return a move of a metaclass, with plain attributes."""
    rule = "by_hand" if task else ""
    kinds = ((uri, kind), *SUPERTYPES.get((uri, kind), ()), MOVE)
    return Move(id, kinds, attributes, task=task, rule=rule)


def take_off(id: str, altitude: float) -> Move:
    """Return a take-off to a height above the ground."""
    return move(id, "TakeOff", uri=MULTICOPTER, altitude=altitude)


LAND = move("down", "Land", uri=MULTICOPTER)
"""A landing where the robot is, as the end of a flight."""


def go_to(
    id: str,
    position: Position,
    *,
    speed: float | None = 5.0,
    task: str = "",
    trajectory: str = "DIRECT",
    heading: Heading | None = None,
) -> Move:
    """Return a multicopter's GoTo a coordinate."""
    made = move(id, "GoTo", uri=MULTICOPTER, task=task, trajectory=trajectory)
    return replace(made, target=MoveTarget(position), speed=speed, heading=heading)


def photo(device: str = "camera", action: str = "takePhoto") -> Action:
    """Return an action of a device, by default one that takes a photo."""
    return use(device, action)


def feedback(name: str, *pairs: tuple[str, str]) -> Action:
    """Return a message to the control station."""
    kinds = tuple((BEHAVIOUR, kind) for kind in ("Feedback", "CommunicationAction", "Action"))
    return Action(kinds, name, parameters=pairs)


def robot_program(
    id: str,
    moves: Sequence[Move],
    *,
    home: Position | None = (0.0, 0.0, 0.0),
    slots: tuple[str, ...] = (),
    transitions: Mapping[int, Transition] | None = None,
    type_name: str = "Quad",
) -> RobotProgram:
    """Return a robot whose moves follow each other, between a Start and a Stop that are added.

    Args:
        id: of the robot.
        moves: without Start and Stop.
        home: of the robot.
        slots: of the robot.
        transitions: those that differ from going on plainly, by index of the move, Start being 0.
        type_name: of the robot's type.
    """
    plain = robot(id, moves, home=home, slots=slots)
    changed = {**plain.transitions, **(transitions or {})}
    return replace(plain, type_name=type_name, transitions=changed)


def program(
    *robots: RobotProgram, name: str = "survey", frame: Frame = L_AQUILA, reserve: float = 0.2
) -> Program:
    """Return the behaviour of these robots."""
    return Program(name, frame, robots, reserve=reserve)


def two_drones() -> Program:
    """Return two drones: the second waits in the air until the first has taken its photos."""
    first = robot_program(
        "alpha",
        [
            take_off("up", 20.0),
            go_to("a1", (0.0, 30.0, 20.0), task="photos"),
            go_to("a2", (15.0, 30.0, 20.0), task="photos"),
            go_to("a3", (30.0, 30.0, 20.0), task="photos"),
            replace(go_to("a4", (30.0, 0.0, 20.0), task="photos"), after=(photo(), notify(("beta", "go")))),
            go_to("back", (0.0, 0.0, 20.0)),
            LAND,
        ],
        transitions={index: Transition(index, index + 1, fluid=True) for index in (2, 3, 4)},
    )
    second = robot_program(
        "beta",
        [
            take_off("up", 15.0),
            go_to("b1", (60.0, 20.0, 15.0), trajectory="HORIZONTAL_FIRST"),
            replace(
                go_to("b2", (60.0, 40.0, 25.0), task="look", trajectory="VERTICAL_FIRST"),
                before=(feedback("arrived", ("at", "b1")),),
            ),
            move("wait", "HoldPosition", task="look", duration=5.0),
            replace(move("turn", "HeadTo"), heading=Heading(MoveTarget((0.0, 0.0, 0.0)))),
            go_to("back", (60.0, 0.0, 15.0)),
            LAND,
        ],
        home=(60.0, 0.0, 0.0),
        slots=("go",),
        transitions={2: Transition(2, 3, waits=("go",))},
    )
    return program(first, second)


def quad(**properties: str) -> RobotType:
    """Return a type of drone with a camera; `properties` of the camera beside its wiring."""
    camera = Device(
        "camera", {"takePhoto": DeviceAction("takePhoto", 1.0)}, {"mavlink.camera": "0", **properties}
    )
    return RobotType(
        name="Quad",
        metaclasses=((MULTICOPTER, "Drone"), (ROBOT, "Robot")),
        capability_metaclasses=((ROBOT, "MovementCapability"),),
        half_diagonal=0.5,
        max_payload=1.0,
        capabilities=(Capability(0.0, 1200.0, (1.0, 8.0), 2.5, 2.5, 2.0, 90.0),),
        batteries=(Battery(200_000.0, 3600.0),),
        devices={"camera": camera},
        part=Part(((MULTICOPTER, "Drone"),), {}),
    )


def areas() -> tuple[Area, ...]:
    """Return a forbidden area, an obstacle that can be flown over, and an emergency area."""
    return (
        Area("school", AreaUse.FORBIDDEN, ((100.0, 0.0), (140.0, 0.0), (140.0, 40.0), (100.0, 40.0))),
        Area("mast", AreaUse.OBSTACLE, ((80.0, 80.0), (82.0, 80.0), (82.0, 82.0)), 0.0, 30.0, 2.0),
        Area("meadow", AreaUse.EMERGENCY, ((-40.0, 0.0), (-20.0, 0.0), (-20.0, 20.0), (-40.0, 20.0))),
    )


def target_input(program: Program, types: Iterable[RobotType] | None = None) -> TargetInput:
    """Return what a target gets for a behaviour among `areas`; its type is `quad` unless others are given."""
    given = (quad(),) if types is None else types
    kinds = installed()
    return TargetInput(
        program,
        {each.name: each for each in given},
        kinds.robot_kinds,
        kinds.move_kinds,
        areas(),
        kinds.extensions,
    )


@cache
def installed() -> Contributions:
    """Return what the installed plug-ins contribute."""
    return load_plugins().contributions
