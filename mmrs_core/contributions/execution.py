"""What executes behaviours: backends that move robots, conditions that decide Choices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

from mmrs_core.behaviour.program import Action, Move, Program, RobotProgram
from mmrs_core.contributions.rules import MoveKind, RobotKind
from mmrs_core.scene import Name, Position, RobotType


@dataclass(frozen=True, slots=True)
class RobotState:
    """What is known of a robot at one time.

    Attributes:
        time: seconds of the run's clock.
        position: (east, north, up), metres. speed: metres per second. heading: degrees clockwise
            from north.
        energy: joules left; inf for a wired robot, None where nothing is known.
    """

    time: float
    position: Position
    speed: float
    heading: float
    energy: float | None


class Backend(Protocol):
    """Moves one robot. Times are seconds of the run's clock; calls return at once."""

    def begin(self, move: Move, now: float) -> None:
        """Begin a movement."""
        ...

    def act(self, action: Action, now: float) -> None:
        """Begin a device or feedback action."""
        ...

    def finished(self, now: float) -> bool:
        """Return whether what was begun last has finished."""
        ...

    def next_event(self, now: float) -> float | None:
        """Return when it will be worth asking again; None: at the clock's own pace."""
        ...

    def wait(self, now: float) -> None:
        """Hold the pose until the next begin."""
        ...

    def state(self, now: float) -> RobotState:
        """Return what is known of the robot."""
        ...

    def stop(self, now: float) -> None:
        """Bring the robot to a safe halt, from any state; idempotent."""
        ...


@dataclass(frozen=True, slots=True)
class BackendInput:
    """All that a backend may use."""

    program: Program
    robot: RobotProgram
    type: RobotType
    robot_kinds: Mapping[Name, RobotKind]
    move_kinds: Mapping[Name, MoveKind]
    environment: Mapping[str, float]
    options: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class BackendFactory:
    """What makes backends of one sort.

    Attributes:
        name: as in ``--backend``.
        description: one line for people.
        connect: a backend for one robot. Raises LinkLostError where the robot does not answer,
            ValueError for an option it does not know.
        simulated: whether its time is simulated: the run then jumps from event to event.
    """

    name: str
    description: str
    connect: Callable[[BackendInput], Backend]
    simulated: bool = False


@dataclass(frozen=True, slots=True)
class Condition:
    """A function that decides Choices.

    Attributes:
        identifier: as in Choice.conditionIdentifier.
        holds: whether it holds for a robot in that state.
    """

    identifier: str
    holds: Callable[[RobotState], bool]
