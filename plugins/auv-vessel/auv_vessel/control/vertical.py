"""Depth and its rate from pressure, and from the Doppler log where it has the bottom."""

from __future__ import annotations

from math import sqrt

from auv_vessel.body.hydrodynamics import GRAVITY
from auv_vessel.control.plausibility import FORGETS, Channel, Drift
from auv_vessel.control.reckoning import LOG_PERIOD
from auv_vessel.instruments import Instruments
from auv_vessel.sheet import Sheet

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
        """Tell whether the depth may be relied on."""
        return self.pressure.trusted(now)
