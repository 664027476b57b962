"""Where things were, in the frame of a behaviour and on the Earth."""

from __future__ import annotations

from dataclasses import dataclass

from mmrs_core.geometry.frames import LocalFrame
from mmrs_core.scene import Frame, Position


@dataclass(frozen=True, slots=True)
class Place:
    """Where something was: metres in the frame of the behaviour, and degrees where it lies on the Earth."""

    position: Position
    latitude: float | None = None
    longitude: float | None = None


class Places:
    """Tells where places of a frame are, in degrees where it lies on the Earth."""

    def __init__(self, frame: Frame) -> None:
        self._laid: LocalFrame | None = None
        if frame.latitude is not None and frame.longitude is not None:
            self._laid = LocalFrame(frame.crs, frame.latitude, frame.longitude)

    def of(self, position: Position) -> Place:
        """Return a position as a place."""
        if self._laid is None:
            return Place(position)
        latitude, longitude = self._laid.to_geographic([position[:2]])[0].tolist()
        return Place(position, latitude, longitude)
