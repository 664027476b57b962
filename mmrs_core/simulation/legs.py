"""How a simulated robot gets along: straight legs, evenly travelled, and what they cost.

Cost is counted in seconds at mean power. It grows by `CLIMBING` times the share of the largest climb
rate that is used, and falls by as much in a descent, so that up and down again costs no more than
the time that it takes; it grows by the square of the headwind's share of the largest speed. A robot that
holds its position has the whole wind against it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from math import cos, hypot, inf, radians, sin, sqrt
from typing import NamedTuple, TypeAlias

from mmrs_core.scene import Kinematics, Position
from mmrs_core.scene.headings import turn
from mmrs_core.scene.timing import Rates

CLIMBING = 0.3
"""How much more power a robot takes when it climbs as fast as it can, as a part of the mean power."""

Flow: TypeAlias = tuple[float, float]
STILL: Flow = (0.0, 0.0)


class TimedLeg(NamedTuple):
    """A stretch of time in which a robot goes straight and evenly, or stays where it is.

    Attributes:
        begin, end: seconds of the run's clock; `end` may be inf.
        start, finish: where it is then.
        headings: degrees clockwise from north at both ends; it turns the shorter way round.
        charge: seconds at mean power that its batteries hold at the beginning; inf: wired.
        rate: seconds at mean power that it spends in one second.
    """

    begin: float
    end: float
    start: Position
    finish: Position
    headings: tuple[float, float]
    charge: float
    rate: float

    @property
    def speed(self) -> float:
        """Return its speed in metres per second."""
        way = _length(self.start, self.finish)
        return way / (self.end - self.begin) if way > 0.0 else 0.0

    @property
    def empty_at(self) -> float:
        """Return when the batteries would be empty; inf: never."""
        return self.begin + self.charge / self.rate if self.rate > 0.0 else inf

    def part(self, time: float) -> float:
        """Return how much of the leg is behind at that time, 0 to 1."""
        if self.end == inf:
            return 0.0
        if time < self.end > self.begin:
            return (time - self.begin) / (self.end - self.begin) if time > self.begin else 0.0
        return 1.0

    def position(self, time: float) -> Position:
        """Return where the robot is."""
        part, (east, north, up), goal = self.part(time), self.start, self.finish
        return (east + part * (goal[0] - east), north + part * (goal[1] - north), up + part * (goal[2] - up))

    def heading(self, time: float) -> float:
        """Return degrees clockwise from north, 0 to 360."""
        first, last = self.headings
        return (first + self.part(time) * turn(first, last)) % 360.0

    def charge_at(self, time: float) -> float:
        """Return the seconds at mean power that are left."""
        left = self.charge - self.rate * (time - self.begin) if time > self.begin else self.charge
        return left if left > 0.0 else 0.0

    def until(self, time: float) -> TimedLeg:
        """Return the part of the leg before that time."""
        return self._replace(
            end=max(self.begin, time),
            finish=self.position(time),
            headings=(self.headings[0], self.heading(time)),
        )


class Stretch(NamedTuple):
    """A straight part of a path: where it begins and ends, seconds, and cost in a second."""

    start: Position
    finish: Position
    seconds: float
    rate: float


def stretches(
    path: tuple[Position, ...], rates: Rates, seconds: float, kinematics: Kinematics, *, flow: Flow = STILL
) -> tuple[Stretch, ...]:
    """Return how a robot travels along a path; empty if the flow is too strong for it.

    Args:
        path: straight legs; one position: it stays there.
        rates: at its commanded speed.
        seconds: of the whole path in still air or water.
        kinematics: of the robot.
        flow: velocity of the air or water, east and north, metres per second.
    """
    legs = ((path[0], path[-1]),) if len(path) < 3 else tuple(pairwise(path))
    nominal = [rates.from_stop_to_stop(a, b) for a, b in legs]
    whole = sum(nominal)
    found = []
    for (start, finish), share in zip(legs, nominal, strict=True):
        own = seconds * (share / whole if whole > 0.0 else 1.0 / len(legs))
        slower = _slowed(start, finish, own, _own_speed(kinematics), flow)
        if slower is None:
            return ()
        found.append(Stretch(start, finish, slower, cost(start, finish, slower, kinematics, flow)))
    return tuple(found)


def response_stretches(
    path: tuple[Position, ...], kinematics: Kinematics, flow: Flow, *, moving: bool
) -> tuple[Stretch, ...]:
    """Return how a robot travels when it responds to a fault; empty if the flow is too strong for it.

    It stops at every corner. What it is doing takes its time evenly, speeding up and slowing down
    included: a robot in motion has that behind it, and continues at even speed.

    Args:
        path: straight legs from where it is; one position: it stays there.
        kinematics: of the robot.
        flow: velocity of the air or water, east and north, metres per second.
        moving: whether it is already in motion.
    """
    found: list[Stretch] = []
    rates = replace(kinematics.rates(), shunting=0.0)
    for number, (start, finish) in enumerate(pairwise(path)):
        seconds = rates.even if moving and number == 0 else rates.from_stop_to_stop
        made = stretches((start, finish), rates, seconds(start, finish), kinematics, flow=flow)
        if not made:
            return ()
        found += made
    return tuple(found)


def cost(start: Position, finish: Position, seconds: float, kinematics: Kinematics, flow: Flow) -> float:
    """Return the power of a stretch as a multiple of the mean power, zero or more."""
    climb = (finish[2] - start[2]) / seconds if seconds > 0.0 else 0.0
    climbing = CLIMBING * min(1.0, climb / kinematics.climb) if kinematics.climb > 0.0 else 0.0
    own_speed, headwind = _own_speed(kinematics), 0.0
    if flow != STILL and own_speed > 0.0:
        headwind = max(0.0, _against(start, finish, flow)) / own_speed
    return max(0.0, 1.0 + climbing + headwind**2)


def _against(start: Position, finish: Position, flow: Flow) -> float:
    """Return the headwind or counter-current of a leg; the whole flow where the robot stays."""
    level = hypot(finish[0] - start[0], finish[1] - start[1])
    if level <= 0.0:
        return hypot(*flow)
    return -((finish[0] - start[0]) * flow[0] + (finish[1] - start[1]) * flow[1]) / level


def wind(environment: Mapping[str, float]) -> Flow:
    """Return the velocity of the air, east and north; its direction is where it comes from."""
    speed, direction = environment.get("windSpeed", 0.0), radians(environment.get("windDirection", 0.0))
    return (-speed * sin(direction), -speed * cos(direction))


def current(environment: Mapping[str, float]) -> Flow:
    """Return the velocity of the water, east and north; its direction is where it goes to."""
    speed, direction = environment.get("currentSpeed", 0.0), radians(environment.get("currentDirection", 0.0))
    return (speed * sin(direction), speed * cos(direction))


def _length(start: Position, finish: Position) -> float:
    return hypot(finish[0] - start[0], finish[1] - start[1], finish[2] - start[2])


def _own_speed(kinematics: Kinematics) -> float:
    return kinematics.fastest if kinematics.own_speed is None else kinematics.own_speed


def _slowed(start: Position, finish: Position, seconds: float, own_speed: float, flow: Flow) -> float | None:
    """Return how long the stretch takes in the flow; None if the robot cannot make headway."""
    level = hypot(finish[0] - start[0], finish[1] - start[1])
    if flow == STILL or level <= 0.0 or seconds <= 0.0:
        return seconds
    along = ((finish[0] - start[0]) * flow[0] + (finish[1] - start[1]) * flow[1]) / level
    inside = along**2 - flow[0] ** 2 - flow[1] ** 2 + own_speed**2
    largest = along + sqrt(inside) if inside >= 0.0 else 0.0
    return max(seconds, level / largest) if largest > 1e-6 else None
