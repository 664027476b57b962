"""What each thruster is to do for a force and a moment on the vehicle."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians, sin
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from auv_vessel.body.hydrodynamics import GRAVITY, hull_of
from auv_vessel.sheet import Sheet

Array: TypeAlias = NDArray[np.float64]

DEGREES = ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")
STEERED = (0, 1, 2, 5)
"""Surge, sway, heave and yaw: what movement needs; roll and pitch right themselves."""

WEIGHTS = (1.0, 1.0, 10.0, 3.0, 3.0, 10.0)
"""Weights of the missing thrust in each degree when thrust is short: depth and heading come before speed."""

TILT = 15.0
"""Degrees to which moments that nothing balances may tilt a vehicle."""

STRICTER = (2.0, 4.0, 8.0, 16.0, 32.0)
"""Factors of the weights of roll and pitch that are tried until it tilts no further."""

TINY = 1e-6
"""Weight of thrust itself, so that the wrench is reached with the least thrust: part of the largest diagonal
element of the normal equations."""


def bounded_least_squares(matrix: Array, wanted: Array, low: Array, high: Array) -> Array:
    """Return the x within bounds that makes the squares of ``matrix @ x - wanted``, and `TINY` of x, least.

    An active-set method (P. B. Stark and R. L. Parker, Bounded-variable least squares, Computational
    Statistics 10, 1995) on the normal equations; `TINY` makes the solution unique and each step definite.

    Args:
        matrix: m by n. wanted: m. low, high: n, low not above high.
    """
    hessian = matrix.T @ matrix
    count = len(hessian)
    scale = float(hessian.diagonal().max(initial=0.0)) or 1.0
    hessian = hessian + TINY * scale * np.eye(count)
    gradient = matrix.T @ wanted
    x = np.asarray(np.linalg.solve(hessian, gradient), np.float64)
    if np.all(x >= low) and np.all(x <= high):
        return x
    x = np.clip(x, low, high)
    free = (x > low) & (x < high)
    slack = 1e-9 * scale * max(1.0, float(np.abs(high - low).max(initial=0.0)))
    for _ in range(10 * count + 10):
        x, stopped = _towards_least(hessian, gradient, x, free, low, high)
        if stopped:
            continue
        pull = gradient - hessian @ x
        gain = np.where(free, 0.0, np.where(x >= high, -pull, pull))
        gain[low >= high] = 0.0
        best = int(np.argmax(gain))
        if gain[best] <= slack:
            break
        free[best] = True
    return x


def _towards_least(
    hessian: Array, gradient: Array, x: Array, free: NDArray[np.bool_], low: Array, high: Array
) -> tuple[Array, bool]:
    """Go to the least among what is free, as far as bounds allow; return whether a bound stopped it."""
    if not free.any():
        return x, False
    held = ~free
    goal = x.copy()
    goal[free] = np.linalg.solve(
        hessian[np.ix_(free, free)], gradient[free] - hessian[np.ix_(free, held)] @ x[held]
    )
    step = goal - x
    room = np.full(len(x), np.inf)
    up, down = free & (goal > high), free & (goal < low)
    room[up] = (high[up] - x[up]) / step[up]
    room[down] = (low[down] - x[down]) / step[down]
    first = int(np.argmin(room))
    if room[first] >= 1.0:
        return goal, False
    x = np.clip(x + room[first] * step, low, high)
    x[first] = high[first] if up[first] else low[first]
    free[first] = False
    return x, True


class Allocation:
    """The geometry of a vehicle's thrusters.

    Attributes:
        matrix: 6 by n: force (N) and moment (N.m, about the centre of gravity) of a newton of each thruster.
    """

    def __init__(self, sheet: Sheet) -> None:
        columns = [
            np.concatenate((direction, np.cross(np.array(each.position, float), direction)))
            for each in sheet.thrusters
            for direction in [_unit(each.direction)]
        ]
        self.matrix: Array = np.array(columns, float).T.reshape(6, len(columns))
        hull = hull_of(sheet)
        self._tilting = hull.mass * GRAVITY * hull.righting_arm * sin(radians(TILT))
        lever = max(0.05, sheet.length / 2.0, sheet.width / 2.0)
        self._scale = np.array((1.0, 1.0, 1.0, 1.0 / lever, 1.0 / lever, 1.0 / lever)) * np.array(WEIGHTS)
        self._scaled = self.matrix * self._scale[:, None]

    def thrusts(self, wrench: Array, low: Array, high: Array) -> Array:
        """Return newtons for each thruster, within bounds, that come nearest to a wrench by `WEIGHTS`.

        Where thrusters that are missing would make the others tilt the vehicle by more than `TILT`, against
        what rights it, they give so much less that it does not tilt so far.
        """
        thrusts = bounded_least_squares(self._scaled, wrench * self._scale, low, high)
        for factor in STRICTER:
            tilting = np.abs(self.missing(wrench, thrusts)[3:5])
            if float(tilting.max()) <= self._tilting:
                break
            scale = self._scale * np.array((1.0, 1.0, 1.0, factor, factor, 1.0))
            thrusts = bounded_least_squares(self.matrix * scale[:, None], wrench * scale, low, high)
        return thrusts

    def missing(self, wrench: Array, thrusts: Array) -> Array:
        """Return what of a wrench those thrusts do not give: N and N.m."""
        return wrench - self.matrix @ thrusts

    def served(self, working: Sequence[bool]) -> tuple[bool, ...]:
        """Return for each of `DEGREES` whether the thrusters that work can push along it alone.

        Of surge, sway, heave and yaw without pushing along another of these; of roll and pitch without
        pushing along any other.
        """
        matrix = self.matrix[:, list(working)]
        steered = _reached(matrix[list(STEERED)])
        all_six = _reached(matrix)
        return tuple(
            steered[STEERED.index(degree)] if degree in STEERED else all_six[degree] for degree in range(6)
        )

    def most(self, limits: Array) -> Array:
        """Return how much of each degree thrusts within plus and minus `limits` give together, N and N.m."""
        most: Array = np.abs(self.matrix) @ limits
        return most


def _unit(direction: Sequence[float]) -> Array:
    vector = np.array(direction, float)
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0.0 else vector


def _reached(matrix: Array) -> list[bool]:
    """Return for each row's direction whether columns add up to it alone."""
    if matrix.shape[1] == 0:
        return [False] * matrix.shape[0]
    onto = matrix @ np.linalg.pinv(matrix, rcond=1e-6)
    return [bool(onto[row, row] > 1.0 - 1e-6) for row in range(matrix.shape[0])]
