"""Attitude as a unit quaternion (w, x, y, z) that turns body axes into north, east, down."""

from __future__ import annotations

from math import asin, atan2, cos, degrees, radians, sin
from typing import TypeAlias

from auv_vessel.sheet import Vector

Quaternion: TypeAlias = tuple[float, float, float, float]
Rows: TypeAlias = tuple[Vector, Vector, Vector]


def of_angles(roll: float, pitch: float, heading: float) -> Quaternion:
    """Return the attitude that heading, then pitch, then roll make, degrees."""
    (cr, sr), (cp, sp), (ch, sh) = (
        (cos(radians(angle) / 2.0), sin(radians(angle) / 2.0)) for angle in (roll, pitch, heading)
    )
    return (
        cr * cp * ch + sr * sp * sh,
        sr * cp * ch - cr * sp * sh,
        cr * sp * ch + sr * cp * sh,
        cr * cp * sh - sr * sp * ch,
    )


def angles_of(rows: Rows) -> Vector:
    """Return roll, pitch and heading of a rotation, degrees; the heading from 0 to less than 360."""
    down = rows[2]
    pitch = -asin(max(-1.0, min(1.0, down[0])))
    heading = degrees(atan2(rows[1][0], rows[0][0])) % 360.0
    return degrees(atan2(down[1], down[2])), degrees(pitch), heading % 360.0


def rows_of(w: float, x: float, y: float, z: float) -> Rows:
    """Return north, east and down, each in body axes."""
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


def to_world(rows: Rows, body: Vector) -> Vector:
    """Return a vector of body axes in north, east, down."""
    x, y, z = body
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def to_body(rows: Rows, world: Vector) -> Vector:
    """Return a vector of north, east, down in body axes."""
    x, y, z = world
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z
