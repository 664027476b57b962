"""How much each thruster may give now: continually, for short, and not faster than its drive can follow."""

from __future__ import annotations

import numpy as np

from auv_vessel.body.propulsion import curve_of
from auv_vessel.control.allocation import Array
from auv_vessel.sheet import Sheet

PEAK_TIME, RISE_TIME = 10.0, 0.4
"""Seconds of peak thrust from cold (`Sheet.extra`: ``peak.time``), and from zero to it (``rise.time``)."""

WARM = 0.5
"""Part of its heat that a thruster that was at its limit keeps when it may exceed operating thrust again."""


class ThrustLimits:
    """The state of a vehicle's thrusters as to what they may give.

    A thruster heats by the square of its thrust above operating thrust, and cools by the square of what it
    gives less: peak thrust lasts `PEAK_TIME` from cold, and after that as long at rest makes it cold.
    ``power.limit`` in `Sheet.extra`, watts for all thrusters together, is kept; without it there is none.

    Raises:
        ValueError: a limit in the sheet is not positive.
    """

    def __init__(self, sheet: Sheet) -> None:
        self._peak_time = _positive(sheet, "peak.time", PEAK_TIME)
        self._rise_time = _positive(sheet, "rise.time", RISE_TIME)
        self.power_limit = _positive(sheet, "power.limit", float("inf"))
        self._operating = np.array([each.operating_thrust for each in sheet.thrusters], float)
        self._most = np.array(
            [max(each.max_thrust, each.operating_thrust) for each in sheet.thrusters], float
        )
        curves = [curve_of(each) for each in sheet.thrusters]
        self._watts, self._newtons, self._exponents = np.array(curves, float).reshape(-1, 3).T
        self._heat = np.zeros(len(sheet.thrusters))
        self._hot = np.zeros(len(sheet.thrusters), bool)

    def bounds(self, last: Array, working: Array, period: float) -> tuple[Array, Array]:
        """Return the least and the most newtons of each thruster, `period` seconds after it gave `last`."""
        most = np.where(self._hot, self._operating, self._most) * working
        change = self._most * period / self._rise_time
        low = np.maximum(-most, np.minimum(last - change, most))
        high = np.minimum(most, np.maximum(last + change, -most))
        return low, high

    def used(self, thrusts: Array, period: float) -> None:
        """Note that thrusters gave so much for so many seconds."""
        square, operating = np.square(thrusts), np.square(self._operating)
        above = np.maximum(np.square(self._most) - operating, 1e-9)
        warming = np.where(square > operating, (square - operating) / above, square / operating - 1.0)
        self._heat = np.clip(self._heat + warming * period / self._peak_time, 0.0, 1.0)
        self._hot = (self._heat >= 1.0) | (self._hot & (self._heat > WARM))

    def power(self, thrusts: Array) -> float:
        """Return the watts that thrusts take together."""
        return float(np.sum(self._watts * (np.abs(thrusts) / self._newtons) ** self._exponents))


def _positive(sheet: Sheet, name: str, default: float) -> float:
    value = sheet.extra.get(name, default)
    if not value > 0.0:
        raise ValueError(f"{sheet.robot}: {name} is {value:g}, and has to be positive")
    return value
