"""The battery of a simulated vehicle."""

from __future__ import annotations

FULL, EMPTY = 4.2, 3.4
"""Volts of a cell; the voltage falls linearly between them."""


class Battery:
    """A battery that lasts for its endurance, whatever its vehicle does.

    Attributes:
        level: remaining fraction, 0 to 1.
        current: amperes.
    """

    def __init__(self, endurance: float, capacity: float, cells: int) -> None:
        """Create a full battery; endurance in seconds, capacity in mAh."""
        self.level, self.current = 1.0, 0.0
        self._endurance, self._capacity, self._cells = endurance, capacity, cells

    @property
    def voltage(self) -> float:
        """Return the voltage."""
        return self._cells * (EMPTY + (FULL - EMPTY) * self.level)

    @property
    def used(self) -> float:
        """Return the mAh since the battery was full."""
        return (1.0 - self.level) * self._capacity

    def drain(self, seconds: float) -> None:
        """Deliver the power of an armed vehicle."""
        self.level = max(0.0, self.level - seconds / self._endurance)
        self.current = self._capacity * 3.6 / self._endurance

    def charge(self, seconds: float, until_full: float) -> None:
        """Stand idle, at a charger that fills an empty battery in `until_full` seconds; 0: at none."""
        self.level = min(1.0, self.level + seconds / until_full) if until_full else self.level
        self.current = 0.0
