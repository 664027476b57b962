"""Minimal behaviours with one element of the Behaviour Language more than others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from mmrs_core.behaviour.program import (
    BEHAVIOUR,
    Action,
    Move,
    MoveTarget,
    Program,
    RobotProgram,
    Transition,
)
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import (
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

MULTICOPTER = "urn:mmrs:multicopter:1.0"
ROBOT = "urn:mmrs:robot:1.0"
AUV = "urn:mmrs:auv:1.1"
MOVE = (BEHAVIOUR, "Move")
PROBED = frozenset({BEHAVIOUR, MULTICOPTER})
"""Languages whose moves have probes of their own."""
ALPHA, BETA = "alpha", "beta"
EARTH = Frame("EPSG:4326", 42.37, 13.35, 720.0, "MSL")
HERE, THERE = (0.0, 30.0, 20.0), (25.0, 30.0, 20.0)


@dataclass(frozen=True, slots=True)
class Probe:
    """A behaviour with an element, and the same behaviour without it.

    Attributes:
        group: what sort of element it is.
        element: its metaclass, feature or meaning, such as ``GoTo.speed``.
    """

    group: str
    element: str
    given: TargetInput
    without: TargetInput


def move(id: str, kind: str, uri: str = BEHAVIOUR, *more: tuple[str, str], **attributes: Value) -> Move:
    """Return a move of a metaclass; `more`: metaclasses between it and Move."""
    return Move(id, ((uri, kind), *more, MOVE), attributes)


def go_to(id: str, position: Position = HERE, **attributes: Value) -> Move:
    """Return a multicopter's GoTo with a speed."""
    made = move(id, "GoTo", MULTICOPTER, (BEHAVIOUR, "GoTo"), **attributes)
    return replace(made, target=MoveTarget(position), speed=5.0)


def action(kind: str, *more: str, name: str = "", device: str = "") -> Action:
    """Return an action of a metaclass of the Behaviour Language; `more`: its supertypes but Action."""
    kinds = tuple((BEHAVIOUR, each) for each in (kind, *more, "Action"))
    return Action(kinds, name, device)


def robot(id: str, moves: tuple[Move, ...], **transitions: Transition) -> RobotProgram:
    """Return a robot that makes these moves one after the other, between Start and Stop.

    Args:
        id: of the robot.
        moves: between Start and Stop.
        transitions: what follows a move, by the move's identifier, where that is not merely the next.
    """
    every = (move("start", "Start"), *moves, move("stop", "Stop"))
    plain = {index: Transition(index, index + 1) for index in range(len(every) - 1)}
    names = {each.id: index for index, each in enumerate(every)}
    given = {names[name]: replace(each, source=names[name]) for name, each in transitions.items()}
    home = (0.0, 0.0, 0.0) if id == ALPHA else (60.0, 0.0, 0.0)
    last = len(every) - 1
    return RobotProgram(id, "Kind", "NORMAL", 0.0, home, (), every, {**plain, **given}, 0, last)


TAKE_OFF = move("up", "TakeOff", MULTICOPTER, altitude=20.0)
LAND = move("down", "Land", MULTICOPTER)
FLIGHT = (TAKE_OFF, go_to("a"), LAND)
DRIVE = (replace(move("a", "GoTo"), target=MoveTarget((0.0, 30.0, 0.0)), speed=1.0),)
DIVE = (replace(move("a", "GoTo"), target=MoveTarget((0.0, 30.0, -5.0)), speed=1.0),)

KINDS: dict[str, tuple[Metaclasses, Metaclasses, tuple[Move, ...]]] = {
    "copter": (((MULTICOPTER, "Drone"), (ROBOT, "Robot")), ((ROBOT, "MovementCapability"),), FLIGHT),
    "rover": (((ROBOT, "Robot"),), ((ROBOT, "MovementCapability"),), DRIVE),
    "sub": (((AUV, "AUV"), (ROBOT, "Robot")), ((AUV, "AUVMovement"), (ROBOT, "MovementCapability")), DIVE),
}
"""Metaclasses of type and movement, and possible moves, by vehicle class."""


def kind_of(vehicle: str, **properties: str) -> RobotType:
    """Return a robot type with one device, which has these properties."""
    metaclasses, capabilities, _ = KINDS[vehicle]
    names = {name.replace("__", "."): value for name, value in properties.items()}
    device = Device("device", {"act": DeviceAction("act", 2.0)}, names)
    return RobotType(
        name="Kind",
        metaclasses=metaclasses,
        capability_metaclasses=capabilities,
        half_diagonal=0.5,
        max_payload=1.0,
        capabilities=(
            Capability(0.0, 1200.0, (0.5, 8.0), 2.5, 2.5, 2.0, 90.0, _moving(vehicle)),
            Capability(1.0, 900.0, (0.5, 4.0), 2.5, 2.5, 2.0, 90.0, _moving(vehicle)),
        ),
        batteries=(Battery(200_000.0, 3600.0),),
        devices={"device": device},
        part=Part((metaclasses[0],), {"size": SIZE, "thrusters": THRUSTERS} if vehicle == "sub" else {}),
    )


def _moving(vehicle: str) -> Part:
    """Return how a vehicle moves; one under water by all its thrusters."""
    if vehicle != "sub":
        return Part((), {})
    return Part((*KINDS["sub"][1],), {"thrusters": tuple(PUSHES)})


def _thruster(id: str, forward: float, starboard: float, ahead: float, down: float) -> Part:
    place = {"forward": forward, "starboard": starboard, "pushForward": ahead, "pushDown": down}
    mounting = Part(((AUV, "Mounting"),), place)
    figures = {"operatingThrust": 20.0, "maxThrust": 40.0, "operatingPower": 90.0, "maxPower": 250.0}
    return Part(((AUV, "Thruster"),), {"id": id, "maxDepth": 100.0, "mounting": mounting, **figures})


PUSHES = {
    "T1": (0.3, 0.2, 1.0, 0.0),
    "T2": (0.3, -0.2, 1.0, 0.0),
    "T3": (0.3, 0.0, 0.0, 1.0),
    "T4": (-0.3, 0.0, 0.0, 1.0),
}
THRUSTERS = tuple(_thruster(id, *each) for id, each in PUSHES.items())
SIZE = Part(
    ((AUV, "InWaterSize"),),
    {"length": 0.8, "width": 0.5, "height": 0.4, "weight": 30.0, "weightInWater": -0.3},
)


def given(*robots: RobotProgram, type: RobotType | None = None, frame: Frame = EARTH) -> TargetInput:
    """Return what a target gets: robots of a type, by default a copter without wired devices."""
    made = kind_of("copter") if type is None else type
    return TargetInput(Program("mission", frame, robots), {made.name: made}, {}, {})


def plain(vehicle: str = "copter") -> TargetInput:
    """Return what a target gets of one robot of a vehicle class that makes a simple journey."""
    return given(robot(ALPHA, KINDS[vehicle][2]), type=kind_of(vehicle))


def changed(base: TargetInput, change: Callable[[RobotProgram], RobotProgram]) -> TargetInput:
    """Return an input whose first robot is another."""
    first, *others = base.program.robots
    return replace(base, program=replace(base.program, robots=(change(first), *others)))


def with_move(base: TargetInput, id: str, /, **changes: object) -> TargetInput:
    """Return an input in which a move of the first robot has other values."""

    def change(robot: RobotProgram) -> RobotProgram:
        moves = (replace(each, **changes) if each.id == id else each for each in robot.moves)  # type: ignore[arg-type]
        return replace(robot, moves=tuple(moves))

    return changed(base, change)
