"""What a report contains: plain values; metres, seconds, fractions from 0 to 1. None stands for unknown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from mmrs_core.pictures.flights.positions import GeoPosition

MILLIMETRE = 1e-3
"""Rounding error of distances, metres."""


class TaskStatus(Enum):
    """How much of a task was done."""

    DONE = "done"
    PART = "partly done"
    NOT_DONE = "not done"
    NOT_CHOSEN = "not needed"


@dataclass(frozen=True, slots=True)
class TaskReport:
    """A task: what was asked and what was achieved.

    Attributes:
        part: of the planned work, 0 to 1.
        robots: that were to work on it.
        planned, flown: when it was to begin and end, and did.
    """

    name: str
    status: TaskStatus
    part: float
    robots: tuple[str, ...]
    planned: tuple[float, float] | None
    flown: tuple[float, float | None] | None


@dataclass(frozen=True, slots=True)
class Spread:
    """How large figures are: of half of them, of 95 % of them, and the largest, without its sign."""

    median: float
    most: float
    largest: float


@dataclass(frozen=True, slots=True)
class Deviation:
    """How far a robot was off its planned path.

    Attributes:
        fixes: how many count. sideways, upwards: metres from the nearest point of the planned path.
        where, time, move: of the largest deviation sideways. high_time, high_move: of that upwards.
    """

    robot: str
    fixes: int
    sideways: Spread
    upwards: Spread
    where: GeoPosition
    time: float
    move: str
    high_time: float
    high_move: str


@dataclass(frozen=True, slots=True)
class MoveReport:
    """One visit of a move. Attributes: when it was entered, seconds flown and planned, whether it ended."""

    robot: str
    move: str
    kind: str
    task: str
    entered: float
    flown: float
    planned: float | None
    ended: bool


@dataclass(frozen=True, slots=True)
class WaitReport:
    """A wait for own slots. Attributes: who set them last; until when, None where it never ended."""

    robot: str
    move: str
    slots: tuple[str, ...]
    setters: tuple[str, ...]
    since: float
    until: float | None
    seconds: float
    planned: float | None


@dataclass(frozen=True, slots=True)
class EnergyReport:
    """What a robot used of its batteries, as fractions of a full one, all sorties together.

    Attributes:
        lowest: the least that was left, and when. end: what is left. capacity: joules when full.
    """

    robot: str
    planned: float | None
    used: float | None
    lowest: float | None
    lowest_at: float | None
    planned_lowest: float | None
    end: float | None
    reserve: float
    capacity: float | None


@dataclass(frozen=True, slots=True)
class Nearness:
    """How near a robot came to something, and how near it might have.

    Attributes:
        kept: metres. required: None where nothing is required, or it is unknown.
        error: the part of `required` that allows for position errors, metres.
        where, time: of the robot when it was nearest.
    """

    kept: float
    required: float | None
    error: float
    where: GeoPosition
    time: float

    @property
    def too_near(self) -> bool:
        """Return whether it was nearer than the required distance without the position error."""
        return self.required is not None and self.kept < self.required - self.error - MILLIMETRE

    @property
    def within_error(self) -> bool:
        """Return whether it used some of the position error, and no more."""
        return self.required is not None and not self.too_near and self.kept < self.required - MILLIMETRE


@dataclass(frozen=True, slots=True)
class Approach(Nearness):
    """How near a robot came to an area as drawn; 0: inside."""

    robot: str
    area: str
    use: str


@dataclass(frozen=True, slots=True)
class Separation(Nearness):
    """How near two robots came to each other; `where` is the first one's place."""

    robot: str
    other: str


@dataclass(frozen=True, slots=True)
class PhotoReport:
    """A photo; `state` is ``taken``, ``not confirmed`` or ``simulated``."""

    robot: str
    time: float
    state: str
    index: int | None
    task: str
    move: str
    where: GeoPosition | None


@dataclass(frozen=True, slots=True)
class Measurement:
    """Something ``measured`` or ``reported``: its kind, its name, and its content in words."""

    robot: str
    time: float
    kind: str
    name: str
    content: str
    where: GeoPosition | None


@dataclass(frozen=True, slots=True)
class Event:
    """Something to know: ``fault``, ``decision``, ``order``, ``injected`` or ``text``.

    Attributes:
        what: what happened. why: its cause, and the response.
    """

    robot: str
    time: float
    kind: str
    what: str
    why: str


@dataclass(frozen=True, slots=True)
class LinkReport:
    """The quality of the link to a robot.

    Attributes:
        vehicle: what it was. by: sort of link, such as ``udp``; no address.
        fixes: how many positions it reported. gaps, longest, silent: stretches without a fix, seconds.
        dropped: frames by cause.
        commands, repeated, refused: how many were sent, had to be repeated, were not accepted.
        slowest: seconds until the slowest answer.
    """

    robot: str
    vehicle: str
    by: str
    fixes: int
    gaps: int
    longest: float
    silent: float
    dropped: Mapping[str, int]
    commands: int
    repeated: int
    refused: int
    slowest: float | None


@dataclass(frozen=True, slots=True)
class RobotReport:
    """One robot as a whole.

    Attributes:
        ending: of its program.
        way, planned_way: metres. time, planned_time: seconds from its first step to its last.
        moves: how many ended, and how many there are.
    """

    robot: str
    type_name: str
    ending: str
    way: float | None
    planned_way: float | None
    time: float
    planned_time: float | None
    moves: tuple[int, int]

    @property
    def ended_early(self) -> bool:
        """Return whether a fault or an order ended its program."""
        return self.ending.isupper()


@dataclass(frozen=True, slots=True)
class Report:
    """All of it.

    Attributes:
        begun: date and time of day, ISO 8601; empty where unknown.
        outcome: of the run, by the replayer. complaints: why the logs do not match the behaviour.
        injected: faults that were injected.
        unknown: what is unknown or was assumed, in words.
    """

    title: str
    run: str
    begun: str
    duration: float
    simulated: bool
    outcome: str
    complaints: tuple[str, ...]
    injected: tuple[str, ...]
    robots: tuple[RobotReport, ...]
    tasks: tuple[TaskReport, ...]
    deviations: tuple[Deviation, ...]
    moves: tuple[MoveReport, ...]
    waits: tuple[WaitReport, ...]
    energies: tuple[EnergyReport, ...]
    approaches: tuple[Approach, ...]
    separations: tuple[Separation, ...]
    photos: tuple[PhotoReport, ...]
    readings: tuple[Measurement, ...]
    events: tuple[Event, ...]
    links: tuple[LinkReport, ...]
    unknown: tuple[str, ...]
