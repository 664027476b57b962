"""The battery of a simulated vehicle."""

from __future__ import annotations

from mmrs_mavlink.sitl.body import Body

FULL, EMPTY = 4.2, 3.4
"""Volts of a cell without load; the voltage falls linearly between them."""

RESISTANCE = 0.02
"""Internal resistance, ohms."""

IDLE_AMPERES, MOST_AMPERES = 0.4, 120.0
CRUISE = 10.0
"""Air speed, metres per second, at which a level flight takes 1.5 times the power of hovering."""


class Battery:
    """A battery that lasts for a given time of hovering.

    Attributes:
        level: remaining fraction, 0 to 1.
        current: amperes.
        used: mAh since the battery was full.
    """

    def __init__(self, hover_seconds: float, capacity: float, cells: int) -> None:
        self.level = 1.0
        self.current = IDLE_AMPERES
        self.used = 0.0
        self._hover = hover_seconds
        self._capacity, self._cells = capacity, cells

    @property
    def voltage(self) -> float:
        """Return the voltage under the present load."""
        return max(0.0, self._cells * (EMPTY + (FULL - EMPTY) * self.level) - RESISTANCE * self.current)

    def drain(self, seconds: float, load: float) -> None:
        """Deliver `load` times the power of hovering."""
        part = min(self.level, seconds * load / self._hover)
        self.level -= part
        self.used += part * self._capacity
        self.current = min(MOST_AMPERES, load * self._capacity * 3.6 / self._hover)

    def charge(self, seconds: float, until_full: float) -> None:
        """Stand idle, at a charger that fills an empty battery in `until_full` seconds; 0: at none."""
        self.current = IDLE_AMPERES
        if until_full:
            self.change(min(1.0, self.level + seconds / until_full))

    def change(self, level: float) -> None:
        """Replace the battery by one with that remaining fraction."""
        self.level = level
        self.used = (1.0 - level) * self._capacity


def load_of(body: Body) -> float:
    """Return the power of a movement as a multiple of hovering without wind."""
    return load_at(body.air_pace) + 0.1 * max(0.0, body.velocity[2])


def load_at(air_pace: float) -> float:
    """Return the power of a level flight at an air speed as a multiple of hovering."""
    return 1.0 + 0.5 * (air_pace / CRUISE) ** 2
