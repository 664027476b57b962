"""What carries a robot: the one class that every driver implements, and its events.

The engine gives one order at a time. Every call returns at once; its outcome is reported later, by `post`
or by `look`: that it is done, that there is a fault, or that there is progress. Vehicles report events;
only the engine responds, by policy.

Times are seconds of the run's clock throughout.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from types import MappingProxyType
from typing import TypeAlias

Position: TypeAlias = tuple[float, float, float]


class LinkLost(Exception):  # noqa: N818  # the word that policies and logs use
    """The vehicle cannot be reached."""


@dataclass(frozen=True, slots=True)
class VehicleState:
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
class Done:
    """What was ordered last is done."""


@dataclass(frozen=True, slots=True)
class Progress:
    """Something has changed that the robot may wait for, such as that the vehicle has come to a halt."""


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault, which ends a robot's program unless a policy tolerates it.

    Attributes:
        which: an event of policies where these answer it, otherwise a word of the vehicle's, such as
            ``BATTERY_EMPTY``.
        reason: in words; may be empty.
        instead: the response, where that of the policies cannot be carried out; otherwise empty.
    """

    which: str
    reason: str = ""
    instead: str = ""

    def __str__(self) -> str:
        """Return both, as logs write them."""
        return f"{self.which}: {self.reason}" if self.reason else self.which


Event: TypeAlias = Done | Progress | Fault


class Vehicle(ABC):
    """Carries one robot.

    Only the abstract methods are required; the defaults are those of a plain vehicle, which needs no time to
    get ready, cannot pause, and confirms a stop at once. Any method may raise `LinkLost`.

    Attributes:
        post: reports an event to the engine, from any thread; the engine sets it before anything else.
        done: whether the last order is done, as far as the engine knows.
        trouble: the present fault, as far as the engine knows; None: none.
        reported: `name` and `content` of the robot's last report; empty before the first.
    """

    post: Callable[[Event], None]
    done: bool = True
    trouble: Fault | None = None
    reported: Mapping[str, object] = MappingProxyType({})

    def hear(self, event: Event) -> None:
        """Take note of what was posted; called by the engine, in its thread."""
        if isinstance(event, Done):
            self.done = True
        elif isinstance(event, Fault):
            self.trouble = event

    @abstractmethod
    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a movement or an action.

        Args:
            order: what the program says there.
            now: the time.
            through: it need not stop at the end of a movement.
        """

    @abstractmethod
    def respond(self, response: str, now: float) -> None:
        """Carry out a response to a fault, or to an order, from any state; idempotent.

        `done` then reports that nothing is left to do, and `trouble` why it cannot be carried out.
        ``NOTHING``: hands off, the vehicle is under external control.
        """

    @abstractmethod
    def state(self, now: float) -> VehicleState:
        """Return what is known of the robot."""

    def look(self, now: float) -> float:
        """Bring `done` and `trouble` up to now; return when to look again, if nothing is posted before."""
        return inf

    def wait(self, now: float) -> None:  # noqa: B027
        """Hold the pose until the next order."""

    def bear(self, now: float) -> bool:
        """Continue although there is `trouble`, which a policy tolerates.

        Returns:
            Whether it can; what was broken off then counts as done.
        """
        return True

    # Getting ready, and back to where a program was broken off.

    def prepare(self, now: float) -> bool:
        """Begin to get ready, until it is done; return False where there is nothing to get ready."""
        return False

    def known(self, now: float) -> bool:
        """Return whether it is known, while it gets ready, to be the robot's, and may be commanded."""
        return False

    def recover(self, passed: Sequence[str], begun: str, now: float) -> bool:
        """Begin to bring the robot back to where it was, until it is done.

        Args:
            passed: the moves that it has ended, in order.
            begun: the move that it is to begin once more; empty where it has ended its last one.
            now: the time.

        Returns:
            False where the vehicle cannot do that: it continues from wherever it is.
        """
        return False

    def hindrance(self, passed: Sequence[str], begun: str, now: float) -> str:
        """Return why the robot could not be brought back now, as one that stands elsewhere; or nothing."""
        return ""

    @property
    def comes_home(self) -> bool:
        """Return whether it knows the return path, so that it returns for its battery."""
        return False

    def away(self, now: float) -> str:
        """Return why the robot does not stand at home, as far as is known; empty where it may."""
        return ""

    def moves(self, now: float) -> bool:
        """Return whether the robot was seen in motion, or able to move at any moment."""
        return False

    def change_battery(self, now: float) -> None:  # noqa: B027
        """Begin to count the batteries as changed for full ones, which an operator confirms."""

    def battery_change(self, now: float) -> str | None:
        """Return why the batteries do not count as changed; empty: they do; None: not known yet."""
        return "its charge counts as its battery reports it"

    # Holding in the middle of anything.

    @property
    def pauses(self) -> bool:
        """Return whether it can halt in the middle of anything."""
        return False

    def pause(self, now: float) -> None:  # noqa: B027
        """Begin to halt; idempotent."""

    def resume(self, now: float) -> None:  # noqa: B027
        """Resume what was begun before; idempotent."""

    def paused(self, now: float) -> bool:
        """Return whether the robot has confirmed that it halts, and not yet that it continues."""
        return False

    # What is seen of it once it was told to stop.

    def obeys(self, now: float) -> bool:
        """Return whether the robot has confirmed that it now carries out the response."""
        return False

    def watched(self, now: float) -> bool:
        """Return whether the robot has stopped, or is out of reach, and an operator must stay with it."""
        return False

    def undone(self, now: float) -> str:
        """Return why nothing is left to do, and the response is not carried out; empty where it is."""
        return ""

    def reachable(self, now: float) -> bool:
        """Return whether a message of the robot was received lately, so that it can be commanded."""
        return True

    def in_doubt(self, now: float) -> bool:
        """Return whether external control is suspected, but not yet certain; orders wait for the answer."""
        return False

    # What people, and other robots, learn.

    def status(self) -> Mapping[str, object]:
        """Return what the robot has told last, as JSON has it; empty before it has; from any thread."""
        return {}

    def note(self, kind: str, content: Mapping[str, object]) -> None:  # noqa: B027
        """Keep in a black box what was decided, ordered, or waited for; raises nothing."""

    def learn(self, places: Mapping[str, Position]) -> None:  # noqa: B027
        """Take note of where robots that notified this one have detected things, by name."""

    def close(self) -> None:  # noqa: B027
        """Release what it holds; the robot keeps whatever state it is in."""


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


def _always(state: VehicleState) -> bool:
    return True


@dataclass(frozen=True, slots=True)
class Condition:
    """A function that decides Choices.

    Attributes:
        identifier: as in Choice.conditionIdentifier.
        holds: whether it holds for a robot in that state. What it raises is a fault of the robot.
        known: whether it can be decided yet; until then the robot waits, as it does for slots.
        instant: whether both answer at once; otherwise a run in real time asks them in a thread of their own.
    """

    identifier: str
    holds: Callable[[VehicleState], bool]
    known: Callable[[VehicleState], bool] = field(default=_always)
    instant: bool = False

    def asked(self, state: VehicleState) -> object:
        """Return whether it holds in a state, as it says; None while it cannot be decided.

        Raises:
            TypeError: it says neither.
        """
        if not self.known(state):
            return None
        if (holds := self.holds(state)) is None:
            raise TypeError("None is neither True nor False")
        return holds
