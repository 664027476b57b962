"""Drones and behaviours of drones made by hand, for tests of targets and backends that carry them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial

from mmrs_core.behaviour.program import BEHAVIOUR, Heading, Move, MoveTarget, Program, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import Battery, Capability, Device, DeviceAction, Part, Position, RobotType
from mmrs_core.testing import programs
from mmrs_core.testing.programs import feedback, move, photo, program
from mmrs_core.testing.small_programs import MOVE, notify
from mmrs_core.transformation.kinds import ROBOT
from mmrs_multicopter.names import DRONE, MULTICOPTER

ROBOT_TYPE = "Quad"
robot_program = partial(programs.robot_program, type_name=ROBOT_TYPE)
"""Makes a drone; see `mmrs_core.testing.programs.robot_program`."""


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
    kinds = ((MULTICOPTER, "GoTo"), (BEHAVIOUR, "GoTo"), MOVE)
    target, rule = MoveTarget(position), "by_hand" if task else ""
    return Move(
        id,
        kinds,
        {"trajectory": trajectory},
        target=target,
        speed=speed,
        heading=heading,
        task=task,
        rule=rule,
    )


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
        name=ROBOT_TYPE,
        metaclasses=(DRONE, ROBOT),
        capability_metaclasses=(("urn:mmrs:robot:1.0", "MovementCapability"),),
        half_diagonal=0.5,
        max_payload=1.0,
        capabilities=(Capability(0.0, 1200.0, (1.0, 8.0), 2.5, 2.5, 2.0, 90.0),),
        batteries=(Battery(200_000.0, 3600.0),),
        devices={"camera": camera},
        part=Part((DRONE,), {}),
    )


def target_input(program: Program, types: Iterable[RobotType] | None = None) -> TargetInput:
    """Return what a target gets for a behaviour among the areas of `mmrs_core.testing.programs`.

    Its robot type is `quad` unless others are given.
    """
    return programs.target_input(program, (quad(),) if types is None else types)
