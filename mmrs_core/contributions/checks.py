"""Checks that a behaviour is safe, and what they find."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING

from mmrs_core.diagnostics import Place

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Program
    from mmrs_core.contributions.rules import MoveKind, RobotKind
    from mmrs_core.scene import Area, Corridor, Name, Part, Point, RobotType


class Status(Enum):
    """What a check finds of a property."""

    VIOLATED = "violated"
    SAFE = "safe"
    UNKNOWN = "unknown"
    NOT_CHECKED = "not checked"


AT_LIMIT = 0.01
"""Metres: a distance that is kept by less than this is called at the limit."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is known of one property of one robot, or of all of them together.

    Attributes:
        property: name of the check, such as ``clearance``.
        robot: identifier; empty where all robots are meant.
        margin: what is left before the property breaks, negative where it is violated; None where
            it has no measure. unit: of the margin.
        move: identifier of the move where the margin is smallest; area: name of the area it is to.
        message: what was found, in lower case; for unknown: what is missing. It names move and area; the
            robot is printed before it.
        place: where that move, or else the robot, stands in the user's files.
        caveat: what a verdict that refuses nothing excuses or leaves out, so that it is always shown.
        error: the part of a required distance that allows for position errors, metres.
    """

    property: str
    status: Status
    robot: str = ""
    margin: float | None = None
    unit: str = ""
    move: str = ""
    area: str = ""
    message: str = ""
    place: Place = Place()
    caveat: str = ""
    error: float = 0.0


def message_of(verdict: Verdict) -> str:
    """Return the message, the robot before it unless it begins with it; empty without a message."""
    whose = f"{verdict.robot}: " if verdict.robot and verdict.message else ""
    return f"{whose}{verdict.message.removeprefix(whose)}"


def is_at_limit(verdict: Verdict) -> bool:
    """Return whether a distance is kept, by less than `AT_LIMIT`."""
    near = verdict.unit == "m" and verdict.margin is not None and verdict.margin < AT_LIMIT
    return near and verdict.status is Status.SAFE


@dataclass(frozen=True, slots=True)
class CheckInput:
    """All that a check may look at.

    Attributes:
        types: robot types by name; a type that a robot names may be missing.
        areas: of the context as drawn, and those that its elements make; None where no context was given.
        environment: by attribute name; absent where not known.
        elements: context elements of plug-ins; empty where no context was given.
        corridors: of the context as drawn; empty where no context was given.
        tasks: of the mission, by name as moves have it; empty where no mission was given.
        rally_points: (east, north) of the places where each robot would land that a policy may lead to an
            emergency area, metres; a robot that none may lead there is missing.
        unasked_rally_points: likewise, of robots that none leads there though such areas are drawn for them.
        shared: what checks of one verification keep for each other, by the function that found it.
    """

    program: Program
    types: Mapping[str, RobotType]
    robot_kinds: Mapping[Name, RobotKind]
    move_kinds: Mapping[Name, MoveKind]
    areas: tuple[Area, ...] | None = None
    environment: Mapping[str, float] = field(default_factory=dict)
    elements: tuple[Part, ...] = ()
    corridors: tuple[Corridor, ...] = ()
    tasks: Mapping[str, Part] = field(default_factory=dict)
    rally_points: Mapping[str, tuple[Point, ...]] = field(default_factory=dict)
    unasked_rally_points: Mapping[str, tuple[Point, ...]] = field(default_factory=dict)
    shared: dict[Callable[..., object], object] = field(default_factory=dict, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Check:
    """A property that behaviours are checked for.

    Attributes:
        name: snake_case, unique; missions accept unknowns by it.
        title: the property as a sentence.
        run: one verdict for each robot, or one for all.
        hint: how to fix a behaviour without it, or which figure makes it known.
    """

    name: str
    title: str
    run: Callable[[CheckInput], Iterable[Verdict]]
    hint: str = ""
