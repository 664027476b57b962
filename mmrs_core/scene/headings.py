"""Headings: degrees clockwise from north."""

from __future__ import annotations

from math import acos, atan2, degrees, hypot, pi

from mmrs_core.scene.primitives import Position
from mmrs_runtime.controllers.geodesy import turn as turn

SPOT = 1e-9
"""Metres in the plane below which one place is above another."""


def bearing(start: Position, finish: Position) -> float | None:
    """Return the heading from one place to another; None straight up, straight down or on the spot."""
    east, north = finish[0] - start[0], finish[1] - start[1]
    return degrees(atan2(east, north)) % 360.0 if hypot(east, north) > SPOT else None


def turn_at(before: Position, corner: Position, after: Position) -> float:
    """Return the angle by which a path turns at a corner, in radians; pi where a leg has no length."""
    a = tuple(q - p for p, q in zip(before, corner, strict=True))
    b = tuple(q - p for p, q in zip(corner, after, strict=True))
    lengths = hypot(*a) * hypot(*b)
    if lengths == 0.0:
        return pi
    cosine = sum(p * q for p, q in zip(a, b, strict=True)) / lengths
    return acos(max(-1.0, min(1.0, cosine)))
