"""Behaviours made by hand, as targets and backends get them, built on `small_programs`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move, Program, RobotProgram, Transition
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.samples import ACTION, DEVICE
from mmrs_core.contributions.targets import Target, TargetInput
from mmrs_core.generation.capabilities.probes import Sample, samples_of
from mmrs_core.plugins import load_plugins
from mmrs_core.scene import Area, AreaUse, Frame, Metaclasses, Position, RobotType, Value
from mmrs_core.testing.small_programs import MOVE, ROBOT_TYPE, notify, robot, use

L_AQUILA = Frame("EPSG:4326", 42.37, 13.35, 720.0, "MSL")
SUPERTYPES: Mapping[tuple[str, str], Metaclasses] = {(BEHAVIOUR, "Recharge"): ((BEHAVIOUR, "HoldPosition"),)}


def move(id: str, kind: str, *, uri: str = BEHAVIOUR, task: str = "", **attributes: Value) -> Move:
    """Return a move of a metaclass, with plain attributes."""
    rule = "by_hand" if task else ""
    kinds = ((uri, kind), *SUPERTYPES.get((uri, kind), ()), MOVE)
    return Move(id, kinds, attributes, task=task, rule=rule)


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
    type_name: str = ROBOT_TYPE,
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


def areas() -> tuple[Area, ...]:
    """Return a forbidden area, an obstacle 30 m high, and an emergency area."""
    return (
        Area("school", AreaUse.FORBIDDEN, ((100.0, 0.0), (140.0, 0.0), (140.0, 40.0), (100.0, 40.0))),
        Area("mast", AreaUse.OBSTACLE, ((80.0, 80.0), (82.0, 80.0), (82.0, 82.0)), 0.0, 30.0, 2.0),
        Area("meadow", AreaUse.EMERGENCY, ((-40.0, 0.0), (-20.0, 0.0), (-20.0, 20.0), (-40.0, 20.0))),
    )


def target_input(program: Program, types: Iterable[RobotType]) -> TargetInput:
    """Return what a target gets for a behaviour of robots of these types among `areas`."""
    kinds = installed()
    return TargetInput(
        program,
        {each.name: each for each in types},
        kinds.robot_kinds,
        kinds.move_kinds,
        areas(),
        kinds.extensions,
    )


def two_robots(target: Target) -> TargetInput:
    """Return what a target gets for two robots of the kind that it is made for.

    The first uses its device; the second waits until it has.
    """
    samples = samples_of(target, installed())
    sample, wirings = samples.base, target.wirings
    moves = sample.on_the_way()
    acts = tuple(
        replace(each, after=(use(DEVICE, ACTION), notify(("beta", "go")))) if each.id == "b" else each
        for each in moves
    )
    second = sample.robot("beta", moves, a=Transition(0, sample.after("a"), waits=("go",)))
    made = program(sample.robot("alpha", acts), replace(second, slots=("go",)))
    return target_input(made, [sample.wired(wirings[0].properties if wirings else {})])


def sample_of(kind: str) -> Sample:
    """Return robots of an installed kind that has a sample, by the kind's name."""
    (found,) = (each for each in installed().robot_kinds.values() if each.name == kind)
    return Sample(found, installed())


@cache
def installed() -> Contributions:
    """Return what the installed plug-ins contribute."""
    return load_plugins().contributions
