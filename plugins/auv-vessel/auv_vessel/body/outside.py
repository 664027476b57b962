"""Thrusters whose drives are nodes of their own: what they say that they put out."""

from __future__ import annotations

from math import inf

from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Received

HELD = 0.5
"""Seconds for which a motor goes on when its drive is silent: motor controllers without set-points stop."""


class Outside:
    """What drives on the bus put out, as `ThrusterStatus` tells it."""

    def __init__(self, sheet: Sheet) -> None:
        """Know of no thrust yet."""
        self._told = [(-inf, 0.0)] * len(sheet.thrusters)

    def hear(self, number: int, status: Received, now: float) -> None:
        """Take what a drive says."""
        self._told[number] = (now, float(status.values["Thrust"]))

    def thrusts(self, now: float) -> list[float]:
        """Return newtons of each thruster."""
        return [thrust if now - at < HELD else 0.0 for at, thrust in self._told]
