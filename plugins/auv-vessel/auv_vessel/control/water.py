"""How a hull moves through the water by what its thrusters give: its speed when no log tells it."""

from __future__ import annotations

import numpy as np

from auv_vessel.body.hydrodynamics import GRAVITY, Hull, hull_of
from auv_vessel.control.allocation import Allocation, Array
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
