"""Motion of a simulated vehicle: a point that takes legs as autopilots do.

On missions and returns a leg is an S-curve of limited jerk (``SCurve.cpp``), and a corner that is passed is
the sum of two; a PX4 slows down for it. A target outside a mission is approached as ``shape_pos_vel_accel``
does (``control.cpp``).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import atan2, cos, degrees, exp, hypot, inf, radians, sin, sqrt

from mmrs_runtime.s_curves import curve, speeding, turning
from mmrs_runtime.timing import LegTiming, half_turn, split

Vector = tuple[float, float, float]

STEP = 0.05
"""Longest step of integration, seconds."""

STANDING = 0.5
"""Speed, metres per second, below which a leg begins; a faster vehicle brakes before."""

SLOW, LAGGING = 0.3, 0.085
"""Speed below which it no longer aims beyond a target; and seconds of its overshoot that it does not aim at,
since it goes so far beyond what it aims at."""

THRUSTING = 1.4
"""Acceleration by which a vehicle that trails its set-point answers each metre per second that it lacks: less
than MPC_XY_VEL_P_ACC, since it has to tilt first."""

DRIVING = 2.5
"""Acceleration, metres per second squared, with which it approaches commanded speeds."""

CLOSE = 1e-3
STILL: Vector = (0.0, 0.0, 0.0)


@dataclass(slots=True)
class CurvedLeg:
    """A straight leg as an S-curve.

    Attributes:
        path: from its start to its end, metres. length: of it.
        speed: largest. acceleration, jerk: at most.
        elapsed: seconds since its start; less than 0: it begins later.
        enters, leaves: metres per second at its ends.
        passes: whether it takes the next one at once.
        duration: seconds until its end. ramp: seconds in which it slows down.
        lag: seconds that it takes longer, if it is long, as thrust against the drag is built up.
    """

    path: Vector
    length: float
    speed: float
    acceleration: float
    jerk: float
    elapsed: float = 0.0
    enters: float = 0.0
    leaves: float = 0.0
    passes: bool = False
    duration: float = 0.0
    ramp: float = 0.0
    lag: float = 0.0

    def __post_init__(self) -> None:
        limits = (self.acceleration, self.acceleration, self.jerk)
        self.duration, self.speed, self.leaves = curve(
            self.length, self.speed, limits, self.enters, self.leaves
        )
        self.ramp = speeding(self.speed - self.leaves, self.acceleration, self.jerk)

    @property
    def left(self) -> float:
        """Return the seconds that are left."""
        return max(0.0, self.duration - self.elapsed)

    @property
    def now(self) -> tuple[float, float]:
        """Return the share of its path that is behind it, and of which it makes so much more per second."""
        distance, speed = self.at(self.elapsed)
        return distance / self.length, speed / self.length

    @property
    def slows(self) -> bool:
        """Return whether it has begun to slow down."""
        return self.left <= self.ramp

    def at(self, seconds: float) -> tuple[float, float]:
        """Return the distance and the speed after that time."""
        if seconds <= 0.0:
            return 0.0, self.enters
        left = self.duration - seconds
        if left <= 0.0:
            return self.length, self.leaves
        if left < self.ramp:
            distance, speed = self._ramped(left, self.leaves)
            return self.length - distance, speed
        ramp = speeding(self.speed - self.enters, self.acceleration, self.jerk)
        distance, speed = self._ramped(min(seconds, ramp), self.enters)
        return distance + self.speed * max(0.0, seconds - ramp), speed

    def _ramped(self, seconds: float, slow: float) -> tuple[float, float]:
        """Return the distance and the speed after that time of speeding up from a speed."""
        ramp = speeding(self.speed - slow, self.acceleration, self.jerk)
        bend = min(self.acceleration / self.jerk, ramp / 2.0)
        first, last = min(seconds, bend), max(0.0, seconds - (ramp - bend))
        even, most = max(0.0, min(seconds, ramp - bend) - bend), self.jerk * bend
        speed = self.jerk * first**2 / 2.0 + most * even + most * last - self.jerk * last**2 / 2.0
        distance = self.jerk * first**3 / 6.0 + self.jerk * bend**2 / 2.0 * (seconds - first)
        distance += most * even**2 / 2.0 + most * even * last
        distance += most * last**2 / 2.0 - self.jerk * last**3 / 6.0
        return slow * seconds + distance, slow + speed


@dataclass
class Body:
    """A point in metres north, east and up of home, with a heading in degrees.

    Attributes:
        target: destination; None: it brakes.
        onward: destination after the target, which it passes without a stop; None: it stops at the target.
        driven: commanded speeds ahead, aside and up, and turn rate, degrees per second; None: none.
        curved: whether it takes legs as S-curves. figures: how it takes them, or else approaches its target.
        radius: metres from a corner within which it passes.
        pivots: degrees off its heading beyond which it turns on the spot before a leg.
        speed: commanded ground speed, metres per second; climb, descent: limits of the vertical speed.
        rested: seconds since the end of its last leg; less than 0: until then.
    """

    figures: LegTiming
    position: Vector = STILL
    velocity: Vector = STILL
    heading: float = 0.0
    target: Vector | None = None
    onward: Vector | None = None
    driven: tuple[float, float, float, float] | None = None
    curved: bool = False
    radius: float = 2.0
    pivots: float = inf
    wanted_heading: float | None = None
    speed: float = 5.0
    climb: float = inf
    descent: float = inf
    turn_rate: float = 90.0
    rested: float = 0.0
    _acceleration: Vector = STILL
    _legs: list[CurvedLeg] = field(default_factory=list)
    _fastest: float = 0.0
    """Largest speed since it last stood still."""
    _start: Vector = STILL
    """Where the first of its legs begins."""
    _goal: Vector | None = None
    """Where the last of its legs ends."""
    _passing: CurvedLeg | None = None
    """The last leg, whose end it has passed; None: it has stopped there."""
    _turning: float = 0.0
    """Seconds for which it turns to the next leg yet, where it has passed a place."""
    _yaw_rate: float = 0.0
    """Degrees per second by which it does so."""
    _push: Vector = STILL
    """Thrust against its drag that it has built up, as the speed that it holds."""

    def advance(self, seconds: float) -> None:
        """Move for that long."""
        while seconds > 1e-9:
            step = min(seconds, STEP)
            seconds -= step
            if self.driven is not None:
                self._drive(*self.driven, step)
            elif self.target is None or not self.curved:
                self._approach(self.target, step)
            elif not self._follow_legs(self.target, step):
                self._approach(None, step)
            if self.driven is None:
                self._turn(step)

    def distance_to(self, place: Vector) -> float:
        """Return the distance to a place."""
        return hypot(*plus(place, self.position, -1.0))

    @property
    def pace(self) -> float:
        """Return the ground speed."""
        return hypot(*self.velocity)

    def rest_at(self, up: float) -> None:
        """Stop at a height."""
        self.position = (self.position[0], self.position[1], up)
        self.velocity = self._acceleration = STILL
        self.target = self.onward = self.driven = None
        self.plan_anew()

    def passes_target(self) -> bool:
        """Return whether it has passed half of the turn to the next leg."""
        turns = len(self._legs) > 1 and self._goal == self.onward
        passed = self._passing is not None and self._goal == self.target
        return passed or (turns and self._legs[-1].elapsed >= self._legs[-2].left)

    def change_speed(self, speed: float) -> None:
        """Move at another speed, on the last leg that it has begun, too, unless that slows down."""
        self.speed = speed
        if self._legs and self._goal is not None and not self._legs[-1].slows:
            begun = self._legs[-1]
            distance = begun.at(begun.elapsed)[0]
            start = self._start if len(self._legs) == 1 else plus(self._goal, begun.path, -1.0)
            leg = self._leg(start, self._goal)
            leg.elapsed = _bisected(0.0, leg.duration, lambda seconds: leg.at(seconds)[0] < distance)
            self._legs[-1] = leg

    def plan_anew(self) -> None:
        """Begin the leg to its target once more, from a stop."""
        self._legs.clear()
        self._passing, self._turning = None, 0.0

    def _follow_legs(self, target: Vector, step: float) -> bool:
        """Move along S-curves to a target; return whether it does."""
        if self._turning > 0.0:
            self._finish_turn(step)
            return True
        if not self._legs or self._goal not in (target, self.onward):
            if self.distance_to(target) < CLOSE:
                self.velocity = self._acceleration = STILL
                self.rested = max(0.0, self.rested) + step
                return True
            if self.pace > STANDING and self._passing is None:
                return False
            leg, self._start, self._goal = self._leg(self.position, target), self.position, target
            leg.elapsed -= self.figures.starting + self._pivoting(target) if self._passing is None else 0.0
            self._legs, self._passing = [leg], None
        self._begin_turn(target)
        rate = 1.0 / (1.0 + max(map(self._slowness, self._legs)))
        for leg in self._legs:
            leg.elapsed += step * rate
        self.rested = -self._legs[-1].left
        while self._legs and self._legs[0].left <= 0.0:
            leg = self._legs.pop(0)
            self._push, self._start = self._pushed(leg), plus(self._start, leg.path, 1.0)
            self._passing = leg if leg.passes else None
            if leg.passes and leg.length > CLOSE:
                self._begin_to_turn(leg, target)
        position, self.velocity, self._acceleration = self._start, STILL, STILL
        if self._passing is not None and not self._legs:
            self.velocity = plus(STILL, self._passing.path, self._passing.leaves / self._passing.length)
        for leg in self._legs:
            share, pace = leg.now
            position = plus(position, leg.path, share)
            self.velocity = plus(self.velocity, leg.path, rate * pace)
        self.position = position
        return True

    def _begin_to_turn(self, passed: CurvedLeg, target: Vector) -> None:
        """Begin to turn to the next leg where a place counts as passed."""
        beyond = plus(self.onward or target, target, -1.0)
        aside = turned(course(STILL, passed.path), course(STILL, beyond))
        half = abs(sin(radians(aside) / 2.0))
        self._turning = turning(passed.leaves, half, self.figures.acceleration, self.figures.jerk)
        self._yaw_rate = aside / self._turning if self._turning > 0.0 else 0.0

    def _finish_turn(self, step: float) -> None:
        """Turn at even speed."""
        along, pace = radians(course(STILL, self.velocity) + self._yaw_rate * step), hypot(*self.velocity[:2])
        self.velocity = (pace * cos(along), pace * sin(along), self.velocity[2])
        self.position = plus(self.position, self.velocity, step)
        self._turning -= step

    def _pivoting(self, target: Vector) -> float:
        """Begin to turn to a target; return the seconds that it does so on the spot."""
        if self.pivots == inf:
            return 0.0
        self.wanted_heading = course(self.position, target)
        left = abs(turned(self.heading, self.wanted_heading))
        return left / self.turn_rate if left > self.pivots else 0.0

    def _passes_at(self, path: Vector) -> float | None:
        """Return how fast it passes the end of a leg to its target; None: it stops there."""
        if not self.figures.slows_down or self.onward is None or self.target is None:
            return None
        beyond = plus(self.onward, self.target, -1.0)
        aside = half_turn(path[:2], beyond[:2])
        return None if aside is None else self.figures.passing(aside, hypot(*beyond[:2]), beyond[2])

    @property
    def _fastest_level(self) -> float:
        """Return the largest speed on level legs."""
        return min(self.speed, self.figures.speed)

    def _slowness(self, leg: CurvedLeg) -> float:
        """Return how much longer a second of a leg takes, whose curve waits while thrust is built up."""
        within = self.figures.lag_within
        return leg.lag / within * exp(-max(0.0, leg.elapsed) / within)

    def _pushed(self, leg: CurvedLeg) -> Vector:
        """Return the push that is left after a leg."""
        level = hypot(*leg.path[:2])
        if not level or not self.figures.lag:
            return self._push
        return (*self.figures.pushed(self._push[:2], leg.path[:2], self._held(leg), leg.duration), 0.0)

    def _held(self, leg: CurvedLeg) -> float:
        """Return the largest level speed on a leg; the mean one where places may be passed."""
        speed = leg.length / leg.duration if self.figures.slows_down else leg.speed
        return speed * hypot(*leg.path[:2]) / hypot(*leg.path)

    def _leg(self, start: Vector, end: Vector) -> CurvedLeg:
        path, figures, passed = plus(end, start, -1.0), self.figures, self._passing
        leaves = self._passes_at(path) if end == self.target else None
        if leaves:
            path = plus(path, path, -min(1.0, figures.corner_radius / max(hypot(*path), CLOSE)))
        speed, acceleration, jerk = self._limits(path)
        leg = CurvedLeg(
            path,
            max(hypot(*path), CLOSE),
            speed,
            acceleration,
            jerk,
            enters=passed.leaves if passed else 0.0,
            leaves=min(leaves or 0.0, speed),
            passes=leaves is not None,
        )
        if figures.lag and path[:2] != (0.0, 0.0):
            leg.lag = figures.lag_of(self._fastest_level, self._held(leg), *split(self._push[:2], path[:2]))
        return leg

    def _limits(self, path: Vector) -> tuple[float, float, float]:
        """Return the largest speed on a leg, its acceleration and its jerk."""
        figures, length = self.figures, max(hypot(*path), CLOSE)
        speed, acceleration = self._fastest_level, figures.acceleration
        if path[2]:
            steep = length / abs(path[2])
            speed = min(speed, steep * self._rate(path[2]))
            acceleration = min(acceleration, steep * (figures.vertical_acceleration or inf))
        return speed, acceleration, figures.jerk

    def _rate(self, rise: float) -> float:
        """Return the largest vertical speed."""
        return min(self.climb, self.figures.climb) if rise > 0.0 else min(self.descent, self.figures.descent)

    def _begin_turn(self, target: Vector) -> None:
        """Begin the next leg where the middle of the turn is within the radius of the corner."""
        leg = self._legs[-1]
        figures = self.figures
        if figures.slows_down or not figures.passes or self.onward is None or self._goal != target:
            return
        beyond = plus(self.onward, target, -1.0)
        half = half_turn(leg.path, beyond) or 0.0
        if not leg.slows or leg.left * half > figures.corner_seconds:
            return
        following, half = self._leg(target, self.onward), leg.left / 2.0
        before, after = leg.length - leg.at(leg.elapsed + half)[0], following.at(half)[0]
        middle = plus(plus(STILL, leg.path, -before / leg.length), following.path, after / following.length)
        if leg.left <= following.duration / 2.0 and hypot(*middle) < self.radius:
            self._legs.append(following)
            self._goal = self.onward

    def _approach(self, target: Vector | None, step: float) -> None:
        """Approach a target, or brake, with limited acceleration and jerk."""
        self.plan_anew()
        figures = self.figures
        if figures.trailing:
            self._trail(target or self.position, step)
            return
        path = plus(self._aim(target), self.position, -1.0)
        level, upwards = figures.acceleration, figures.vertical_acceleration or figures.acceleration
        pace = min(_root(hypot(*path[:2]), level, figures.jerk), self.speed)
        rate = min(_root(abs(path[2]), upwards, figures.jerk), self._rate(path[2]))
        part = pace / max(hypot(*path[:2]), CLOSE)
        wanted = (path[0] * part, path[1] * part, rate if path[2] > 0.0 else -rate)
        error = plus(wanted, self.velocity, -1.0)
        size, jerk = max(hypot(*error[:2]), CLOSE), figures.jerk
        part = min(_rooted(size, jerk / level, jerk), level, size / step) / size
        up = min(_rooted(abs(error[2]), jerk / upwards, jerk), upwards, abs(error[2]) / step)
        asked = (error[0] * part, error[1] * part, up if error[2] > 0.0 else -up)
        change = plus(asked, self._acceleration, -1.0)
        bent = min(1.0, jerk * step / max(hypot(*change), CLOSE))
        self._acceleration = plus(self._acceleration, change, bent)
        self.velocity = plus(self.velocity, self._acceleration, step)
        self.position = plus(self.position, self.velocity, step)

    def _trail(self, target: Vector, step: float) -> None:
        """Trail a set-point as a PX4 does, whose controllers of position and velocity are linear."""
        behind, trailing = plus(target, self.position, -1.0), self.figures.trailing
        rate = self._rate(behind[2])
        up = max(-rate, min(rate, behind[2] / trailing))
        part = 1.0 / max(trailing, hypot(*behind[:2]) / max(self.speed, CLOSE))
        error = plus((behind[0] * part, behind[1] * part, up), self.velocity, -1.0)
        self.velocity = plus(self.velocity, error, min(1.0, THRUSTING * step))
        self.position, self._acceleration = plus(self.position, self.velocity, step), STILL

    def _aim(self, target: Vector | None) -> Vector:
        """Return what it heads for: a place beyond a target, by its overshoot, until it has slowed down."""
        if target is None or target[:2] == self.position[:2]:
            return target or self.position
        (north, east, _), pace = self.velocity, hypot(*self.velocity[:2])
        self._fastest = max(self._fastest, pace) if pace > SLOW else 0.0
        beyond = max(0.0, self.figures.overshoot - LAGGING) * self._fastest
        return plus(target, (north, east, 0.0), beyond / pace) if beyond > 0.0 else target

    def _drive(self, ahead: float, aside: float, up: float, turn: float, step: float) -> None:
        """Approach commanded speeds."""
        self.plan_anew()
        self.heading = (self.heading + turn * step) % 360.0
        north, east = cos(radians(self.heading)), sin(radians(self.heading))
        wanted = (ahead * north - aside * east, ahead * east + aside * north, up)
        error = plus(wanted, self.velocity, -1.0)
        part = min(1.0, DRIVING * step / max(hypot(*error), CLOSE))
        self.velocity, self._acceleration = plus(self.velocity, error, part), STILL
        self.position = plus(self.position, self.velocity, step)

    def _turn(self, step: float) -> None:
        if self.wanted_heading is None:
            return
        left = turned(self.heading, self.wanted_heading)
        limit = self.turn_rate * step
        self.heading = (self.heading + max(-limit, min(limit, left))) % 360.0


def course(start: Vector, end: Vector) -> float:
    """Return the degrees clockwise from north of the way between two places."""
    return degrees(atan2(end[1] - start[1], end[0] - start[0])) % 360.0


def turned(before: float, after: float) -> float:
    """Return the turn from one heading to another, degrees clockwise."""
    return (after - before + 180.0) % 360.0 - 180.0


def _bisected(low: float, high: float, below: Callable[[float], bool]) -> float:
    """Return the number up to which a test holds."""
    for _ in range(40):
        middle = (low + high) / 2.0
        low, high = (middle, high) if below(middle) else (low, middle)
    return high


def _root(distance: float, acceleration: float, jerk: float) -> float:
    """Return the speed at a distance from a target: ArduPilot brakes at half of its acceleration."""
    return _rooted(distance, 0.5 * jerk / acceleration, 0.5 * acceleration)


def _rooted(error: float, gain: float, limit: float) -> float:
    """Return the correction of an error, as ``sqrt_controller`` does (``control.cpp``)."""
    linear = limit / gain**2
    return sqrt(2.0 * limit * (error - linear / 2.0)) if error > linear else error * gain


def plus(a: Vector, b: Vector, factor: float) -> Vector:
    """Return a + factor b."""
    return (a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor)
