"""Where a robot is in its plan, and what it waits for and how it comes to a piece of work."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from mmrs_core.planning.travel import Route
from mmrs_core.scene import Position, Step

Trail: TypeAlias = "tuple[Trail, Step] | None"


class State(NamedTuple):
    """Where a robot is in its plan.

    Attributes:
        time: seconds after the mission's start.
        at: where it is.
        away: whether it has left home since it was last there to stay.
        used: seconds on this charge.
        lead: seconds by which it may be here earlier.
        length: metres travelled. busy: seconds away from home. sorties: times it left home.
        trail: its steps so far, last one first.
    """

    time: float
    at: Position
    away: bool = False
    used: float = 0.0
    lead: float = 0.0
    length: float = 0.0
    busy: float = 0.0
    sorties: int = 0
    trail: Trail = None

    def after(self, route: Route, at: Position, trail: Trail) -> State:
        """Return the state at the end of a route that ends there, with the steps of it."""
        there = self.later(route.seconds, route.length, at)
        return there._replace(away=True, lead=self.lead + route.lead, trail=trail)

    def later(self, seconds: float, length: float, at: Position) -> State:
        """Return the state `seconds` and `length` metres later, without steps."""
        return self._replace(
            time=self.time + seconds,
            at=at,
            used=self.used + seconds,
            length=self.length + length,
            busy=self.busy + seconds,
        )

    def steps(self) -> tuple[Step, ...]:
        """Return the steps so far, in order."""
        return tuple(reversed(list(_backwards(self.trail))))


def _backwards(trail: Trail) -> Iterator[Step]:
    while trail is not None:
        trail, step = trail
        yield step


@dataclass(frozen=True, slots=True)
class Ready:
    """What must have happened before a share of work may begin.

    Attributes:
        time: seconds, by when the signals will have been given; soonest: when that may be.
        signals: that it waits for.
        earliest: seconds before which it may not begin by the clock; None: none.
    """

    time: float = 0.0
    signals: tuple[str, ...] = ()
    earliest: float | None = None
    soonest: float = 0.0


@dataclass(frozen=True, slots=True)
class ApproachRoute:
    """How a robot comes to a piece of work.

    Attributes:
        via: places to go to; all routes but the first one are within the task. The last is where the work
            begins.
        speed: commanded, metres per second; None: the robot's cruise.
    """

    via: tuple[Position, ...]
    speed: float | None = None
