"""Attitude and rates of turn from gyroscopes, compass and tilt, each believed as far as it is plausible."""

from __future__ import annotations

from math import cos, radians, sin, tan

import numpy as np

from auv_vessel.control.allocation import Array
from auv_vessel.control.plausibility import Channel, Drift
from auv_vessel.instruments import Instruments

GYRO_GAIN, RATE_GAIN_ALONE = 0.7, 0.06
ANGLE_GAIN, ANGLE_GAIN_ALONE = 0.12, 0.35
"""Parts of a residual that are taken over: of rates, of angles; and those without gyroscopes to believe."""

STEEPEST = 80.0
"""Degrees of pitch beyond which rates are taken as at this, for a heading has no meaning straight down."""

DRIFT = 8.0
"""Degrees by which compass and gyroscopes may be apart after some seconds."""

GIVE_WAY = 2.0
"""Seconds without a plausible attitude after which any is taken that is not frozen."""


class AttitudeFilter:
    """Roll, pitch and heading, degrees, and their rates, degrees per second.

    Attributes:
        angles: roll, pitch, heading; heading from 0 to 360.
        rates: of them.
    """

    def __init__(self, heading: float, instruments: Instruments) -> None:
        self.angles: Array = np.array((0.0, 0.0, heading % 360.0))
        self.rates: Array = np.zeros(3)
        self.attitude = Channel(-180.0, 360.0, 0.01, 3)
        self.gyroscopes = Channel(-500.0, 500.0, 0.01, 3)
        self._noise = max(instruments.attitude_noise, instruments.heading_noise)
        self._rates_noise = instruments.rates_noise
        self._at: float | None = None
        self._drift = Drift()

    def advance(self, period: float) -> None:
        """Let time go by, seconds."""
        changes = changes_of(self.angles, self.rates)
        self.angles = _turned(self.angles + changes * period)
        self._drift.advance(float(changes[2]), period)

    def take_rates(self, rates: Array, now: float) -> None:
        """Take what gyroscopes say, degrees per second."""
        age = min(self.gyroscopes.age(now), GIVE_WAY)
        allowed = np.inf if age >= GIVE_WAY else 30.0 + 6.0 * self._rates_noise + 600.0 * age
        residual = float(np.abs(rates - self.rates).max())
        if self.gyroscopes.judge(rates.tolist(), now, residual=residual, allowed=allowed):
            self.rates = self.rates + GYRO_GAIN * (rates - self.rates)

    def take_angles(self, angles: Array, now: float) -> None:
        """Take what compass and tilt say, degrees."""
        age = min(self.attitude.age(now), GIVE_WAY)
        turning = self.gyroscopes.trusted(now)
        first = not np.isfinite(self.attitude.age(now))
        rate = 20.0 if turning else 120.0
        allowed = np.inf if age >= GIVE_WAY else 3.0 + 6.0 * self._noise + rate * age
        residual = _difference(angles, self.angles)
        far = float(np.abs(residual).max())
        self._drift.take(float(angles[2]), circle=360.0)
        if not turning or age >= GIVE_WAY:
            self._drift.forget()
        if abs(self._drift.difference) > DRIFT + 6.0 * self._noise:
            far = np.inf
        period = min(max(now - self._at, 0.02), 0.2) if self._at is not None else 0.05
        if not self.attitude.judge(angles.tolist(), now, residual=far, allowed=allowed):
            return
        self._at = now
        if first or age >= GIVE_WAY:
            self.angles = _turned(angles)
            return
        self.angles = _turned(self.angles + (ANGLE_GAIN if turning else ANGLE_GAIN_ALONE) * residual)
        if not turning:
            self.rates = self.rates + RATE_GAIN_ALONE * residual / period

    def trusted(self, now: float) -> bool:
        """Return whether the attitude may be relied on."""
        return self.attitude.trusted(now)


def changes_of(angles: Array, rates: Array) -> Array:
    """Return how roll, pitch and heading change, degrees per second, by rates about the body's axes."""
    roll, pitch = radians(angles[0]), radians(min(max(angles[1], -STEEPEST), STEEPEST))
    across = rates[1] * sin(roll) + rates[2] * cos(roll)
    tilting = rates[1] * cos(roll) - rates[2] * sin(roll)
    return np.array((rates[0] + across * tan(pitch), tilting, across / cos(pitch)))


def _turned(angles: Array) -> Array:
    """Return an attitude within its circles."""
    tilts = (angles[:2] + 180.0) % 360.0 - 180.0
    return np.array((tilts[0], tilts[1], angles[2] % 360.0))


def _difference(one: Array, other: Array) -> Array:
    """Return how far one attitude is from another, degrees, by the shorter way."""
    difference: Array = (one - other + 180.0) % 360.0 - 180.0
    return difference
