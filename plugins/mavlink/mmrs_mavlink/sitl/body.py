"""Motion of a simulated vehicle: a point with limited speed, acceleration and turn rate, in the wind."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, radians, sin, sqrt

Vector = tuple[float, float, float]

STEP = 0.05
"""Longest step of integration, seconds."""

CUT = 1.73
"""Metres from a corner to the apex of the turning parabola; 1.67 in finite steps.

ArduCopter 4.7-dev in simulation was measured to pass at 1.65 to 1.69 m.
"""

STRAIGHT = 0.05
"""Sine of half a turn below which two legs count as straight."""

PASSING = 0.3
"""Metres from a target at which the turn to the next leg begins at the latest."""

TURNING = 0.7
"""Lateral speed, metres per second, above which the vehicle is still turning."""

BACK_RATE, BACK_PACE = 0.4, 0.6
"""Correction of the cross-track error: fraction of it per second, and metres per second at most."""

STILL: Vector = (0.0, 0.0, 0.0)


@dataclass(slots=True)
class Body:
    """A point in metres north, east and up of home, with a heading in degrees.

    Attributes:
        position: estimated position. error: metres north and east by which the estimate is wrong.
        target: destination; None: it brakes.
        onward: destination after the target, which it passes without a stop; None: it stops at the target.
        origin: start of the leg that it tracks; None: it heads straight for its target.
        corner_pace: metres per second in the turn from the previous leg.
        cut: metres from a corner at which it passes.
        driven: speed ahead, metres per second, and turn rate, degrees per second, commanded instead.
        speed: commanded ground speed, metres per second; climb, descent: limits of the vertical speed.
        wind: mean velocity of the air, metres per second north, east and up.
        airspeed: greatest air speed.
        adrift: whether it drifts with the wind.
    """

    position: Vector = STILL
    velocity: Vector = STILL
    heading: float = 0.0
    target: Vector | None = None
    onward: Vector | None = None
    origin: Vector | None = None
    corner_pace: float = 0.0
    driven: tuple[float, float] | None = None
    cut: float = CUT
    wanted_heading: float | None = None
    speed: float = 5.0
    climb: float = 2.5
    descent: float = 1.5
    acceleration: float = 2.5
    turn_rate: float = 90.0
    wind: Vector = STILL
    airspeed: float = 18.0
    adrift: bool = False
    error: tuple[float, float] = (0.0, 0.0)

    def advance(self, seconds: float) -> None:
        """Move for that long."""
        while seconds > 0.0:
            step = min(seconds, STEP)
            seconds -= step
            self._accelerate(self._in_the_wind(self._wanted_velocity()), step)
            self.position = plus(self.position, self.velocity, step)
            self._turn(step)

    @property
    def place(self) -> Vector:
        """Return the true position."""
        north, east, up = self.position
        return (north - self.error[0], east - self.error[1], up)

    def shift_estimate(self, north: float, east: float) -> None:
        """Set the error of the position estimate, in metres."""
        (true_north, true_east, up), self.error = self.place, (north, east)
        self.position = (true_north + north, true_east + east, up)

    def distance_to(self, place: Vector) -> float:
        """Return the distance to a place."""
        return hypot(*plus(place, self.position, -1.0))

    @property
    def pace(self) -> float:
        """Return the ground speed."""
        return hypot(*self.velocity)

    @property
    def air_pace(self) -> float:
        """Return the horizontal air speed."""
        return hypot(self.velocity[0] - self.wind[0], self.velocity[1] - self.wind[1])

    def rest_at(self, up: float) -> None:
        """Stop at a height."""
        self.position = (self.position[0], self.position[1], up)
        self.velocity = STILL
        self.target = self.onward = self.origin = None

    def start_next_leg(self) -> None:
        """Track the leg from the present target to the next."""
        self.origin, self.corner_pace = self.target, self._corner()[0]

    def passes_target(self) -> bool:
        """Return whether it is near enough to its target to turn to the next."""
        if self.target is None:
            return False
        _, before = self._corner()
        return self.distance_to(self.target) <= max(before, PASSING)

    def _wanted_velocity(self) -> Vector:
        if self.driven is not None:
            ahead = radians(self.heading)
            return (self.driven[0] * cos(ahead), self.driven[0] * sin(ahead), 0.0)
        if self.target is None:
            return STILL
        path = plus(self.target, self.position, -1.0)
        left = hypot(*path)
        if left < 1e-3:
            return STILL
        corner, before = self._corner()
        pace = sqrt(corner * corner + 2.0 * 0.8 * self.acceleration * max(0.0, left - before))
        pace = min(self._fastest(path), pace if corner else min(pace, left / STEP))
        if self.origin is not None and left > before:
            return self._along_the_leg(self.origin, self.target, pace)
        return plus(STILL, path, pace / left)

    def _fastest(self, path: Vector) -> float:
        """Return the greatest speed along a path within the limits of the vertical speed."""
        limit = self.climb if path[2] > 0 else self.descent
        return min(self.speed, limit * hypot(*path) / abs(path[2])) if path[2] else self.speed

    def _along_the_leg(self, origin: Vector, target: Vector, pace: float) -> Vector:
        """Return a velocity along the leg that also corrects the cross-track error."""
        leg, done = plus(target, origin, -1.0), plus(self.position, origin, -1.0)
        square = sum(part * part for part in leg)
        if square < 1e-6:
            return STILL
        along = sum(a * b for a, b in zip(leg, done, strict=True)) / square
        aside = plus(plus(origin, leg, along), self.position, -1.0)
        back = min(BACK_RATE, BACK_PACE / max(hypot(*aside), 1e-6))
        if self._turns(leg, square):
            pace = min(pace, self.corner_pace)
        if along > 1.0:
            pace = -pace  # it has overshot
        return plus(plus(STILL, leg, pace / sqrt(square)), aside, back)

    def _turns(self, leg: Vector, square: float) -> bool:
        """Return whether it still moves laterally from the previous leg."""
        part = sum(a * b for a, b in zip(leg, self.velocity, strict=True)) / square
        return hypot(*plus(self.velocity, leg, -part)) > TURNING

    def _corner(self) -> tuple[float, float]:
        """Return the speed in the corner at the target, and the distance before it at which the turn begins.

        A constant acceleration from one leg to the next makes a parabola: it begins v² s / a before
        the corner and passes it at v² s² / 2a, with s the sine of half the turn.
        """
        if self.onward is None or self.target is None:
            return 0.0, 0.0
        path, leg = plus(self.target, self.position, -1.0), plus(self.onward, self.target, -1.0)
        left, length = hypot(*path), hypot(*leg)
        if left < 1e-6 or length < 1e-6:
            return 0.0, 0.0
        cosine = sum(a * b for a, b in zip(path, leg, strict=True)) / (left * length)
        half = sqrt(max(0.0, (1.0 - cosine) / 2.0))
        fastest = min(self._fastest(path), self._fastest(leg))
        if half < STRAIGHT:
            return fastest, 0.0
        pace = min(fastest, sqrt(2.0 * self.acceleration * self.cut) / half)
        pace = min(pace, sqrt(0.45 * length * self.acceleration / half))
        return pace, pace * pace * half / self.acceleration

    def _in_the_wind(self, wanted: Vector) -> Vector:
        """Return the ground velocity that the air speed allows in this wind."""
        air = self.wind
        if self.adrift:
            return (air[0], air[1], wanted[2])
        if air == STILL:
            return wanted
        north, east = wanted[0] - air[0], wanted[1] - air[1]
        needed = hypot(north, east)
        if needed <= self.airspeed:
            return wanted
        pace = hypot(wanted[0], wanted[1])
        ahead = (air[0] * wanted[0] + air[1] * wanted[1]) / pace if pace else 0.0
        across = hypot(*air[:2]) ** 2 - ahead * ahead
        if pace and across <= self.airspeed**2:
            part = (ahead + sqrt(self.airspeed**2 - max(0.0, across))) / pace
            return (wanted[0] * part, wanted[1] * part, wanted[2])
        part = self.airspeed / needed
        return (air[0] + north * part, air[1] + east * part, wanted[2])

    def _accelerate(self, wanted: Vector, step: float) -> None:
        """Approach a velocity; on a leg in all directions alike, so that a climb stays on the leg."""
        north, east, up = plus(wanted, self.velocity, -1.0)
        limit = self.acceleration * step
        level, upwards = (min(1.0, limit / size) if size else 1.0 for size in (hypot(north, east), abs(up)))
        if self.origin is not None:
            level = upwards = min(level, upwards)
        self.velocity = plus(self.velocity, (north * level, east * level, up * upwards), 1.0)

    def _turn(self, step: float) -> None:
        if self.driven is not None:
            self.heading = (self.heading + self.driven[1] * step) % 360.0
            return
        if self.wanted_heading is None:
            return
        left = (self.wanted_heading - self.heading + 180.0) % 360.0 - 180.0
        limit = self.turn_rate * step
        self.heading = (self.heading + max(-limit, min(limit, left))) % 360.0


def wind_of(speed: float, comes_from: float) -> Vector:
    """Return the velocity of the air from a wind speed and the direction it comes from, in degrees."""
    return (-speed * cos(radians(comes_from)), -speed * sin(radians(comes_from)), 0.0)


def plus(a: Vector, b: Vector, factor: float) -> Vector:
    """Return a + factor b."""
    return (a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor)
