"""What executes behaviours: backends that move robots, buses that carry notifies, conditions.

Times are seconds of the run's clock throughout.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from mmrs_core.behaviour.program import Action, Move, Program, RobotProgram, SlotId
from mmrs_core.contributions.rules import MoveKind, RobotKind
from mmrs_core.scene import Area, Name, Policy, Position, RobotType


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
    """

    which: str
    reason: str = ""

    def __str__(self) -> str:
        """Return both, as logs write them."""
        return f"{self.which}: {self.reason}" if self.reason else self.which


class Backend(Protocol):
    """Moves one robot. Calls return at once; any may raise LinkLostError.

    The interpreter begins one movement or action at a time and asks until it has finished.
    """

    def begin(self, move: Move, now: float, *, through: bool = False) -> None:
        """Begin a movement, Start and Stop included; `through`: it need not stop at the end."""
        ...

    def act(self, action: Action, now: float) -> None:
        """Begin a device or feedback action."""
        ...

    def finished(self, now: float) -> bool:
        """Return whether what was begun last has finished."""
        ...

    def fault(self, now: float) -> Fault | None:
        """Return what went wrong up to now, if anything; asked before `finished`."""
        ...

    def next_event(self, now: float) -> float | None:
        """Return when it will be worth asking again, inf: never; None: at the clock's own pace."""
        ...

    def wait(self, now: float) -> None:
        """Hold the pose until the next begin."""
        ...

    def state(self, now: float) -> RobotState:
        """Return what is known of the robot."""
        ...

    def stop(self, now: float, response: str = "HOLD") -> None:
        """Bring the robot to a safe halt, from any state; idempotent.

        Args:
            now: time at which it begins.
            response: a literal of PolicyResponse: how.
        """
        ...


@runtime_checkable
class Recorder(Protocol):
    """What a backend may have beside the rest: the way of its robot, for pictures and people."""

    @property
    def notes(self) -> Sequence[str]:
        """Return what was taken for granted, each line without the robot's name."""
        ...

    def track(self) -> tuple[Sample, ...]:
        """Return the way that the robot has come."""
        ...


@dataclass(frozen=True, slots=True)
class BackendInput:
    """All that a backend may use.

    Attributes:
        options: as in ``--backend-option``.
        policies: of the robot, in the order in which they go: the first for an event counts.
        areas: of the context as drawn; empty where none was given.
    """

    program: Program
    robot: RobotProgram
    type: RobotType
    robot_kinds: Mapping[Name, RobotKind]
    move_kinds: Mapping[Name, MoveKind]
    environment: Mapping[str, float]
    options: Mapping[str, str]
    policies: tuple[Policy, ...] = ()
    areas: tuple[Area, ...] = ()


@dataclass(frozen=True, slots=True)
class BackendFactory:
    """What makes backends of one sort.

    Attributes:
        name: as in ``--backend``.
        description: one line for people.
        connect: a backend for one robot. Raises LinkLostError where the robot does not answer,
            UnsupportedError for an option that it does not know and for what it cannot do.
        simulated: whether its time is simulated, so that a run jumps from event to event;
            ``mmrs simulate`` takes no other.
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
        holds: whether it holds for a robot in that state. What it raises is a fault of the robot.
    """

    identifier: str
    holds: Callable[[RobotState], bool]


@dataclass(frozen=True, slots=True)
class CommandId:
    """What makes a notify recognisable however often it arrives.

    Attributes:
        run: identifier of the run. sender: the notifying robot. incarnation: differs each time that
            the sender is started. sequence: counted by the sender, never used twice.
    """

    run: str
    sender: str
    incarnation: str
    sequence: int


@dataclass(frozen=True, slots=True)
class SlotCommand:
    """Has the owners of slots set them; the same command may arrive several times.

    Attributes:
        slots: (owner, slot name), at least one.
        active: the value to set, never to toggle.
        lamport: logical time of the notify.
    """

    id: CommandId
    slots: tuple[SlotId, ...]
    active: bool
    lamport: int


@dataclass(frozen=True, slots=True)
class SlotState:
    """The state of a slot.

    Attributes:
        version: how many commands its owner has applied to it.
        lamport: logical time of the last step that set it or passed a wait for it.
        writer: who set it last; empty if nobody has.
    """

    active: bool = False
    version: int = 0
    lamport: int = 0
    writer: str = ""


class Bus(Protocol):
    """Carries notifies between robots. Only a slot's owner changes it; waits look at its state."""

    def notify(self, command: SlotCommand) -> None:
        """Deliver a command; return when every owner has applied and acknowledged it.

        Owners apply a command once, however often it arrives. Owners that share the bus apply it in
        one instant.

        Raises:
            LinkLostError: if an owner does not acknowledge in time; names each such owner.
        """
        ...

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot, as far as it is known here; one's own is always known."""
        ...

    def passed(self, slots: Iterable[SlotId], lamport: int) -> None:
        """Record that a wait for these slots was passed, so that later notifies are ordered after it."""
        ...


class Clock(Protocol):
    """The time of a run."""

    def now(self) -> float:
        """Return the seconds since the run began."""
        ...

    def sleep_until(self, time: float) -> None:
        """Return when that time has come."""
        ...
