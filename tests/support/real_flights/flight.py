"""A flight as a value: the models, how it is flown, what happens when, and how it must end."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

RUN, CONTROLLERS, PLAN = "run", "controllers", "plan"
"""By `mmrs run`; by a generated controller for each robot, over the bus; its ``.plan``, in AUTO."""

DONE, HOME, AWAY, HOLDS, SURFACE = "done", "home", "away", "holds", "surface"
"""Ends: the program's own; disarmed or still at home; disarmed elsewhere; armed and still; at the surface."""


@dataclass(frozen=True, slots=True)
class Begun:
    """Once a robot has begun a move, and so many seconds of the vehicle have passed since.

    What happens then, and until the next one, concerns this robot; empty: the first one.
    """

    move: str
    seconds: float = 0.0
    robot: str = ""


@dataclass(frozen=True, slots=True)
class Later:
    """So many seconds of the vehicle after the happening before."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Order:
    """An order of an operator, which must be confirmed."""

    order: str


@dataclass(frozen=True, slots=True)
class Change:
    """Parameters of the vehicle or its simulation that change."""

    parameters: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Cut:
    """The link: `inwards`, what the vehicle sends, `outwards`, what it receives, are lost from now on."""

    inwards: bool = True
    outwards: bool = True


@dataclass(frozen=True, slots=True)
class Pilot:
    """A pilot changes the mode, to this number; of PX4, to its main mode and the mode within it."""

    mode: int
    submode: int = 0


@dataclass(frozen=True, slots=True)
class Disarm:
    """A pilot disarms the vehicle."""


@dataclass(frozen=True, slots=True)
class Kill:
    """The program's process is killed."""


@dataclass(frozen=True, slots=True)
class Resume:
    """The same program is started again, with ``--resume``."""


@dataclass(frozen=True, slots=True)
class Reboot:
    """The autopilot restarts."""


DISARM = Disarm()
MEND = Cut(inwards=False, outwards=False)
"""The link is whole again."""

When: TypeAlias = Begun | Later
Happening: TypeAlias = Order | Change | Cut | Pilot | Disarm | Kill | Resume | Reboot


@dataclass(frozen=True, slots=True)
class Flight:
    """What is flown, and what must come of it.

    Attributes:
        name: unique.
        models: writes the models into a folder: a mission, or a behaviour.
        robots: that take part; empty: all. Of an example whose other robots no firmware simulates.
        way: one of `RUN`, `CONTROLLERS`, `PLAN`.
        happens: in this order, each with its time.
        ends: how each robot ends; its own where `ends_of` names it.
        fault: that the log must hold; empty: none may.
        deviation: metres from the planned line, at most; None: what happens leads away from it.
        timed: whether times are judged; not where the vehicle's owner lets it go more slowly than planned.
        looks: what vehicles must look at in AUTO, metres of the origin, and within how many degrees for nine
            tenths of that time; None: not judged.
        says: what the program must say. photos: fewest and most that the vehicle must report.
        landing: metres in the plane from the planned end, or from home, at most.
        parameters: of the vehicles, beyond those of their firmware.
        arguments: of `mmrs run` or the controllers.
        signed: whether the link is signed.
        speedup: seconds of the vehicles in a second; less where several fly.
        px4: whether copters have a PX4.
    """

    name: str
    models: Callable[[Path], None]
    robots: tuple[str, ...] = ()
    way: str = RUN
    happens: tuple[tuple[When, Happening], ...] = ()
    ends: str = DONE
    fault: str = ""
    deviation: float | None = 1.5
    timed: bool = True
    says: str = ""
    photos: tuple[int, int] = (0, 0)
    looks: tuple[float, float, float] | None = None
    landing: float = 1.0
    parameters: Mapping[str, float] = field(default_factory=dict)
    arguments: tuple[str, ...] = ()
    signed: bool = False
    speedup: float = 4.0
    px4: bool = False
