"""How the simulated vehicle moves: a point with limited speed, acceleration and turn rate."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt

Vector = tuple[float, float, float]

STEP = 0.02
"""Longest step of integration, seconds."""


@dataclass(slots=True)
class Body:
    """A point in metres north, east and up of home, with a heading in degrees.

    Attributes:
        target: where it goes; None: it comes to a halt.
        speed: commanded, metres per second; climb, descent: limits of the vertical speed.
    """

    position: Vector = (0.0, 0.0, 0.0)
    velocity: Vector = (0.0, 0.0, 0.0)
    heading: float = 0.0
    target: Vector | None = None
    wanted_heading: float | None = None
    speed: float = 5.0
    climb: float = 2.5
    descent: float = 1.5
    acceleration: float = 2.5
    turn_rate: float = 90.0

    def advance(self, seconds: float) -> None:
        """Move for a while."""
        while seconds > 0.0:
            step = min(seconds, STEP)
            seconds -= step
            self._accelerate(self._wanted_velocity(), step)
            self.position = _plus(self.position, self.velocity, step)
            self._turn(step)

    def distance_to(self, place: Vector) -> float:
        """Return the metres to a place."""
        return hypot(*_plus(place, self.position, -1.0))

    @property
    def pace(self) -> float:
        """Return the present speed in metres per second."""
        return hypot(*self.velocity)

    def rest_at(self, up: float) -> None:
        """Stand still at a height."""
        self.position = (self.position[0], self.position[1], up)
        self.velocity = (0.0, 0.0, 0.0)
        self.target = None

    def _wanted_velocity(self) -> Vector:
        if self.target is None:
            return (0.0, 0.0, 0.0)
        way = _plus(self.target, self.position, -1.0)
        left = hypot(*way)
        if left < 1e-3:
            return (0.0, 0.0, 0.0)
        pace = min(self.speed, sqrt(2.0 * 0.8 * self.acceleration * left), left / STEP)
        vertical = abs(way[2]) / left * pace
        limit = self.climb if way[2] > 0 else self.descent
        if vertical > limit:
            pace *= limit / vertical
        return _plus((0.0, 0.0, 0.0), way, pace / left)

    def _accelerate(self, wanted: Vector, step: float) -> None:
        change = _plus(wanted, self.velocity, -1.0)
        size = hypot(*change)
        limit = self.acceleration * step
        part = 1.0 if size <= limit else limit / size
        self.velocity = _plus(self.velocity, change, part)

    def _turn(self, step: float) -> None:
        if self.wanted_heading is None:
            return
        left = (self.wanted_heading - self.heading + 180.0) % 360.0 - 180.0
        limit = self.turn_rate * step
        self.heading = (self.heading + max(-limit, min(limit, left))) % 360.0


def _plus(a: Vector, b: Vector, factor: float) -> Vector:
    return (a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor)
