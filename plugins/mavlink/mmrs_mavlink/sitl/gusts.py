"""Gusts: the unrest of the air, and how far it carries a copter that leans against it a little late.

The air's velocity changes about its mean as a first-order Gauss-Markov process on each horizontal axis,
which is the form of the Dryden model's gusts along the way (MIL-F-8785C) at a given correlation time. A
copter learns of a change by being pushed: drag drives it with the air until it leans against that. The
times of this were assumed, not measured on any vehicle; with them, gusts of 2 m/s carry a vehicle that
keeps its place or its leg some tenths of a metre away from it.
"""

from __future__ import annotations

from math import exp, sqrt
from random import Random

STEP_SECONDS = 0.05
"""Of the process: the same gusts come at the same time, however time is cut up."""

DRAG_SECONDS = 3.0
"""In which the air would take a vehicle with it that does nothing."""

LEANS_SECONDS = 0.5
"""In which a vehicle leans against a change of the wind."""

DAMPED_SECONDS = 0.8
"""In which the speed fades that a gust has given it."""

Drift = tuple[float, float]


class Gusts:
    """The gusts that one vehicle meets.

    Attributes:
        air: metres per second north and east that the air is faster than its mean.
        push: metres per second north and east that the vehicle is carried.
    """

    def __init__(self, strength: float, lasting: float, seed: str) -> None:
        """Begin calm.

        Args:
            strength: standard deviation of the air's velocity on each axis, metres per second.
            lasting: correlation time, seconds.
            seed: the same one makes the same gusts.
        """
        self.air: Drift = (0.0, 0.0)
        self.push: Drift = (0.0, 0.0)
        self._leant: Drift = (0.0, 0.0)
        self._strength, self._random = strength, Random(seed)
        self._keeps = exp(-STEP_SECONDS / lasting)
        self._left = 0.0

    def go_on(self, seconds: float) -> None:
        """Let time pass for a vehicle in the air."""
        self._left += seconds if self._strength > 0.0 else 0.0
        while self._left >= STEP_SECONDS - 1e-9:
            self._left -= STEP_SECONDS
            self._step()

    def rest(self) -> None:
        """Stand on the ground, where no gust moves a vehicle."""
        self.push = (0.0, 0.0)

    def _step(self) -> None:
        news = self._strength * sqrt(1.0 - self._keeps**2)
        north, east = (self._keeps * part + news * self._random.gauss(0.0, 1.0) for part in self.air)
        self.air = (north, east)
        pairs = tuple(zip(self.air, self._leant, self.push, strict=True))
        a, b = (
            push + STEP_SECONDS * ((air - leant) / DRAG_SECONDS - push / DAMPED_SECONDS)
            for air, leant, push in pairs
        )
        c, d = (leant + STEP_SECONDS * (air - leant) / LEANS_SECONDS for air, leant, _ in pairs)
        self.push, self._leant = (a, b), (c, d)
