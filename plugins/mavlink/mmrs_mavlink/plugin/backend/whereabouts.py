"""Where a robot is, from what its vehicle tells: degrees, or metres from home, to the local frame."""

from __future__ import annotations

from functools import cached_property

from mmrs_core.behaviour.earth import from_wgs84
from mmrs_core.geometry.frames import LocalFrame
from mmrs_core.scene import Frame, Position
from mmrs_mavlink.program import Geographic, Place


class Ground:
    """The local frame of a behaviour, as one robot sees it."""

    def __init__(self, frame: Frame, home: Position, zero: float) -> None:
        """Lay it.

        Args:
            frame: of the behaviour.
            home: of the robot: east, north, up.
            zero: height above the origin from which the robot's heights count, metres.
        """
        self._frame, self._home, self._zero = frame, home, zero

    def position(self, place: Place) -> Position:
        """Return a place as metres east, north and up of the origin."""
        if not isinstance(place, Geographic):
            return (self._home[0] + place.east, self._home[1] + place.north, self._zero + place.height)
        longitude, latitude = from_wgs84(self._frame.crs).transform(place.longitude, place.latitude)
        east, north = self._plane.to_local([latitude], [longitude])[0]
        return (float(east), float(north), self._zero + place.height)

    @cached_property
    def _plane(self) -> LocalFrame:
        assert self._frame.latitude is not None
        assert self._frame.longitude is not None
        return LocalFrame(self._frame.crs, self._frame.latitude, self._frame.longitude)
