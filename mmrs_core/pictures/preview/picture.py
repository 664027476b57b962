"""What a preview shows: plain values in the local frame, metres and seconds."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from math import inf
from typing import TypeAlias

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.explanations import ExplanationPart
from mmrs_core.pictures.figures import clock, length
from mmrs_core.scene import AreaUse, Part, Point, Position, Ring

Details: TypeAlias = tuple[tuple[str, str], ...]
"""Further facts: (name, value)."""

_LEGS = {
    "launch": "take-off",
    "transit": "transit",
    "work": "work",
    "hold": "hold",
    "recover": "landing",
    "response": "off-plan response",
}


@dataclass(frozen=True, slots=True)
class Leg:
    """A stretch that a robot travels, or a place at which it stays.

    Attributes:
        kind: ``launch``, ``transit``, ``work``, ``hold`` or ``recover``.
        points: (east, north, up), at least one; where it stays, only one.
        covered: the ground that it covers, as rings that all turn the same way.
        actions: where device actions are done.
        note: one line; may be empty.
        moves: the moves of the behaviour that it is; empty where they are unknown.
        aside: whether it is on a branch of a choice that is not the longest.
        times: when it was at each of the points; empty: it travels at a constant speed.
    """

    kind: str
    points: tuple[Position, ...]
    begin: float
    end: float
    task: str = ""
    covered: tuple[Ring, ...] = ()
    actions: tuple[Position, ...] = ()
    note: str = ""
    moves: str = ""
    aside: bool = False
    times: tuple[float, ...] = ()

    @property
    def stays(self) -> bool:
        """Return whether the robot stays where it is."""
        return len(set(self.points)) < 2

    def tip(self, robot: str) -> str:
        """Return what a robot's leg is: what for, when, at what altitude."""
        ups = [point[2] for point in self.points]
        level = length(ups[0]) if max(ups) - min(ups) < 0.05 else f"{length(ups[0])} to {length(ups[-1])}"
        what = f"{_LEGS[self.kind]} for {self.task}" if self.task else _LEGS[self.kind]
        parts = (what, f"{clock(self.begin)} to {clock(self.end)}", f"up {level}", self.moves, self.note)
        return f"{robot}: " + ", ".join(part for part in parts if part)


@dataclass(frozen=True, slots=True)
class Bar:
    """A stretch of a robot's time; `kind` as a leg's, or ``wait``, ``recharge`` or ``choice``."""

    kind: str
    begin: float
    end: float
    task: str = ""
    note: str = ""


@dataclass(frozen=True, slots=True)
class Arm:
    """One branch of a choice.

    Attributes:
        words: when it is taken, such as ``if windy`` or ``otherwise``.
        level: how many choices enclose its own.
        longest: whether no other branch takes longer; true for one branch of each choice.
    """

    words: str
    begin: float
    end: float
    bars: tuple[Bar, ...]
    level: int = 0
    longest: bool = False


@dataclass(frozen=True, slots=True)
class Mark:
    """Something that happened at a position: a ``photo``, a ``missing`` one, or a ``fault``."""

    kind: str
    at: Position
    tip: str


@dataclass(frozen=True, slots=True)
class RobotPicture:
    """One robot: where it starts, what it travels, what it does when.

    Attributes:
        bars: what it does when; a choice is one bar.
        heights: (time, up), ascending in time: its altitude profile; of a choice, the longest branch's.
        floor, ceiling: its limits; infinite where it has none.
        summary: for the table beneath the picture.
        arms: the branches of its choices, in the order in which they are tested; inner after outer ones.
        symbol: of its kind, if a plug-in provides one.
        planned: the planned path of a robot that has flown: straight legs.
        planned_heights: as `heights`, of the plan of a robot that has flown.
        marks: events along its track.
        gap: why it is not drawn whole; empty: it is.
    """

    name: str
    type_name: str
    home: Position
    legs: tuple[Leg, ...]
    bars: tuple[Bar, ...]
    heights: tuple[tuple[float, float], ...]
    floor: float = -inf
    ceiling: float = inf
    summary: Details = ()
    arms: tuple[Arm, ...] = ()
    symbol: MapSymbol | None = None
    planned: tuple[tuple[Position, ...], ...] = ()
    planned_heights: tuple[tuple[float, float], ...] = ()
    marks: tuple[Mark, ...] = ()
    gap: str = ""


@dataclass(frozen=True, slots=True)
class Zone:
    """An area of the context.

    Attributes:
        shell: as drawn, (east, north); of an incomplete one, the vertices that have a position.
        kept: its outline once grown (or, an emergency area, shrunk) by the clearance, as rings.
        clearance: metres that it was grown by.
        types: robot types that it applies to; None: all.
        unknown: robots whose clearance is unknown, so that they may have to keep farther away.
        gap: why it is not drawn whole; empty: it is.
        pieces: of an incomplete one, the stretches of its outline that are known.
    """

    name: str
    use: AreaUse
    shell: Ring
    low: float = -inf
    high: float = inf
    kept: tuple[Ring, ...] = ()
    clearance: float = 0.0
    types: frozenset[str] | None = None
    unknown: tuple[str, ...] = ()
    gap: str = ""
    pieces: tuple[tuple[Point, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class TaskPicture:
    """A task on the map and in time.

    Attributes:
        symbol: how such a task looks, and what it is called.
        rings: outlines of an area, the shell first; empty for other tasks.
        lines: of a task along a line, and known stretches of outlines that have a gap. point: of a task at a
            point.
        begin, end: seconds; None where it is not planned.
        part: how much of it was done, 0 to 1.
        gap: why it is not drawn whole; empty: it is.
        model: the task itself.
    """

    name: str
    symbol: MapSymbol
    rings: tuple[Ring, ...] = ()
    lines: tuple[tuple[Point, ...], ...] = ()
    point: Point | None = None
    begin: float | None = None
    end: float | None = None
    details: Details = ()
    part: float = 1.0
    gap: str = ""
    model: Part | None = None

    @property
    def drawn(self) -> bool:
        """Return whether it has a position."""
        return bool(self.rings or self.lines or self.point is not None)

    @property
    def tip(self) -> str:
        """Return what the task is, and when."""
        times = (
            "" if self.begin is None or self.end is None else f", {clock(self.begin)} to {clock(self.end)}"
        )
        return f"{self.name}: {self.symbol.label}{_listed(self.details)}{times}{incomplete(self.gap)}"


@dataclass(frozen=True, slots=True)
class ElementPicture:
    """A context element that a plug-in provides, or an element inside of one.

    Attributes:
        name: empty for an inner element without one.
        outlines: not closed. lines: polylines. marks: single points. All (east, north), metres.
        inner: whether another element contains it.
        gap: why it is not drawn whole; empty: it is.
        model: the element itself.
    """

    name: str
    symbol: MapSymbol
    outlines: tuple[Ring, ...] = ()
    lines: tuple[tuple[Point, ...], ...] = ()
    marks: tuple[Point, ...] = ()
    details: Details = ()
    inner: bool = False
    gap: str = ""
    model: Part | None = None

    @property
    def points(self) -> tuple[Point, ...]:
        """Return all its points; none where it has no position."""
        return tuple(chain(self.marks, *self.outlines, *self.lines))

    @property
    def tip(self) -> str:
        """Return what the element is."""
        called = f"{self.name}: " if self.name else ""
        return f"{called}{self.symbol.label}{_listed(self.details)}{incomplete(self.gap)}"


@dataclass(frozen=True, slots=True)
class Problem:
    """A diagnostic of a mission, or a reason why no plan is feasible.

    Attributes:
        number: on the map and in the list, from 1.
        severity: ``error``, ``warning`` or ``note``.
        message: with its code, if it has one.
        source: file and line; may be empty.
        hint: how to fix it; may be empty.
        at: where the element concerned lies, (east, north); None where it has no position.
    """

    number: int
    severity: str
    message: str
    source: str = ""
    hint: str = ""
    at: Point | None = None


@dataclass(frozen=True, slots=True)
class MapGap:
    """Something that the map does not show, or not whole.

    Attributes:
        what: such as ``forbidden area 'school'``.
        reason: why; may give several reasons.
        source: file and line; may be empty.
        drawn: whether some of it is drawn.
    """

    what: str
    reason: str
    source: str = ""
    drawn: bool = False


@dataclass(frozen=True, slots=True)
class Handover:
    """One robot releasing another; times in seconds.

    Attributes:
        since, released: from when to when the receiver waits; equal if it does not.
        note: which task has ended; may be empty.
    """

    sender: str
    sent: float
    receiver: str
    since: float
    released: float
    note: str = ""


@dataclass(frozen=True, slots=True)
class RadioRange:
    """How far a radio reaches: metres around (east, north). whose: a relay's, or that of a home, in words."""

    whose: str
    at: Point
    metres: float


@dataclass(frozen=True, slots=True)
class Picture:
    """A whole mission.

    Attributes:
        origin: where (0, 0) lies.
        makespan: seconds until the last robot has finished.
        notes: assumptions behind it.
        flown: whether it shows what happened, and not a plan or a simulation.
        problems: errors, with which the mission has no plan and its robots no paths; and warnings.
        more_problems: how many problems there are beside those.
        gaps: what the map does not show, or not whole; what is not drawn at all comes first.
        checks: what was found of the safety of its behaviour: (property, words).
        explanation: why its plan is as it is; empty where that was not asked for.
        ranges: of relays, robots included, and from homes.
    """

    title: str
    origin: str
    robots: tuple[RobotPicture, ...]
    zones: tuple[Zone, ...] = ()
    tasks: tuple[TaskPicture, ...] = ()
    elements: tuple[ElementPicture, ...] = ()
    handovers: tuple[Handover, ...] = ()
    makespan: float = 0.0
    notes: tuple[str, ...] = ()
    surface: float | None = None
    flown: bool = False
    problems: tuple[Problem, ...] = ()
    more_problems: int = 0
    gaps: tuple[MapGap, ...] = ()
    checks: Details = ()
    explanation: tuple[ExplanationPart, ...] = ()
    ranges: tuple[RadioRange, ...] = ()

    @property
    def planned(self) -> bool:
        """Return whether nothing keeps it from being planned."""
        return not any(problem.severity == "error" for problem in self.problems)

    @property
    def shown(self) -> float:
        """Return the seconds that charts show: until all has ended, as it went and as it was planned."""
        planned = (time for robot in self.robots for time, _ in robot.planned_heights[-1:])
        arms = (arm.end for robot in self.robots for arm in robot.arms)
        return max((self.makespan, *planned, *arms))


def incomplete(gap: str) -> str:
    """Return what is said behind the name of something that has a gap.

    >>> incomplete("1 of 4 coordinates has no position"), incomplete("")
    (', incomplete: 1 of 4 coordinates has no position', '')
    """
    return f", incomplete: {gap}" if gap else ""


def _listed(details: Details) -> str:
    return "".join(f", {name} {value}" for name, value in details)
