"""What a preview shows, apart from how: plain values in the local frame, metres and seconds."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from mmrs_core.scene import AreaUse, Point, Position, Ring


@dataclass(frozen=True, slots=True)
class Leg:
    """A stretch that a robot travels.

    Attributes:
        kind: ``launch``, ``transit``, ``work`` or ``recover``.
        points: (east, north, up), at least one.
        covered: the ground that it covers, as rings that all turn the same way.
        actions: where device actions are done.
        note: more to say about it, one line; may be empty.
        moves: which moves of the behaviour it is; empty where that is not known.
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


@dataclass(frozen=True, slots=True)
class Bar:
    """A stretch of a robot's time; `kind` as a leg's, or ``wait``, ``hold`` or ``recharge``."""

    kind: str
    begin: float
    end: float
    task: str = ""
    note: str = ""


@dataclass(frozen=True, slots=True)
class RobotPicture:
    """One robot: where it starts, what it travels, what it does when.

    Attributes:
        heights: (time, up), ascending in time: its altitude profile.
        floor, ceiling: heights that it keeps between; infinite where it has none.
        summary: (what, how much) for the table beneath the picture.
    """

    name: str
    type_name: str
    home: Position
    legs: tuple[Leg, ...]
    bars: tuple[Bar, ...]
    heights: tuple[tuple[float, float], ...]
    floor: float = -inf
    ceiling: float = inf
    summary: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Zone:
    """An area of the context.

    Attributes:
        shell: as drawn, (east, north).
        kept: its outline once grown (or, an emergency area, shrunk) by the clearance, as rings.
        clearance: metres that it was grown by.
    """

    name: str
    use: AreaUse
    shell: Ring
    low: float = -inf
    high: float = inf
    kept: tuple[Ring, ...] = ()
    clearance: float = 0.0


@dataclass(frozen=True, slots=True)
class TaskPicture:
    """A task on the map and in time.

    Attributes:
        kind: what people call such a task.
        rings: outlines of an area, the shell first; empty for other tasks.
        line: of a task along a line; empty for other tasks. point: of a task at a point.
        begin, end: seconds; None where it is not planned.
    """

    name: str
    kind: str
    rings: tuple[Ring, ...] = ()
    line: tuple[Point, ...] = ()
    point: Point | None = None
    begin: float | None = None
    end: float | None = None


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
    """

    title: str
    origin: str
    robots: tuple[RobotPicture, ...]
    zones: tuple[Zone, ...] = ()
    tasks: tuple[TaskPicture, ...] = ()
    handovers: tuple[Handover, ...] = ()
    makespan: float = 0.0
    notes: tuple[str, ...] = ()
    surface: float | None = None
