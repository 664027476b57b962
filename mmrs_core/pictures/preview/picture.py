"""What a preview shows, apart from how: plain values in the local frame, metres and seconds."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from math import inf
from typing import TypeAlias

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.scene import AreaUse, Point, Position, Ring

Details: TypeAlias = tuple[tuple[str, str], ...]
"""What else to tell of something: (what, how much), in words."""


@dataclass(frozen=True, slots=True)
class Leg:
    """A stretch that a robot travels, or a place at which it stays.

    Attributes:
        kind: ``launch``, ``transit``, ``work``, ``hold`` or ``recover``.
        points: (east, north, up), at least one; where it stays, only one.
        covered: the ground that it covers, as rings that all turn the same way.
        actions: where device actions are done.
        note: more to say about it, one line; may be empty.
        moves: which moves of the behaviour it is; empty where that is not known.
        aside: whether it is on a way of a choice that is not the longest of its ways.
        times: when it was at each of the points; empty: it travels at an even pace.
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
    """One of the ways that a robot may choose.

    Attributes:
        words: when it is taken, such as ``if windy`` or ``otherwise``.
        level: how many choices it is inside of, beside its own.
        longest: whether none of the other ways takes longer; one of each choice's ways is.
    """

    words: str
    begin: float
    end: float
    bars: tuple[Bar, ...]
    level: int = 0
    longest: bool = False


@dataclass(frozen=True, slots=True)
class Mark:
    """Something that happened at a place: a ``photo``, a ``missing`` one, or a ``fault``, in words."""

    kind: str
    at: Position
    tip: str


@dataclass(frozen=True, slots=True)
class RobotPicture:
    """One robot: where it starts, what it travels, what it does when.

    Attributes:
        bars: what it does when; a choice is one bar.
        heights: (time, up), ascending in time: its altitude profile; of a choice, the longest way's.
        floor, ceiling: heights that it keeps between; infinite where it has none.
        summary: (what, how much) for the table beneath the picture.
        arms: the ways of its choices, in the order in which they are tested; inner ones after their outer.
        symbol: of its kind, if anybody contributed one.
        planned: where a robot that has flown should have: straight legs.
        planned_heights: as `heights`, of the plan of a robot that has flown.
        marks: what happened on the way.
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


@dataclass(frozen=True, slots=True)
class Zone:
    """An area of the context.

    Attributes:
        shell: as drawn, (east, north).
        kept: its outline once grown (or, an emergency area, shrunk) by the clearance, as rings.
        clearance: metres that it was grown by.
        types: of the robots that it bars; None: of all.
    """

    name: str
    use: AreaUse
    shell: Ring
    low: float = -inf
    high: float = inf
    kept: tuple[Ring, ...] = ()
    clearance: float = 0.0
    types: frozenset[str] | None = None


@dataclass(frozen=True, slots=True)
class TaskPicture:
    """A task on the map and in time.

    Attributes:
        symbol: how such a task looks, and what people call it.
        rings: outlines of an area, the shell first; empty for other tasks.
        line: of a task along a line; empty for other tasks. point: of a task at a point.
        begin, end: seconds; None where it is not planned.
        part: how much of it was done, 0 to 1.
    """

    name: str
    symbol: MapSymbol
    rings: tuple[Ring, ...] = ()
    line: tuple[Point, ...] = ()
    point: Point | None = None
    begin: float | None = None
    end: float | None = None
    details: Details = ()
    part: float = 1.0


@dataclass(frozen=True, slots=True)
class Thing:
    """Something at the place that robots need not keep away from: a context element of a plug-in.

    Attributes:
        name: empty for something without one that is part of another thing.
        outlines: not closed. lines: polylines. marks: single points. All (east, north), metres.
        inner: whether it is part of another thing.
    """

    name: str
    symbol: MapSymbol
    outlines: tuple[Ring, ...] = ()
    lines: tuple[tuple[Point, ...], ...] = ()
    marks: tuple[Point, ...] = ()
    details: Details = ()
    inner: bool = False

    @property
    def points(self) -> tuple[Point, ...]:
        """Return all points that it has; none where it has no place."""
        return tuple(chain(self.marks, *self.outlines, *self.lines))


@dataclass(frozen=True, slots=True)
class Handover:
    """One robot telling another that it may go on; times in seconds.

    Attributes:
        since, released: from when to when the receiver waits; equal if it never has to.
        note: which task has ended; may be empty.
    """

    sender: str
    sent: float
    receiver: str
    since: float
    released: float
    note: str = ""


@dataclass(frozen=True, slots=True)
class Picture:
    """A whole mission.

    Attributes:
        origin: where (0, 0) lies, for people.
        makespan: seconds until the last robot has finished.
        notes: assumptions that people must know.
        flown: whether it shows what happened, and not a plan or a simulation.
    """

    title: str
    origin: str
    robots: tuple[RobotPicture, ...]
    zones: tuple[Zone, ...] = ()
    tasks: tuple[TaskPicture, ...] = ()
    things: tuple[Thing, ...] = ()
    handovers: tuple[Handover, ...] = ()
    makespan: float = 0.0
    notes: tuple[str, ...] = ()
    surface: float | None = None
    flown: bool = False

    @property
    def shown(self) -> float:
        """Return the seconds that charts show: until all has ended, as it went and as it was planned."""
        planned = (time for robot in self.robots for time, _ in robot.planned_heights[-1:])
        arms = (arm.end for robot in self.robots for arm in robot.arms)
        return max((self.makespan, *planned, *arms))
