"""Places as vehicles take them: degrees of WGS 84, and heights above each robot's own zero."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from mmrs_core.errors import UnsupportedError
from mmrs_core.geometry.frames import Floats, LocalFrame
from mmrs_core.scene import Frame, Point, Position

if TYPE_CHECKING:
    from pyproj import Transformer

WGS84 = "EPSG:4326"
DECIMALS = 7
LOCAL = "behaviour: is local, its origin has no latitude and longitude"
FARTHEST = 89.0
"""Latitude, north or south, up to which a straight leg is one in degrees, too: to a metre in a kilometre."""


def degrees_of(points: Sequence[Point], frame: Frame) -> tuple[tuple[float, float], ...]:
    """Return (latitude, longitude) in degrees of WGS 84, with seven decimals.

    Args:
        points: (east, north) in metres.
        frame: of the behaviour.

    Raises:
        UnsupportedError: the frame has no place on the Earth.
    """
    pairs = wgs84_of(points, frame).tolist()
    return tuple((round(latitude, DECIMALS), round(longitude, DECIMALS)) for latitude, longitude in pairs)


def wgs84_of(points: ArrayLike, frame: Frame) -> Floats:
    """Return an (n, 2) array of latitude and longitude in degrees of WGS 84, not rounded.

    Args:
        points: (n, 2) metres east and north.
        frame: of the behaviour.

    Raises:
        UnsupportedError: the frame has no place on the Earth.
    """
    if frame.latitude is None or frame.longitude is None:
        raise UnsupportedError(LOCAL)
    own = LocalFrame(frame.crs, frame.latitude, frame.longitude).to_geographic(points)
    if not len(own):
        return own
    longitudes, latitudes = _to_wgs84(frame.crs).transform(own[:, 1], own[:, 0])
    return np.column_stack([latitudes, longitudes]).astype(np.float64)


def at_a_pole(frame: Frame) -> Iterator[str]:
    """Yield that a behaviour is where degrees do not lead vehicles straight to a place."""
    if frame.latitude is not None and abs(frame.latitude) > FARTHEST:
        yield "behaviour: is within a degree of a pole, where vehicles that steer by degrees go astray"


def metres(value: float) -> float:
    """Return a length rounded to millimetres, never minus zero."""
    return round(value, 3) + 0.0


def sea_level_of(position: Position, frame: Frame) -> float | None:
    """Return the height of a position above mean sea level in metres; None where it is not known."""
    origin = origin_above_sea(frame)
    return None if origin is None else metres(origin + position[2])


def origin_above_sea(frame: Frame) -> float | None:
    """Return the height of the origin above mean sea level in metres; None where it is not known."""
    if frame.altitude is None or frame.altitude_reference == "MSL":
        return frame.altitude
    if frame.altitude_reference == "ELLIPSOID" and frame.geoid_separation is not None:
        return frame.altitude - frame.geoid_separation
    return None


def origin_above_ellipsoid(frame: Frame) -> float | None:
    """Return the height of the origin above the ellipsoid in metres; None where it is not known."""
    if frame.altitude is None or frame.altitude_reference == "ELLIPSOID":
        return frame.altitude
    if frame.altitude_reference == "MSL" and frame.geoid_separation is not None:
        return frame.altitude + frame.geoid_separation
    return None


@lru_cache(maxsize=16)
def from_wgs84(crs: str) -> Transformer:
    """Return what turns longitudes and latitudes of WGS 84 into those of a frame."""
    from pyproj import Transformer

    return Transformer.from_crs(WGS84, _known(crs), always_xy=True)


@lru_cache(maxsize=16)
def _to_wgs84(crs: str) -> Transformer:
    from pyproj import Transformer

    return Transformer.from_crs(_known(crs), WGS84, always_xy=True)


def _known(crs: str) -> str:
    return WGS84 if crs.strip().lower() in ("wgs84", "wgs 84", "wgs-84") else crs
