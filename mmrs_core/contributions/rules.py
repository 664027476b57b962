"""What turns tasks into work, and robots into kinematics and moves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, TypeAlias

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Move
    from mmrs_core.scene import (
        ActionAt,
        Area,
        Kinematics,
        Look,
        Name,
        Part,
        PolicyEvent,
        PolicyResponse,
        Position,
        Robot,
        RobotType,
        Scene,
        Stroke,
        Task,
        Value,
        Work,
    )
    from mmrs_core.scene.timing import MoveSeconds


Medium: TypeAlias = Literal["ground", "air", "water"]
"""What robots move in. Heights of robots in water count from the water surface, those of others from home."""


@dataclass(frozen=True, slots=True)
class MoveSpec:
    """A move to be made, without its place in the behaviour.

    Attributes:
        metaclass: of the move.
        attributes: plain attributes by feature name.
        target: where it leads to; None for moves without a target.
        object: description of an object to go up to, expected at `target`; None for a coordinate.
        object_tolerance: how far from `target` the object may be, metres; None where unknown.
        distance: metres from the target at the end.
        look: orientation; None: the direction of travel.
        facing: whether `look` means the object, wherever it is found, and not its expected position.
        speed: metres per second; None: by the travel mode.
        before, after: device actions before and after the movement; their `at` does not matter.
        settles: whether the robot stops before and after it, though it could pass.
    """

    metaclass: Name
    attributes: Mapping[str, Value] = field(default_factory=dict)
    target: Position | None = None
    object: str | None = None
    object_tolerance: float | None = None
    distance: float = 0.0
    look: Look | None = None
    facing: bool = False
    speed: float | None = None
    before: tuple[ActionAt, ...] = ()
    after: tuple[ActionAt, ...] = ()
    settles: bool = False


@dataclass(frozen=True, slots=True)
class Rule:
    """What tasks of one metaclass are made of.

    The rule for the most specific metaclass of a task serves it; two rules for one metaclass are a
    conflict that names both plug-ins.

    Attributes:
        name: snake_case; stands in `Move.rule` of every move that it led to.
        metaclass: of the tasks.
        work: the work of that task for that robot, whose kinematics are known. It leaves open
            who does it, when, and how to get there. Raises InfeasibleError if that robot cannot do the task;
            the reason is shown to the operator when no robot can.
        moves: the moves of a stroke, for tasks whose moves are not GoTo with actions. The robot is at the
            stroke's first point already, and must be at its last point afterwards. Plans and timelines
            count the stroke, not the moves: `Stroke.hold` must contain every second that the moves take
            beyond the way along the stroke's points and its actions. None: the engine's own.
    """

    name: str
    metaclass: Name
    work: Callable[[Task, Robot, Scene], Work]
    moves: Callable[[Stroke, Task, Robot, Scene], tuple[MoveSpec, ...]] | None = None


@dataclass(frozen=True, slots=True)
class RobotKind:
    """A robot kind: how its robots move.

    Attributes:
        name: snake_case.
        metaclass: of the robot type or of its movement capabilities; the most specific one wins,
            the robot type's own metaclasses before those of its capabilities.
        kinematics: what a robot of this kind can do on that mission. When a behaviour is checked or
            simulated, the scene contains that robot alone, the areas, the elements and the environment, and
            no tasks. Raises InfeasibleError where a figure is missing.
        launch: moves that take it from home to that height above home, metres.
        recover: moves that bring it down where it is.
        travel: moves along straight legs; the first position is where the robot is.
        policies: response by event, where the models say nothing; one for each event.
        barrier: the area that robots of a type keep out of because of an element of the context, such as
            water that is too deep for them; None where the element does not hinder them.
        vehicle: class of vehicle that carries it, by a word that targets and backends know; they refuse the
            robots of a kind whose vehicle they do not know, by the name of the kind. Empty: no vehicle.
        medium: what it moves in.
        position_hold: attribute of robot types with the strongest wind in which they hold their position,
            metres per second; empty: the wind does not matter to them.
        sample: a robot type of this kind, as `sample_type` makes it, with which targets are tried; None: they
            are not tried with this kind.
    """

    name: str
    metaclass: Name
    kinematics: Callable[[Robot, Scene], Kinematics]
    launch: Callable[[float], tuple[MoveSpec, ...]]
    recover: Callable[[], tuple[MoveSpec, ...]]
    travel: Callable[[tuple[Position, ...]], tuple[MoveSpec, ...]]
    policies: Mapping[PolicyEvent, PolicyResponse] = field(default_factory=dict)
    barrier: Callable[[RobotType, Part], Area | None] | None = None
    vehicle: str = ""
    medium: Medium = "ground"
    position_hold: str = ""
    sample: RobotType | None = None


@dataclass(frozen=True, slots=True)
class MoveKind:
    """What moves of one metaclass do; checks, simulation and previews go by it.

    Attributes:
        metaclass: of the moves; the most specific one wins.
        path: positions that the robot passes on straight legs, the current one first. Arguments: the
            move, where the robot is, its home or None. None where it is not known, as for an object
            without a place.
        seconds: duration of the move itself, actions aside, given its path, the robot's kinematics and the
            travel mode: shortest, expected and longest.
        needs: states, one of which the robot must be in before: ``grounded`` (where robots that
            launch begin), ``airborne``, ``moving`` (where all others are throughout).
        leaves: state it is in afterwards; None: as before.
        manoeuvre: what a vehicle does to make the move: ``take_off`` to the end of its path, ``land`` at the
            end of its path, or ``go_to`` its target along its path; empty for other moves. Targets ask for
            the path of a take-off, and of a GoTo, at the origin and without a home: it must be known there.
            The end of a take-off is a height above where the robot stands, whatever its home.
    """

    metaclass: Name
    path: Callable[[Move, Position, Position | None], tuple[Position, ...] | None]
    seconds: Callable[[Move, tuple[Position, ...], Kinematics, str], MoveSeconds]
    needs: frozenset[str]
    leaves: str | None = None
    manoeuvre: Literal["", "take_off", "land", "go_to"] = ""


@dataclass(frozen=True, slots=True)
class ElementKind:
    """What context elements of one metaclass are to all robots: areas that they keep out of.

    The planner, the checks, the fences of generated code and the maps treat these areas as those that the
    context draws. What bars some robots only is `RobotKind.barrier`.

    Attributes:
        metaclass: of the elements; the most specific one wins.
        areas: forbidden areas and obstacles that an element makes. Arguments: the element, and all of the
            context, elements first, then what its areas are (`Area.part`): `element_called` finds there
            what a reference names. Raises InfeasibleError where a figure is missing.
        spares: metaclasses of robot types that may enter the areas, such as airships that moor at a mast.
    """

    metaclass: Name
    areas: Callable[[Part, tuple[Part, ...]], Iterable[Area]]
    spares: frozenset[Name] = frozenset()


def most_specific(metaclasses: tuple[Name, ...], registered: Mapping[Name, object]) -> Name | None:
    """Return the first of the metaclasses that is registered; None if none is."""
    return next((name for name in metaclasses if name in registered), None)


def robot_kind_of(robot_type: RobotType, kinds: Mapping[Name, RobotKind]) -> RobotKind | None:
    """Return the robot kind of a type; None where no plug-in provides one.

    A capability's metaclass counts only where the type's own most specific match is the general
    robot or none, so that a capability of a plug-in makes a plain Robot one of the plug-in's kind.
    """
    by_type = most_specific(robot_type.metaclasses, kinds)
    by_capability = most_specific(robot_type.capability_metaclasses, kinds)
    if by_type is None or (by_capability is not None and by_type == ("urn:mmrs:robot:1.0", "Robot")):
        return kinds[by_capability] if by_capability else (kinds[by_type] if by_type else None)
    return kinds[by_type]


def barriers(
    elements: tuple[Part, ...],
    drawn: Iterable[Area],
    types: Iterable[RobotType],
    robot_kinds: Mapping[Name, RobotKind],
    element_kinds: Mapping[Name, ElementKind],
) -> tuple[Area, ...]:
    """Return the areas that elements of a context make, for all robots or for those of certain types only.

    Args:
        elements: grounded, in the context's order.
        drawn: the areas of the context itself.
        types: of the robots; sorted here, so that their order does not matter.
        robot_kinds, element_kinds: by metaclass.

    Raises:
        InfeasibleError: if an element lacks a figure that its kind needs.
    """
    found: list[Area] = []
    known = sorted(types, key=lambda each: each.name)
    everything = (*elements, *(area.part for area in drawn))
    for element in elements:
        name = most_specific(element.metaclasses, element_kinds)
        if name is not None:
            element_kind = element_kinds[name]
            concerned = [each.name for each in known if element_kind.spares.isdisjoint(each.metaclasses)]
            only = None if len(concerned) == len(known) else frozenset(concerned)
            found.extend(replace(area, types=only) for area in element_kind.areas(element, everything))
        for robot_type in known:
            kind = robot_kind_of(robot_type, robot_kinds)
            area = kind.barrier(robot_type, element) if kind is not None and kind.barrier else None
            if area is not None:
                found.append(replace(area, types=frozenset({robot_type.name})))
    return tuple(found)
