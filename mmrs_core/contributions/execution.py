"""What executes behaviours: backends that move robots, buses that carry notifies, conditions.

Times are seconds of the run's clock throughout.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol, runtime_checkable

from mmrs_core.behaviour.program import Action, Move, Program, RobotProgram, SlotId
from mmrs_core.contributions.rules import MoveKind, RobotKind
from mmrs_core.contributions.wiring import Wirings
from mmrs_core.flight.bus.words import CommandId as CommandId
from mmrs_core.flight.bus.words import SlotState as SlotState
from mmrs_core.scene import Area, Name, Policy, Position, RobotType


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
        detected: names of what the robot has detected so far.
        answers: what the operator has answered so far, by question.
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
            response: a literal of PolicyResponse: how; ``NOTHING``: hands off, somebody else has the robot.

        In real time `finished` then says when the robot has obeyed, and `fault` why it cannot.
        """
        ...


@runtime_checkable
class Preparing(Protocol):
    """What a backend may have beside the rest: robots that take time to get ready.

    A run in real time begins when all its robots are ready, or not at all.
    """

    def prepare(self, now: float) -> None:
        """Begin to get the robot ready; `finished` says when it is, `fault` why it cannot be."""
        ...


@runtime_checkable
class Recovering(Protocol):
    """What a backend may have beside the rest: a robot that goes on where its program was broken off."""

    def recover(self, passed: Sequence[str], begun: str, now: float) -> None:
        """Begin to bring the robot back to where it was; `finished` says when it is there.

        Args:
            passed: the moves that it has ended, in order.
            begun: the move that it is to begin once more; empty where it has ended its last one.
            now: the time.
        """
        ...


@runtime_checkable
class Watched(Protocol):
    """What a backend may have beside the rest: how far a robot is that was told to stop."""

    def obeys(self, now: float) -> bool:
        """Return whether the robot has confirmed that it now does what it was told by `stop`."""
        ...

    def watched(self, now: float) -> bool:
        """Return whether the robot has stopped, and would do something else if nobody watched it."""
        ...


@runtime_checkable
class Doubting(Protocol):
    """What a backend may have beside the rest: somebody else may have taken the robot."""

    def in_doubt(self, now: float) -> bool:
        """Return whether that is being found out; orders wait for it, and it takes seconds at most."""
        ...


@runtime_checkable
class Pausable(Protocol):
    """What a backend may have beside the rest: a robot that can halt in the middle of anything."""

    def pause(self, now: float) -> None:
        """Begin to halt; idempotent."""
        ...

    def resume(self, now: float) -> None:
        """Go on with what was begun before; idempotent."""
        ...

    def paused(self, now: float) -> bool:
        """Return whether the robot has confirmed that it halts, and not yet that it goes on."""
        ...


@runtime_checkable
class Noting(Protocol):
    """What a backend may have beside the rest: a black box of the robot."""

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Keep something that the interpreter decided, was ordered, or waited for; raises nothing."""
        ...


@runtime_checkable
class Closing(Protocol):
    """What a backend may have beside the rest: links and threads that end with the run."""

    def close(self) -> None:
        """Release what it holds; the robot keeps whatever state it is in."""
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
class Live:
    """What backends of a run in real time may use beside the rest.

    Attributes:
        clock: of the run.
        wake: has the interpreter look at this robot at once; to be called, from any thread, whenever
            the robot's answers may have changed.
        say: tells people something about this robot, from any thread.
        run: identifier of the run.
        folder: of the logs; None where none are kept.
        resumed: whether the run was broken off before, so that robots may be anywhere on their ways.
        passed: moves that this robot ended before, in order.
        begun: the move that it had begun then; empty where it had ended its last one.
        links: how robots are reached, as in ``--connect``, by robot of this process.
        shared: what backends of the same run share, by names of their own; empty at first.
    """

    clock: Clock
    wake: Callable[[], None]
    say: Callable[[str], None]
    run: str
    folder: Path | None = None
    resumed: bool = False
    passed: tuple[str, ...] = ()
    begun: str = ""
    links: Mapping[str, str] = field(default_factory=dict)
    shared: dict[str, object] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class BackendInput:
    """All that a backend may use.

    Attributes:
        options: as in ``--backend-option``.
        policies: of the robot, in the order in which they go: the first for an event counts.
        areas: of the context as drawn; empty where none was given.
        live: of a run in real time; None in simulated time.
        device_actions: how devices are wired, by property.
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
    live: Live | None = None
    device_actions: Wirings = field(default_factory=dict)


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


class Delivery(Protocol):
    """A notify on its way to the owners of its slots, in two steps.

    First every owner is asked: it keeps the slots for this sender and tells its logical time, so that
    the sender can record the notify after all that has happened to them. Then it is sent.
    """

    @property
    def lamport(self) -> int | None:
        """Return the least logical time that the notify may have; None until every owner has answered."""
        ...

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the owners that have still to answer or, once it was sent, to acknowledge."""
        ...

    def send(self, lamport: int) -> None:
        """Have every owner apply it; called once, after the notify was recorded with that time.

        Sent again until all have acknowledged, whether or not anybody still waits for that.

        Raises:
            ValueError: if the time is less than `lamport`, or that is not known yet.
        """
        ...

    def withdraw(self) -> None:
        """Give it up: owners that were asked are free again; what was sent cannot be called back."""
        ...


class Bus(Protocol):
    """Carries notifies between robots. Only a slot's owner changes it; waits look at its state.

    A slot that is kept for a sender is neither passed nor set by others until that sender has sent
    or withdrawn its notify, or is lost.
    """

    def prepare(self, id: CommandId, slots: tuple[SlotId, ...], active: bool) -> Delivery:
        """Ask the owners of slots for setting them; returns at once.

        Owners that share a process answer, and apply what is sent, before the call returns, in one
        instant. A command is applied once, however often it arrives.
        """
        ...

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot, as far as it is known here; one's own is always known."""
        ...

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait for these own slots is passed at that time, and if so keep the time.

        To be called before the step is recorded: notifies of these slots are then ordered after it.
        False where one is inactive, or kept for a sender, or something happened to it since that time.
        """
        ...

    def lost(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that will set no more slots or cannot be reached."""
        ...

    def unseen(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have never been here: not come yet, or gone before."""
        ...

    def trouble(self, robot: str) -> str:
        """Return why what others tell a robot of this process cannot be kept now; empty: it can."""
        ...

    def leave(self, robot: str) -> None:
        """Tell everybody that a robot of this process will set no more slots; idempotent."""
        ...

    def on_change(self, callback: Callable[[], None]) -> None:
        """Have a function called, from any thread, when something may have changed; it must not block."""
        ...


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
