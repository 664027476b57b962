"""Dead reckoning by a Kalman filter: place and current from speed over ground, or through the water."""

from __future__ import annotations

from math import cos, radians, sin, sqrt

import numpy as np

from auv_vessel.body.hydrodynamics import GRAVITY, Hull, hull_of
from auv_vessel.control.allocation import Allocation, Array
from auv_vessel.control.plausibility import FORGETS, Channel, Drift
from auv_vessel.instruments import Instruments
from auv_vessel.sheet import Sheet


class WaterSpeed:
    """The speed of a hull relative to the water, reckoned from thrust and drag.

    Attributes:
        speed: metres per second forward, to starboard and down, relative to the water.
        acceleration: its rate, metres per second squared.
    """

    def __init__(self, sheet: Sheet) -> None:
        self.hull: Hull = hull_of(sheet)
        self._matrix = Allocation(sheet).matrix[:3]
        self._mass = np.array(self.hull.inertia[:3])
        self._linear = np.array(self.hull.linear[:3])
        self._quadratic = np.array(self.hull.quadratic[:3])
        self._weight = sheet.weight_in_water * GRAVITY
        self.speed: Array = np.zeros(3)
        self.acceleration: Array = np.zeros(3)

    def advance(self, thrusts: Array, yaw_rate: float, depth: float, period: float) -> None:
        """Let time go by.

        Args:
            thrusts: newtons of each thruster.
            yaw_rate: radians per second. depth: metres; a hull that floats has no weight left.
            period: seconds.
        """
        force = self._matrix @ thrusts
        if depth > self.hull.half[2] or self._weight > 0.0:
            force[2] += self._weight
        force[0] += self._mass[1] * self.speed[1] * yaw_rate
        force[1] -= self._mass[0] * self.speed[0] * yaw_rate
        slowing = self._linear + self._quadratic * np.abs(self.speed)
        rate = (force - slowing * self.speed) / (self._mass + slowing * period)
        self.acceleration = rate
        self.speed = self.speed + rate * period


LOG_PERIOD = 0.2
"""Seconds from one speed of the Doppler log to the next."""

CURRENT, CURRENT_WANDERS = 0.3, 0.003
"""Metres per second of current that is usual, and by how much it changes in a second (one sigma)."""

MODEL, MODEL_PART, MODEL_LASTS = 0.03, 0.15, 10.0
"""Error of speed reckoned from thrust: metres per second, part of it, and the seconds for which it lasts."""

SLACK = 0.02
"""Metres per second by which speed may change between two values of the log, beside their noise."""

STRANGE, AGREED = 25.0, 3
"""Squared distance, by its covariance, from which on a fix is not believed, until so many agree."""

NORTH, EAST, CURRENT_NORTH, CURRENT_EAST, LOG_AHEAD, LOG_ASIDE, COMPASS = range(7)


class Reckoning:
    """Where a vehicle is, and how sure that is.

    The state is north and east (m), current north and east (m/s), bias of the log ahead and to starboard
    (m/s), and bias of the compass (rad): an extended Kalman filter of seven states.

    Attributes:
        state: as above. covariance: 7 by 7.
    """

    def __init__(self, north: float, east: float, instruments: Instruments) -> None:
        self._instruments = instruments
        bias = radians(instruments.heading_bias)
        spread = (
            instruments.start_noise,
            instruments.start_noise,
            CURRENT,
            CURRENT,
            *[instruments.log_bias] * 2,
            bias,
        )
        self.state: Array = np.array((north, east, 0.0, 0.0, 0.0, 0.0, 0.0))
        self.covariance: Array = np.diag(np.square(np.maximum(spread, 1e-6)))
        self._refused: list[Array] = []

    @property
    def uncertainty(self) -> float:
        """Metres, one sigma, in the direction in which the position is known least."""
        return float(np.sqrt(max(0.0, np.linalg.eigvalsh(self.covariance[:2, :2])[-1])))

    @property
    def compass_bias(self) -> float:
        """Radians by which the compass reads too high."""
        return float(self.state[COMPASS])

    def log_bias(self) -> Array:
        """Return by how much the log says too much ahead and to starboard, metres per second."""
        return self.state[LOG_AHEAD : LOG_ASIDE + 1].copy()

    def current(self) -> Array:
        """Return the current to the north and to the east, metres per second."""
        return self.state[CURRENT_NORTH : CURRENT_EAST + 1].copy()

    def advance_over_ground(self, compass: float, ahead: float, aside: float, period: float) -> None:
        """Advance by speed over ground from the log, corrected by its bias here; compass in radians."""
        heading = compass - self.compass_bias
        c, s = cos(heading), sin(heading)
        bias = self.state[LOG_AHEAD : LOG_ASIDE + 1]
        u, v = ahead - bias[0], aside - bias[1]
        north, east = c * u - s * v, s * u + c * v
        change = np.eye(7)
        change[NORTH, LOG_AHEAD : LOG_ASIDE + 1] = -c * period, s * period
        change[EAST, LOG_AHEAD : LOG_ASIDE + 1] = -s * period, -c * period
        change[NORTH, COMPASS], change[EAST, COMPASS] = east * period, -north * period
        noise = (self._instruments.log_noise**2 + SLACK**2) * LOG_PERIOD * period
        self._advance(change, north * period, east * period, noise, period)

    def advance_through_water(self, compass: float, ahead: float, aside: float, period: float) -> None:
        """Advance by speed through the water, reckoned from thrust, and the current known so far."""
        heading = compass - self.compass_bias
        c, s = cos(heading), sin(heading)
        north, east = c * ahead - s * aside, s * ahead + c * aside
        change = np.eye(7)
        change[NORTH, CURRENT_NORTH] = change[EAST, CURRENT_EAST] = period
        change[NORTH, COMPASS], change[EAST, COMPASS] = east * period, -north * period
        error = MODEL + MODEL_PART * float(np.hypot(ahead, aside))
        flow = self.state[CURRENT_NORTH : CURRENT_EAST + 1]
        north, east = north + flow[0], east + flow[1]
        self._advance(change, north * period, east * period, 2.0 * error**2 * MODEL_LASTS * period, period)

    def note_current(self, compass: float, ground: Array, water: Array) -> None:
        """Learn about the current from the difference of speeds over ground (log) and through the water.

        Args:
            compass: radians. ground, water: metres per second ahead and to starboard.
        """
        heading = compass - self.compass_bias
        turn = np.array(((cos(heading), -sin(heading)), (sin(heading), cos(heading))))
        seen = np.zeros((2, 7))
        seen[:, CURRENT_NORTH : CURRENT_EAST + 1] = np.eye(2)
        seen[:, LOG_AHEAD : LOG_ASIDE + 1] = turn
        bias = self.state[LOG_AHEAD : LOG_ASIDE + 1]
        found = turn @ (ground - bias - water) - self.state[CURRENT_NORTH : CURRENT_EAST + 1]
        error = MODEL + MODEL_PART * float(np.hypot(*water))
        variance = 2.0 * error**2 * MODEL_LASTS / LOG_PERIOD + self._instruments.log_noise**2
        self._correct(seen, found, variance * np.eye(2))

    def fix(self, north: float, east: float) -> bool:
        """Correct the position by a fix; an implausible one is refused until others agree with it."""
        seen = np.eye(2, 7)
        place = np.array((north, east))
        found = place - self.state[:2]
        noise = max(self._instruments.fix_noise, 1e-3) ** 2 * np.eye(2)
        spread = self.covariance[:2, :2] + noise
        if float(found @ np.linalg.solve(spread, found)) > STRANGE and not self._agreed(place):
            return False
        if self._refused:
            self.covariance[:2, :], self.covariance[:, :2] = 0.0, 0.0
            self.covariance[:2, :2] = noise
            self.state[:2] = place
            self._refused.clear()
            return True
        self._correct(seen, found, noise)
        return True

    def _agreed(self, place: Array) -> bool:
        """Return whether refused fixes are near this one, so that the reckoned position is wrong."""
        near = 5.0 * max(self._instruments.fix_noise, 1e-3) + 1.0
        self._refused = [each for each in self._refused if float(np.hypot(*(each - place))) < near]
        self._refused.append(place)
        return len(self._refused) >= AGREED

    def _advance(self, change: Array, north: float, east: float, noise: float, period: float) -> None:
        self.state[NORTH] += north
        self.state[EAST] += east
        self.covariance = change @ self.covariance @ change.T
        self.covariance[NORTH, NORTH] += noise
        self.covariance[EAST, EAST] += noise
        for each in (CURRENT_NORTH, CURRENT_EAST):
            self.covariance[each, each] += CURRENT_WANDERS**2 * period

    def _correct(self, seen: Array, found: Array, noise: Array) -> None:
        across = self.covariance @ seen.T
        gain = np.linalg.solve((seen @ across + noise).T, across.T).T
        self.state = self.state + gain @ found
        keep = np.eye(7) - gain @ seen
        self.covariance = keep @ self.covariance @ keep.T + gain @ noise @ gain.T


DEPTH_GAIN, RATE_GAIN, LOG_GAIN = 0.25, 0.04, 0.4
"""Parts of a residual taken over: of depth into depth and (per second) rate, of the log's into rate."""

STEEPEST = 3.0
"""Metres per second that no vehicle sinks or rises."""

DRIFT, VARIANCE_GAIN = 0.3, 0.1
"""Metres by which pressure and a log without noise may be apart after some seconds; part of a squared
residual of the log that is taken over into its variance."""

GIVE_WAY = 2.0
"""Seconds without a plausible pressure after which any is taken that is not frozen."""


class Vertical:
    """How deep the vehicle is, metres, and at what rate it sinks, metres per second.

    Attributes:
        depth: positive below the surface.
        rate: positive when it sinks.
    """

    def __init__(self, sheet: Sheet, instruments: Instruments) -> None:
        self.depth = sheet.home[2]
        self.rate = 0.0
        self._per_metre = sheet.water_density * GRAVITY
        self._air = instruments.pressure_air
        self._noise = instruments.pressure_noise / self._per_metre
        deepest = self._air + self._per_metre * (2.0 * sheet.max_depth + 10.0)
        self.pressure = Channel(0.9 * self._air, deepest, 1.0)
        self._rate_at: float | None = None
        self._rate_said = 0.0
        self._variance = 0.0
        self._drift = Drift()

    def advance(self, acceleration: float, now: float, period: float) -> None:
        """Let time go by, seconds, accelerated down as reckoned from thrust; without pressure, stay."""
        if self.pressure.age(now) > GIVE_WAY:
            self.rate = 0.0
            return
        self.rate = min(max(self.rate + acceleration * period, -STEEPEST), STEEPEST)
        self.depth += self.rate * period
        self._drift.advance(self._rate_said, period)

    def take_pressure(self, pressure: float, now: float) -> None:
        """Take an absolute pressure, pascals."""
        depth = (pressure - self._air) / self._per_metre
        age = self.pressure.age(now)
        sure = self._rate_at is not None and now - self._rate_at < 0.5
        allowed = 6.0 * self._noise + (0.15 + 0.3 * age if sure else 0.15 + STEEPEST * age)
        gives_way = age >= GIVE_WAY
        residual = depth - self.depth
        self._drift.take(depth)
        if not sure or gives_way:
            self._drift.forget()
        wanders = 3.0 * sqrt(self._variance * LOG_PERIOD * FORGETS / 2.0)
        if abs(self._drift.difference) > DRIFT + 6.0 * self._noise + wanders:
            residual = float("inf")
        if not self.pressure.judge(
            (pressure,), now, residual=residual, allowed=float("inf") if gives_way else allowed
        ):
            return
        if gives_way:
            self.depth, self.rate = depth, 0.0
            return
        self.depth += DEPTH_GAIN * residual
        self.rate += RATE_GAIN * residual / max(age, 0.02)

    def take_rate(self, rate: float, now: float) -> None:
        """Take a rate of sinking that the log says, metres per second."""
        self._rate_at, self._rate_said = now, rate
        self._variance += VARIANCE_GAIN * ((rate - self.rate) ** 2 - self._variance)
        self.rate += LOG_GAIN * (rate - self.rate)

    def trusted(self, now: float) -> bool:
        """Return whether the depth may be relied on."""
        return self.pressure.trusted(now)
