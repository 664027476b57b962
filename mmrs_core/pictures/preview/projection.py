"""How metres become pixels on the map, north up."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain
from math import floor, log10

from mmrs_core.pictures.documents import number
from mmrs_core.pictures.preview.picture import Picture
from mmrs_core.scene import Point, Position

WIDTH = 1000.0
_NARROWEST = 1.25
_FLATTEST = 2.4
_SMALLEST_EXTENT = 10.0
_PADDING = 0.07
_REACH = 0.35


@dataclass(frozen=True, slots=True)
class Projection:
    """A rectangle of the ground and its size in pixels.

    Attributes:
        west, south, east, north: metres.
        scale: pixels a metre.
    """

    west: float
    south: float
    east: float
    north: float
    scale: float

    @property
    def width(self) -> float:
        """Return the width in pixels."""
        return (self.east - self.west) * self.scale

    @property
    def height(self) -> float:
        """Return the height in pixels."""
        return (self.north - self.south) * self.scale

    def place(self, point: Point | Position) -> Point:
        """Return where a point lies: pixels right and down from the upper left corner."""
        return (point[0] - self.west) * self.scale, (self.north - point[1]) * self.scale

    def line(self, points: Iterable[Point | Position]) -> str:
        """Return a polyline as SVG writes it after a moveto."""
        placed = (self.place(point) for point in points)
        return "L".join(f"{number(x)} {number(y)}" for x, y in placed)

    def lines(self, lines: Iterable[Sequence[Point | Position]]) -> str:
        """Return polylines as the data of one SVG path; those of one point as a dot."""
        return " ".join(f"M{self.line(line)}{'h0' * (len(line) == 1)}" for line in lines)

    def closed(self, rings: Iterable[Iterable[Point]]) -> str:
        """Return closed rings as the data of one SVG path."""
        return " ".join(f"M{self.line(ring)}Z" for ring in rings)

    def bar_length(self) -> float:
        """Return a round number of metres for a scale bar.

        >>> Projection(0, 0, 500, 400, 2).bar_length()
        100.0
        """
        wanted = (self.east - self.west) / 4
        power = 10.0 ** floor(log10(wanted))
        return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted)


def projection_of(picture: Picture) -> Projection:
    """Return a projection that shows all robots and tasks, and zones and elements as far as they are near.

    All maps are equally wide; very high or flat ones show more ground around.
    """
    points = list(_points(picture)) or [p for zone in picture.zones for p in zone.shell] or [(0.0, 0.0)]
    west, east = _span(p[0] for p in points)
    south, north = _span(p[1] for p in points)
    reach = _REACH * max(east - west, north - south)
    shapes = (*(zone.shell for zone in picture.zones), *(each.points for each in picture.elements))
    near = [
        (_clip(p[0], west - reach, east + reach), _clip(p[1], south - reach, north + reach))
        for shape in shapes
        for p in shape
        if _touches(shape, west - reach, south - reach, east + reach, north + reach)
    ]
    west, east = _span(chain((west, east), (p[0] for p in near)))
    south, north = _span(chain((south, north), (p[1] for p in near)))
    padding = _PADDING * max(east - west, north - south)
    west, south, east, north = west - padding, south - padding, east + padding, north + padding
    more = max(_NARROWEST * (north - south) - (east - west), 0.0) / 2
    west, east = west - more, east + more
    more = max((east - west) / _FLATTEST - (north - south), 0.0) / 2
    return Projection(west, south - more, east, north + more, WIDTH / (east - west))


def _points(picture: Picture) -> Iterable[Point]:
    for robot in picture.robots:
        yield robot.home[:2]
        yield from (p[:2] for leg in robot.legs for p in leg.points)
    for task in picture.tasks:
        yield from chain(*task.lines, *task.rings)
        if task.point is not None:
            yield task.point
    yield from (problem.at for problem in picture.problems if problem.at is not None)


def _span(values: Iterable[float]) -> tuple[float, float]:
    all_values = list(values)
    low, high = min(all_values), max(all_values)
    missing = max(_SMALLEST_EXTENT - (high - low), 0.0) / 2
    return low - missing, high + missing


def _clip(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


def _touches(shell: Iterable[Point], west: float, south: float, east: float, north: float) -> bool:
    left, lower, right, upper = bounds(shell)
    return left <= east and right >= west and lower <= north and upper >= south


def bounds(points: Iterable[Point]) -> tuple[float, float, float, float]:
    """Return the least east and north, and the greatest, of at least one point."""
    listed = list(points)
    easts, norths = [point[0] for point in listed], [point[1] for point in listed]
    return min(easts), min(norths), max(easts), max(norths)
