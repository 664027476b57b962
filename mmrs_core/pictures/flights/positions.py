"""Positions in the frame of a behaviour and on the Earth, and those of robots at each of their steps."""

from __future__ import annotations

from dataclasses import dataclass

from mmrs_core.behaviour.earth import wgs84_of
from mmrs_core.behaviour.program import Program
from mmrs_core.pictures.flights.flight import Flight
from mmrs_core.scene import Frame, Position
from mmrs_runtime.records.steps import merge


@dataclass(frozen=True, slots=True)
class GeoPosition:
    """A position: metres in the frame of the behaviour, and degrees of WGS 84 where it is on the Earth."""

    position: Position
    latitude: float | None = None
    longitude: float | None = None


class Locator:
    """Converts positions of a frame to degrees of WGS 84, where it lies on the Earth."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame

    def of(self, position: Position) -> GeoPosition:
        """Return a position with its degrees."""
        if self._frame.is_local:
            return GeoPosition(position)
        latitude, longitude = wgs84_of([position[:2]], self._frame)[0].tolist()
        return GeoPosition(position, latitude, longitude)


@dataclass(frozen=True, slots=True)
class PlacedStep:
    """A step of a log. Attributes: `words` describe it; `where` is None where its position is unknown."""

    robot: str
    seq: int
    time: float
    words: str
    where: GeoPosition | None


def steps_of(flight: Flight, program: Program) -> tuple[PlacedStep, ...]:
    """Return the steps of all robots in a possible order, each with its position."""
    places = Locator(program.frame)
    placed = []
    for record in merge(record for flown in flight.robots.values() for record in flown.records):
        at = flight.robots[record.robot].track.at(record.time)
        words = " ".join(each for each in (record.label, record.move, record.detail, record.slot) if each)
        where = places.of(at) if at is not None else None
        placed.append(PlacedStep(record.robot, record.seq, record.time, words, where))
    return tuple(placed)
