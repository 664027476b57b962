"""The simulated vehicle's battery: what it gives, and what its autopilot knows of it."""

from __future__ import annotations

from mmrs_mavlink.sitl.body import Body

CELLS = 3
FULL, EMPTY = 4.2, 3.4
"""Volts of a cell without load; between them the voltage falls evenly."""

RESISTANCE = 0.02
"""Ohms by which the voltage sags under load."""

IDLE_AMPERES, MOST_AMPERES = 0.4, 120.0
CRUISE = 10.0
"""Metres per second in the air at which half as much again is needed as in hover."""


class Battery:
    """A battery that lasts for so many seconds of hovering.

    Attributes:
        level: part that is left, 0 to 1.
        current: amperes.
        used: milliampere-hours since it was changed, or since somebody said that it is full.
    """

    def __init__(self, hover_seconds: float, capacity: float) -> None:
        """Be full, with so many milliampere-hours."""
        self.level = 1.0
        self.current = IDLE_AMPERES
        self.used = 0.0
        self._hover = hover_seconds
        self._capacity = capacity

    @property
    def voltage(self) -> float:
        """Return what is measured under the present load, volts."""
        return max(0.0, CELLS * (EMPTY + (FULL - EMPTY) * self.level) - RESISTANCE * self.current)

    def drain(self, seconds: float, load: float) -> None:
        """Give `load` times the power of hovering for a while."""
        part = min(self.level, seconds * load / self._hover)
        self.level -= part
        self.used += part * self._capacity
        self.current = min(MOST_AMPERES, load * self._capacity * 3.6 / self._hover)

    def charge(self, seconds: float, until_full: float) -> None:
        """Stand for a while at a charger that takes so many seconds to fill it; 0: at none."""
        self.current = IDLE_AMPERES
        if until_full:
            self.change(min(1.0, self.level + seconds / until_full))

    def change(self, level: float) -> None:
        """Be another battery of which so much is left."""
        self.level = level
        self.used = (1.0 - level) * self._capacity


def load_of(body: Body) -> float:
    """Return the power that a movement takes, in that of hovering without wind."""
    return load_at(body.air_pace) + 0.1 * max(0.0, body.velocity[2])


def load_at(air_pace: float) -> float:
    """Return the power that a level flight takes at so many metres per second in the air."""
    return 1.0 + 0.5 * (air_pace / CRUISE) ** 2
