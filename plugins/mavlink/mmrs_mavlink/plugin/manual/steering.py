"""Stick positions of a pilot, so that a vehicle gets somewhere by heading, depth and time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, cos, degrees, hypot, radians, sin

from mmrs_runtime.controllers.geodesy import turn

NEAR, NEAR_DEPTH, NEAR_HEADING = 0.3, 0.15, 4.0
"""Metres, metres and degrees within which a goal is reached."""

STRAIGHT = 15.0
"""Degrees off its course up to which a vehicle goes ahead; beyond, it turns on the spot first."""

SLOW_DOWN = 0.5
"""Metres per second for each metre that is left."""

FULL_TURN_AT, FULL_CLIMB_AT = 45.0, 1.0
"""Degrees, and metres of depth, of error at which the stick is at its end."""

GRACE, PATIENCE, LEAST_SPEED, SLOWEST_CLIMB = 60.0, 3.0, 0.05, 0.05
"""Seconds that a goal may take, the factor of its path's duration, and the slowest climb, m/s."""

LEAST = 0.12
"""Part of the stick's way below which autopilots take it to be let go."""


@dataclass(frozen=True, slots=True)
class Sticks:
    """Where the sticks are, each from -1 to 1; at rest the vehicle holds heading and depth."""

    forward: float = 0.0
    up: float = 0.0
    turn: float = 0.0


@dataclass(frozen=True, slots=True)
class Goal:
    """What is to be reached.

    Attributes:
        east, north: metres from the origin; None: wherever it is.
        depth: metres below the surface.
        heading: in the end, degrees clockwise from north; None: any.
        speed: metres per second; seconds: for how long the goal is held before it counts as reached.
    """

    depth: float
    east: float | None = None
    north: float | None = None
    heading: float | None = None
    speed: float = 0.5
    seconds: float = 0.0


class StickSteering:
    """Steers towards goals, and estimates the vehicle's position.

    Attributes:
        east, north: dead reckoning, metres from the origin.
        heading, depth: as last received.
        reached: whether the goal is.
    """

    def __init__(self, east: float, north: float, full_speed: float) -> None:
        """Begin at a place, with no goal.

        Args:
            east: metres from the origin.
            north: likewise.
            full_speed: metres per second with the stick ahead to its end.
        """
        self.east, self.north, self.heading, self.depth = east, north, 0.0, 0.0
        self.reached = True
        self._full_speed = full_speed
        self._goal: Goal | None = None
        self._since: float | None = None
        self._forward, self._time = 0.0, None  # type: tuple[float, float | None]

    @property
    def speed(self) -> float:
        """Return how fast it goes by the sticks, metres per second."""
        return abs(self._forward) * self._full_speed

    @property
    def goal(self) -> Goal | None:
        """Return what it steers towards."""
        return self._goal

    def aim(self, goal: Goal) -> None:
        """Steer towards a goal from now on."""
        self._goal, self._since, self.reached = goal, None, False

    def step(self, now: float, heading: float, depth: float) -> Sticks:
        """Return where the sticks are to be from now on.

        Args:
            now: seconds.
            heading: of the vehicle, degrees clockwise from north.
            depth: of the vehicle, metres.
        """
        self._reckon(now, heading, depth)
        goal = self._goal
        if goal is None:
            return Sticks()
        sticks = self._towards(goal)
        left = self._left(goal)
        there = left is None or left[0] <= NEAR
        there = there and self._off(goal) is None and abs(depth - goal.depth) <= NEAR_DEPTH
        self._since = (now if self._since is None else self._since) if there else None
        if self._since is not None and now - self._since >= goal.seconds:
            self.reached = True
        self._forward = sticks.forward
        return sticks

    def drift(self, now: float) -> Sticks:
        """Let the sticks go for now, since heading or depth is not known; the goal stays."""
        self._reckon(now, self.heading, self.depth)
        self._forward = 0.0
        return Sticks()

    def hold(self) -> None:
        """Stay at the reckoned place, and at the depth where it is."""
        self.aim(Goal(self.depth, self.east, self.north))

    def seconds(self, goal: Goal) -> float:
        """Return how long a goal may take from here before something must be wrong."""
        way = 0.0
        if goal.east is not None and goal.north is not None:
            way = hypot(goal.east - self.east, goal.north - self.north)
        climb = abs(goal.depth - self.depth)
        return GRACE + PATIENCE * way / max(LEAST_SPEED, goal.speed) + climb / SLOWEST_CLIMB + goal.seconds

    def _reckon(self, now: float, heading: float, depth: float) -> None:
        if self._time is not None:
            way = self._forward * self._full_speed * max(0.0, now - self._time)
            middle = radians(self.heading + turn(self.heading, heading) / 2.0)
            self.east, self.north = self.east + way * sin(middle), self.north + way * cos(middle)
        self._time, self.heading, self.depth = now, heading, depth

    def _towards(self, goal: Goal) -> Sticks:
        up = _deflected((self.depth - goal.depth) / FULL_CLIMB_AT, NEAR_DEPTH / 2.0 / FULL_CLIMB_AT)
        sticks = Sticks(up=up)
        left = self._left(goal)
        if left is not None and left[0] > NEAR:
            distance, course = left
            off = turn(self.heading, course)
            speed = min(goal.speed, max(0.15, SLOW_DOWN * distance))
            ahead = min(1.0, speed / self._full_speed) if abs(off) <= STRAIGHT else 0.0
            return replace(sticks, forward=max(ahead, LEAST) if ahead else 0.0, turn=_to_turn(off))
        off_heading = self._off(goal)
        return replace(sticks, turn=_to_turn(off_heading)) if off_heading is not None else sticks

    def _left(self, goal: Goal) -> tuple[float, float] | None:
        """Return metres and course to the goal's place; None where it has none."""
        if goal.east is None or goal.north is None:
            return None
        east, north = goal.east - self.east, goal.north - self.north
        return hypot(east, north), degrees(atan2(east, north))

    def _off(self, goal: Goal) -> float | None:
        """Return by how many degrees it is off the goal's heading; None where it is not."""
        off = 0.0 if goal.heading is None else turn(self.heading, goal.heading)
        return off if abs(off) > NEAR_HEADING else None


def _to_turn(off: float) -> float:
    return _deflected(off / FULL_TURN_AT, 1.0 / FULL_TURN_AT)


def _deflected(wanted: float, least: float) -> float:
    """Return a stick that an autopilot obeys: none for next to nothing, otherwise no less than it takes."""
    if abs(wanted) <= least:
        return 0.0
    part = max(LEAST, min(1.0, abs(wanted)))
    return part if wanted > 0.0 else -part
