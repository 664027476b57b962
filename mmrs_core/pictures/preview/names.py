"""Places the names of robots, tasks, areas and context elements on the map."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from math import dist

import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.pictures.figures import heights
from mmrs_core.pictures.palette import style_of
from mmrs_core.pictures.preview.labels import Box, Label, Labels, around
from mmrs_core.pictures.preview.picture import Picture, RobotPicture, TaskPicture, Zone, incomplete
from mmrs_core.pictures.preview.projection import Projection
from mmrs_core.scene import AreaUse, Point, Position, Ring

BADGE = 8.5
"""Radius of a badge, pixels."""
STEM = 20.0
"""How far above an element's position its badge stands, pixels."""
STAYING = ("work", "hold")
"""The kinds of legs whose stays are marked."""
STAY = 5.5
"""Radius of the mark of a stay, pixels."""
PIN = 9.0
"""Radius of the number of a problem, pixels."""
_FEW = 20
_HOME = 9.0
"""Half the width of the mark of a home, pixels."""


def badge_places(tasks: Iterable[TaskPicture], projection: Projection) -> dict[str, Point]:
    """Return the pixels of the badges of tasks at points, by task: side by side where they share a point."""
    taken: list[Point] = []
    places: dict[str, Point] = {}
    for task in tasks:
        if task.point is not None and not (task.rings or task.lines):
            x, y = projection.place(task.point)
            while any(dist((x, y), other) < BADGE for other in taken):
                x += 2 * BADGE + 1
            taken.append((x, y))
            places[task.name] = (x, y)
    return places


def names_on(picture: Picture, projection: Projection, first: int = 0) -> list[Label]:
    """Return the names of a map, placed so that none covers another where there is room.

    Args:
        first: index of the first robot, for its style.
    """
    labels = Labels(projection.width, projection.height)
    for box in chain(_furniture(projection), _marks(picture, projection)):
        labels.keep_off(box)
    for line in _lines(picture):
        labels.avoid([projection.place(point) for point in line])
    for outline in _outlines(picture):
        labels.lay_out([projection.place(point) for point in outline])
    kinds = (_of_tasks, _of_elements, _of_zones)
    names = chain.from_iterable(of_kind(picture, projection) for of_kind in kinds)
    smallest_first = sorted(names, key=lambda name: _area(name.around))
    for name in chain(_of_robots(picture, projection, first), smallest_first):
        labels.put(name)
    return labels.placed


def _furniture(projection: Projection) -> tuple[Box, Box]:
    """Return what scale bar and north arrow cover."""
    width = projection.bar_length() * projection.scale
    bottom = projection.height
    return (10.0, bottom - 42, 26.0 + width, bottom), (projection.width - 44, 6.0, projection.width - 8, 62.0)


def _area(box: Box) -> float:
    left, top, right, bottom = box
    return (right - left) * (bottom - top)


def _marks(picture: Picture, projection: Projection) -> Iterator[Box]:
    """Yield what small marks cover."""
    for robot in picture.robots:
        yield around(projection.place(robot.home), _HOME)
        stays = (leg.points[0] for leg in robot.legs if leg.stays and leg.kind in STAYING)
        yield from (around(projection.place(at), STAY) for at in stays)
    for at in badge_places(picture.tasks, projection).values():
        yield around(at, BADGE)
    for element in picture.elements:
        yield from (around(projection.place(mark), BADGE, STEM) for mark in element.marks)
    for problem in picture.problems:
        if problem.at is not None:
            yield around(projection.place(problem.at), PIN)


def _lines(picture: Picture) -> Iterator[Sequence[Point | Position]]:
    """Yield what names should not hide: paths and borders."""
    if picture.flown:
        yield from (way for robot in picture.robots for way in robot.planned or _flown(robot))
    else:
        yield from (leg.points for robot in picture.robots for leg in robot.legs)
    yield from ((*zone.shell, zone.shell[0]) for zone in picture.zones if zone.shell)
    for element in picture.elements:
        yield from (*element.lines, *((*ring, ring[0]) for ring in element.outlines))


def _outlines(picture: Picture) -> Iterator[Ring]:
    """Yield areas that a name inside of them would be taken to name."""
    yield from (zone.shell for zone in picture.zones if zone.types is None)
    yield from (ring for task in picture.tasks for ring in task.rings[:1])
    yield from (ring for element in picture.elements if not element.inner for ring in element.outlines)


def _flown(robot: RobotPicture) -> Iterator[Sequence[Position]]:
    """Yield the legs of a robot that has flown and had no plan, with few of their points."""
    yield from (leg.points[:: max(len(leg.points) // _FEW, 1)] for leg in robot.legs)


def _of_robots(picture: Picture, projection: Projection, first: int) -> Iterator[Label]:
    for index, robot in enumerate(picture.robots, start=first):
        x, y = projection.place(robot.home)
        box = (x - _HOME, y - _HOME, x + _HOME, y + _HOME)
        yield Label(robot.name, box, "name", style_of(index).colour, note=incomplete(robot.gap))


def _of_tasks(picture: Picture, projection: Projection) -> Iterator[Label]:
    places = badge_places(picture.tasks, projection)
    for task in picture.tasks:
        shape, icon = _shape(task), (task.symbol.icon, task.symbol.colour)
        if task.name in places:
            box, icon = around(places[task.name], BADGE), ("", "")
        elif shape is not None:
            box = _box(shape, projection)
        else:
            continue
        yield Label(task.name, box, "of-task", tip=task.tip, icon=icon, note=incomplete(task.gap))


def _shape(task: TaskPicture) -> BaseGeometry | None:
    if task.rings:
        return _polygon(task.rings[0])
    if task.lines:
        return shapely.Point(task.lines[0][len(task.lines[0]) // 2])
    return None


def _of_elements(picture: Picture, projection: Projection) -> Iterator[Label]:
    shown = _shown(projection)
    for element in picture.elements:
        shapes = (
            *map(shapely.Point, element.marks),
            *map(_polygon, element.outlines),
            *(shapely.Point(line[len(line) // 2]) for line in element.lines),
        )
        if shapes and not element.inner and shown.intersects(shapes[0]):
            icon = ("" if element.marks else element.symbol.icon, element.symbol.colour)
            box = (
                around(projection.place(element.marks[0]), BADGE, STEM)
                if element.marks
                else _box(shapes[0], projection)
            )
            note = incomplete(element.gap)
            yield Label(element.name, box, "of-element", tip=element.tip, icon=icon, note=note)


def _of_zones(picture: Picture, projection: Projection) -> Iterator[Label]:
    shown = _shown(projection)
    # What bars some types only is a context element, and named as such.
    for zone in (zone for zone in picture.zones if zone.types is None):
        seen = shapely.intersection(_polygon(zone.shell), shown)
        if not seen.is_empty:
            box = _box(_polygon(zone.shell), projection)
            yield Label(_zone_words(zone), box, f"of-{zone.use.value}", note=incomplete(zone.gap))


def _zone_words(zone: Zone) -> str:
    return f"{zone.name} ({heights(zone.low, zone.high)})" if zone.use is AreaUse.OBSTACLE else zone.name


def _shown(projection: Projection) -> Polygon:
    return shapely.box(projection.west, projection.south, projection.east, projection.north)


def _polygon(ring: Ring) -> BaseGeometry:
    return shapely.make_valid(Polygon(ring)) if len(ring) > 2 else shapely.MultiPoint(ring)


def _box(shape: BaseGeometry, projection: Projection, reach: float = 0.0) -> Box:
    """Return what words about a shape are placed on or beside, in pixels: a box around its middle.

    The box is as wide and as high as the shape is at its middle, so that words on it are on the shape;
    `reach` pixels more where what is drawn there is larger.
    """
    shown = _shown(projection)
    seen = shapely.intersection(shape, shown) if shape.is_valid else shape
    middle = (shape if seen.is_empty else seen).representative_point()
    west, _, east, _ = _across(seen, middle, ((shown.bounds[0], middle.y), (shown.bounds[2], middle.y)))
    _, south, _, north = _across(seen, middle, ((middle.x, shown.bounds[1]), (middle.x, shown.bounds[3])))
    left, top = projection.place((west, north))
    right, bottom = projection.place((east, south))
    return left - reach, top - reach, right + reach, bottom + reach


def _across(
    shape: BaseGeometry, middle: shapely.Point, line: tuple[Point, Point]
) -> tuple[float, float, float, float]:
    """Return the bounds of the part of a line in a shape that is nearest to a point in both."""
    pieces = [piece for piece in shapely.get_parts(shape.intersection(LineString(line))) if piece.length]
    if not pieces:
        return middle.x, middle.y, middle.x, middle.y
    west, south, east, north = min(pieces, key=middle.distance).bounds
    return float(west), float(south), float(east), float(north)
