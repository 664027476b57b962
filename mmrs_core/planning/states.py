"""Where a robot is in its plan, and what it waits for and how it comes to a piece of work."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from mmrs_core.planning.travel import Route
from mmrs_core.scene import Position, Step
from mmrs_core.scene.timing import MoveSeconds

Trail: TypeAlias = "tuple[Trail, Step] | None"


class State(NamedTuple):
    """Where a robot is in its plan.

    Attributes:
        time: seconds after the mission's start.
        at: where it is.
        away: whether it has left home since it was last there to stay.
        used: seconds on this charge at most; before: of them before it last launched.
        since: when it launched, or began this charge, at the earliest; None: it stands on the ground.
        early, late: when it may be here at the earliest, also if charging ends at once, and at the latest.
        length: metres travelled. busy: seconds away from home. sorties: times it left home.
        trail: its steps so far, last one first.
    """

    time: float
    at: Position
    away: bool = False
    used: float = 0.0
    before: float = 0.0
    since: float | None = None
    early: float = 0.0
    late: float = 0.0
    length: float = 0.0
    busy: float = 0.0
    sorties: int = 0
    trail: Trail = None

    def after(self, route: Route, at: Position, trail: Trail) -> State:
        """Return the state at the end of a route that ends there, with the steps of it."""
        return self.later(route.bounds, route.length, at)._replace(away=True, trail=trail)

    def later(self, seconds: MoveSeconds, length: float, at: Position) -> State:
        """Return the state `seconds` and `length` metres later, without steps."""
        return self._replace(
            time=self.time + seconds.expected,
            at=at,
            used=self.used + seconds.longest,
            early=self.early + seconds.shortest,
            late=self.late + seconds.longest,
            length=self.length + length,
            busy=self.busy + seconds.expected,
        )

    @property
    def bounds(self) -> Bounds:
        """Return when it may be here."""
        return Bounds(self.early, self.late)

    def steps(self) -> tuple[Step, ...]:
        """Return the steps so far, in order."""
        return tuple(reversed(list(_backwards(self.trail))))


def _backwards(trail: Trail) -> Iterator[Step]:
    while trail is not None:
        trail, step = trail
        yield step


class Bounds(NamedTuple):
    """When something may be, seconds.

    Attributes:
        early: at the earliest, also if charging ends at once. late: at the latest.
    """

    early: float = 0.0
    late: float = 0.0


_AT_ONCE = Bounds()


@dataclass(frozen=True, slots=True)
class Ready:
    """What must have happened before a share of work may begin.

    Attributes:
        time: seconds, by when the signals will have been given; bounds: of that.
        signals: that it waits for.
        earliest: seconds before which it may not begin by the clock; None: none.
    """

    time: float = 0.0
    signals: tuple[str, ...] = ()
    earliest: float | None = None
    bounds: Bounds = _AT_ONCE


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
