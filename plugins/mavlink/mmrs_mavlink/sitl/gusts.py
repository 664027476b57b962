"""Gusts, and how far they displace a copter that compensates for them with a delay.

The air speed changes about its mean as a first-order Gauss-Markov process on each horizontal axis, the form
of the Dryden model's longitudinal gusts (MIL-F-8785C) at a given correlation time. A copter notices a change
by being displaced: drag accelerates it with the air until it leans against that. The time constants are
assumptions, not measurements; with them, gusts of 2 m/s displace a vehicle by some tenths of a metre.
"""

from __future__ import annotations

from math import exp, sqrt
from random import Random

STEP_SECONDS = 0.05
"""Step of the process: the gusts do not depend on how time is divided."""

DRAG_SECONDS = 3.0
"""Time constant with which the air accelerates a vehicle that does not compensate."""

LEANS_SECONDS = 0.5
"""Time constant with which a vehicle compensates for a change of the wind."""

DAMPED_SECONDS = 0.8
"""Time constant with which the velocity caused by a gust decays."""

Drift = tuple[float, float]


class Gusts:
    """The gusts around one vehicle.

    Attributes:
        air: velocity of the air relative to its mean, metres per second north and east.
        push: velocity of the vehicle caused by gusts, metres per second north and east.
    """

    def __init__(self, strength: float, lasting: float, seed: str) -> None:
        """Begin calm.

        Args:
            strength: standard deviation of the air speed on each axis, metres per second.
            lasting: correlation time, seconds.
            seed: of the process.
        """
        self.air: Drift = (0.0, 0.0)
        self.push: Drift = (0.0, 0.0)
        self._compensated: Drift = (0.0, 0.0)
        self._strength, self._random = strength, Random(seed)
        self._keeps = exp(-STEP_SECONDS / lasting)
        self._left = 0.0

    def advance(self, seconds: float) -> None:
        """Advance the time of a vehicle in the air."""
        self._left += seconds if self._strength > 0.0 else 0.0
        while self._left >= STEP_SECONDS - 1e-9:
            self._left -= STEP_SECONDS
            self._step()

    def rest(self) -> None:
        """Stop displacing the vehicle, which stands on the ground."""
        self.push = (0.0, 0.0)

    def _step(self) -> None:
        change = self._strength * sqrt(1.0 - self._keeps**2)
        north, east = (self._keeps * part + change * self._random.gauss(0.0, 1.0) for part in self.air)
        self.air = (north, east)
        axes = tuple(zip(self.air, self._compensated, self.push, strict=True))
        push_north, push_east = (
            push + STEP_SECONDS * ((air - known) / DRAG_SECONDS - push / DAMPED_SECONDS)
            for air, known, push in axes
        )
        known_north, known_east = (
            known + STEP_SECONDS * (air - known) / LEANS_SECONDS for air, known, _ in axes
        )
        self.push, self._compensated = (push_north, push_east), (known_north, known_east)
