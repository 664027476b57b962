"""What executions of behaviours know of robots: their states, ways and faults, the time, and conditions.

Times are seconds of the run's clock throughout.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from mmrs_core.scene import Position


@dataclass(frozen=True, slots=True)
class RobotState:
    """What is known of a robot at one time.

    Attributes:
        time: seconds of the run's clock.
        position: (east, north, up), metres. speed: metres per second. heading: degrees clockwise
            from north.
        energy: joules left; inf for a wired robot, None where nothing is known.
        charge: part of the battery that is left, 0 to 1; None where nothing is known.
        wind: metres per second; None where nothing is known.
        detected: names of what the robot has detected so far. places: where, as far as it knows.
        found: names of what it, or a robot that has notified it since, has detected.
        answers: what the operator has answered, by question, and no choice has used up.
    """

    time: float
    position: Position
    speed: float
    heading: float
    energy: float | None
    charge: float | None = None
    wind: float | None = None
    detected: frozenset[str] = frozenset()
    answers: Mapping[str, bool] = field(default_factory=dict)
    places: Mapping[str, Position] = field(default_factory=dict)
    found: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Sample:
    """A point of the way that a robot has come; between two of them it went straight and evenly.

    Attributes:
        time: seconds of the run's clock. east, north, up: metres.
        energy: joules left; inf for a wired robot, None where nothing is known.
    """

    time: float
    east: float
    north: float
    up: float
    energy: float | None

    @property
    def position(self) -> Position:
        """Return where the robot was: east, north, up."""
        return (self.east, self.north, self.up)


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that ends a robot's mission.

    Attributes:
        which: a literal of PolicyEvent where policies answer it, otherwise a word of the backend's,
            such as ``BATTERY_EMPTY``.
        reason: for people; may be empty.
        instead: the response, where what policies say cannot be carried out; else empty.
    """

    which: str
    reason: str = ""
    instead: str = ""

    def __str__(self) -> str:
        """Return both, as logs write them."""
        return f"{self.which}: {self.reason}" if self.reason else self.which


def _always(state: RobotState) -> bool:
    return True


@dataclass(frozen=True, slots=True)
class Condition:
    """A function that decides Choices.

    Attributes:
        identifier: as in Choice.conditionIdentifier.
        holds: whether it holds for a robot in that state. What it raises is a fault of the robot.
        known: whether it can be decided yet; until then the robot waits, as it does for slots.
    """

    identifier: str
    holds: Callable[[RobotState], bool]
    known: Callable[[RobotState], bool] = field(default=_always)


class Clock(Protocol):
    """The time of a run."""

    @property
    def passes_by_itself(self) -> bool:
        """Return whether it is worth waiting for what nobody can foresee: time goes on by itself."""
        ...

    def now(self) -> float:
        """Return the seconds since the run began."""
        ...

    def sleep_until(self, time: float) -> None:
        """Return when that time has come, or earlier if somebody calls `wake`."""
        ...

    def wake(self) -> None:
        """End the present or next sleep at once; from any thread."""
        ...
