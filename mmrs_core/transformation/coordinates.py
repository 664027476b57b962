"""The positions of a behaviour as coordinates of the Behaviour Language."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from mmrs_core.geometry.frames import LocalFrame
from mmrs_core.languages import behaviour as bl
from mmrs_core.scene import AltitudeReference, Frame, Position

DEGREE_DIGITS = 9
"""Digits after the point of a degree: a tenth of a millimetre on the ground."""

METRE_DIGITS = 4


class Coordinates:
    """Makes one target for each position, however often it is used.

    Geographic in a mission with a place on the Earth, relative to the origin in a local one.
    Altitudes keep the mission's reference where its origin has an altitude in it; otherwise they
    count from the origin.
    """

    def __init__(self, frame: Frame, positions: Iterable[Position]) -> None:
        self._frame = frame
        self._lift = frame.altitude if frame.altitude_reference != "ORIGIN" else 0.0
        unique = list(dict.fromkeys(_rounded(position) for position in positions))
        self._made = dict(zip(unique, self._make(unique), strict=True))

    @property
    def altitude_reference(self) -> AltitudeReference:
        """Return what the altitudes of the coordinates count from."""
        return "ORIGIN" if self._lift is None else self._frame.altitude_reference

    @property
    def all(self) -> list[bl.Coordinate]:
        """Return every coordinate, in the order in which positions were given."""
        return list(self._made.values())

    def at(self, position: Position) -> bl.Coordinate:
        """Return the coordinate of a position that was given at the beginning."""
        return self._made[_rounded(position)]

    def _make(self, positions: list[Position]) -> list[bl.Coordinate]:
        if self._frame.latitude is None or self._frame.longitude is None:
            return [bl.RelativeCoordinate(x=east, y=north, z=up) for east, north, up in positions]
        frame = LocalFrame(self._frame.crs, self._frame.latitude, self._frame.longitude)
        flat = np.array([position[:2] for position in positions], dtype=float).reshape(-1, 2)
        degrees = frame.to_geographic(flat)
        lift = self._lift or 0.0
        return [
            bl.GeoCoordinate(
                latitude=round(float(latitude), DEGREE_DIGITS),
                longitude=round(float(longitude), DEGREE_DIGITS),
                altitude=round(up + lift, METRE_DIGITS),
            )
            for (latitude, longitude), (_, _, up) in zip(degrees, positions, strict=True)
        ]


def _rounded(position: Position) -> Position:
    east, north, up = (round(float(value), METRE_DIGITS) + 0.0 for value in position)
    return (east, north, up)
