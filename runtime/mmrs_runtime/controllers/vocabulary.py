"""The words that all programs of robots are written in; drivers add those of their vehicles.

A program is a table of steps. Each step is one move of the behaviour: actions before it, the
movement, actions after it, and what comes then. Places are metres or degrees with seven decimals;
heights are metres above the robot's home (under water: above the surface, so negative).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

from .. import program as runtime
from ..policies import Policy as Policy
from ..program import Choose as Choose
from ..program import Move
from ..program import Notify as Notify
from ..program import Then as Then


@dataclass(frozen=True, slots=True)
class Geographic:
    """A place on the Earth: degrees, and metres above home."""

    latitude: float
    longitude: float
    height: float


@dataclass(frozen=True, slots=True)
class Local:
    """A place near home: metres north and east of it, and above it."""

    north: float
    east: float
    height: float


Place: TypeAlias = Geographic | Local


@dataclass(frozen=True, slots=True)
class Object:
    """Something that has to be found first.

    Attributes:
        expected: its expected position; None where unknown.
        tolerance: metres that it may be from there; None where unknown.
    """

    description: str
    expected: Place | None = None
    tolerance: float | None = None


@dataclass(frozen=True, slots=True)
class Look:
    """What a device points at: `at` is its position by the time the robot turns.

    Attributes:
        angle: at 90 the target is on the device's right side, degrees.
        mount: where the device points when the robot looks north, degrees clockwise.
        gimbal: whether the device turns on its own, so that the robot need not.
        device: number of the gimbal; 0: the first, or all.
    """

    at: Place | Object
    angle: float = 0.0
    mount: float = 0.0
    gimbal: bool = False
    device: int = 0


@dataclass(frozen=True, slots=True)
class Start:
    """The beginning: nothing moves."""


@dataclass(frozen=True, slots=True)
class Stop:
    """The end."""


@dataclass(frozen=True, slots=True)
class Land:
    """Descend straight down and stop the motors."""


@dataclass(frozen=True, slots=True)
class GoTo:
    """Go to a position.

    Attributes:
        speed: metres per second; None: the vehicle's own.
        legs: ``direct``, ``level first`` or ``climb first``.
        distance: metres before the position at which to stop.
        look: None: the front points along the path.
    """

    at: Place | Object
    speed: float | None = None
    legs: str = "direct"
    distance: float = 0.0
    look: Look | None = None


@dataclass(frozen=True, slots=True)
class Hold:
    """Stay for that time, in seconds."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Recharge:
    """Stay at home until the batteries are full, and for that time at least, in seconds."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Turn:
    """Turn on the spot until a device points at something."""

    look: Look


@dataclass(frozen=True, slots=True)
class Skip:
    """A movement that could not be expressed: the robot does nothing; `why` names what is missing."""

    why: str


@dataclass(frozen=True, slots=True)
class Report:
    """Send (key, value) pairs to the control station."""

    name: str
    pairs: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class NoEffect:
    """An action that could not be expressed: it is logged as done; `why` names what is missing."""

    name: str
    why: str


@dataclass(frozen=True, slots=True)
class Step:
    """One move of the behaviour; `task` and `rule` name what it serves."""

    move: str
    movement: object
    before: tuple[object, ...] = ()
    after: tuple[object, ...] = ()
    then: Then | Choose | None = None
    task: str = ""
    rule: str = ""


@dataclass(frozen=True)
class Robot:
    """One robot and all its moves.

    Attributes:
        id: as in the behaviour; log: name of its log file.
        vehicle: a word of its driver, such as ``copter``.
        start: the first move.
        slots: its own; senders: robots that activate each of them; resets: robots that deactivate it.
        volatile: of the (robot, slot) pairs that it notifies, those that any robot deactivates.
        reserve: fraction of the energy that must be left.
        cruise: metres per second at which the robot returns; None: the vehicle's own.
        escapes: by move, the path to an emergency area from where that move ends.
        mission: name of it; plan: what differs where two plans of it do.
        fleet: all robots of it, this one included.
    """

    id: str
    log: str
    vehicle: str
    home: Place
    start: str
    steps: tuple[Step, ...]
    slots: tuple[str, ...] = ()
    senders: tuple[tuple[str, tuple[str, ...]], ...] = ()
    resets: tuple[tuple[str, tuple[str, ...]], ...] = ()
    volatile: tuple[tuple[str, str], ...] = field(default=(), kw_only=True)
    policies: tuple[Policy, ...] = ()
    reserve: float = 0.2
    cruise: float | None = field(default=None, kw_only=True)
    escapes: tuple[tuple[str, tuple[Place, ...]], ...] = field(default=(), kw_only=True)
    mission: str = field(default="", kw_only=True)
    plan: str = field(default="", kw_only=True)
    fleet: tuple[str, ...] = field(default=(), kw_only=True)

    def step(self, move: str) -> Step:
        """Return the step of that move."""
        return next(step for step in self.steps if step.move == move)

    @cached_property
    def executable(self) -> runtime.ExecutableRobot:
        """Return the robot as the engine has it; a movement's order is its step, an action its own."""
        moves = tuple(Move(each.move, each, each.before, each.after, each.then) for each in self.steps)
        return runtime.ExecutableRobot(self.id, moves, self.start, self.slots, self.policies, self.reserve)
