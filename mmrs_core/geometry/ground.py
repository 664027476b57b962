"""Where the ground is: flat at the origin's height, except around a robot's home."""

from __future__ import annotations

from math import hypot

HOME_RADIUS = 2.0
"""Metres around a home within which the ground has the home's height."""


def ground_height(here: tuple[float, float, float], home: tuple[float, float, float] | None) -> float:
    """Return the height of the ground below a position, metres above the origin.

    >>> ground_height((1.0, 1.0, 30.0), (0.0, 0.0, 4.0)), ground_height((5.0, 0.0, 30.0), (0.0, 0.0, 4.0))
    (4.0, 0.0)
    """
    if home is None or hypot(here[0] - home[0], here[1] - home[1]) > HOME_RADIUS:
        return 0.0
    return home[2]
