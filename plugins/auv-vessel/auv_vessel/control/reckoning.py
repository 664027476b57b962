"""Dead reckoning by a Kalman filter: place and current from speed over ground, or through the water."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np

from auv_vessel.control.allocation import Array
from auv_vessel.instruments import Instruments

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
        """Metres, one sigma, in the direction in which the place is known least."""
        return float(np.sqrt(max(0.0, np.linalg.eigvalsh(self.covariance[:2, :2])[-1])))

    @property
    def compass_bias(self) -> float:
        """By how much the compass says too much, radians."""
        return float(self.state[COMPASS])

    def log_bias(self) -> Array:
        """Return by how much the log says too much ahead and to starboard, metres per second."""
        return self.state[LOG_AHEAD : LOG_ASIDE + 1].copy()

    def current(self) -> Array:
        """Return the current to the north and to the east, metres per second."""
        return self.state[CURRENT_NORTH : CURRENT_EAST + 1].copy()

    def advance_over_ground(self, compass: float, ahead: float, aside: float, period: float) -> None:
        """Go on by speed over ground as the log says it, its bias taken off here; compass in radians."""
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
        """Go on by speed through the water, reckoned from thrust, and the current known so far."""
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
        """Learn the place from a fix; one that cannot be is refused until others agree with it."""
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
        """Tell whether fixes that were refused are near this one, so that it is reckoning that is wrong."""
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
