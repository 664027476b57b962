"""Finds when a robot is above, inside or beneath an area."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import accumulate, pairwise
from math import dist

import shapely
from shapely.geometry import LineString, Polygon

from mmrs_core.pictures.preview.picture import Leg, RobotPicture, Zone
from mmrs_core.scene import AreaUse, Position


@dataclass(frozen=True, slots=True)
class Crossing:
    """A stretch of time in which a robot is above, inside or under an area, seen from above."""

    zone: Zone
    begin: float
    end: float


def crossings(robot: RobotPicture, zones: Iterable[Zone]) -> Iterator[Crossing]:
    """Yield when a robot passes an obstacle or forbidden area, in the order of zones and legs."""
    for zone in zones:
        if zone.use is AreaUse.EMERGENCY or not robot.legs:
            continue
        shape = Polygon(zone.shell)
        west, south, east, north = shape.bounds
        for leg in robot.legs:
            for (begin, start), (end, stop) in pairwise(corners(leg)):
                aside = max(start[0], stop[0]) < west or min(start[0], stop[0]) > east
                if aside or max(start[1], stop[1]) < south or min(start[1], stop[1]) > north:
                    continue
                yield from (
                    Crossing(zone, begin + (end - begin) * a, begin + (end - begin) * b)
                    for a, b in _shares(start, stop, shape)
                )


def corners(leg: Leg) -> Iterator[tuple[float, Position]]:
    """Yield (time, position) at every corner of a leg; without times, at a constant speed."""
    if leg.times:
        yield from zip(leg.times, leg.points, strict=True)
        return
    lengths = [0.0, *accumulate(dist(a, b) for a, b in pairwise(leg.points))]
    whole = lengths[-1] or 1.0
    for point, so_far in zip(leg.points, lengths, strict=True):
        yield leg.begin + (leg.end - leg.begin) * so_far / whole, point


def _shares(start: Position, stop: Position, shape: Polygon) -> Iterator[tuple[float, float]]:
    """Yield the fractions of a straight stretch between which it lies over a shape."""
    way = LineString((start[:2], stop[:2]))
    if way.length == 0:
        if shape.covers(shapely.Point(start[:2])):
            yield 0.0, 1.0
        return
    for piece in shapely.get_parts(shapely.intersection(way, shape)):
        if isinstance(piece, LineString) and not piece.is_empty:
            ends = sorted(way.project(shapely.Point(point)) / way.length for point in piece.coords)
            yield ends[0], ends[-1]
