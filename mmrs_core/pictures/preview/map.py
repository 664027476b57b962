"""Draws the map: areas, tasks, context elements, homes and paths, as SVG."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, degrees, dist
from typing import NamedTuple

from markupsafe import Markup
from shapely.geometry import Polygon

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.documents import number, render, style_sheets
from mmrs_core.pictures.figures import heights, length
from mmrs_core.pictures.palette import Style, style_of
from mmrs_core.pictures.preview.crossings import crossings
from mmrs_core.pictures.preview.key import legend_of
from mmrs_core.pictures.preview.names import BADGE, PIN, STAY, STAYING, STEM, badge_places, names_on
from mmrs_core.pictures.preview.picture import (
    ElementPicture,
    Leg,
    Picture,
    Problem,
    RadioRange,
    RobotPicture,
    TaskPicture,
    Zone,
    incomplete,
)
from mmrs_core.pictures.preview.projection import Projection, projection_of
from mmrs_core.scene import AreaUse, Point

_ARROW_EVERY = 90.0
USES = {
    AreaUse.FORBIDDEN: "forbidden area",
    AreaUse.OBSTACLE: "obstacle",
    AreaUse.EMERGENCY: "emergency area",
}
"""What areas are called."""


class Shape(NamedTuple):
    """A path on the map: its class in the style sheet, its data, and what it is, for the pointer.

    `colour` is that of a plug-in's symbol; empty: the style sheet's.
    """

    kind: str
    d: str
    tip: str = ""
    colour: str = ""


class SymbolShape(NamedTuple):
    """The sign of a symbol around a pixel; with a stem it stands above the pixel."""

    symbol: MapSymbol
    x: float
    y: float
    tip: str
    stem: float = 0.0


@dataclass(frozen=True, slots=True)
class _Path:
    """What is drawn of one robot.

    Attributes:
        legs: with the index of each among the robot's legs.
        stays: (x, y, tip). heads: (x, y, degrees) of arrows. actions: data of a path of dots.
        covered, planned: data of paths; empty where there is nothing.
        marks: (kind, x, y, tip).
    """

    index: int
    name: str
    style: Style
    legs: tuple[tuple[int, Shape], ...]
    stays: tuple[tuple[float, float, str], ...]
    heads: tuple[tuple[float, float, float], ...]
    actions: str
    covered: str
    planned: str
    marks: tuple[tuple[str, float, float, str], ...]
    home: Point
    home_tip: str
    incomplete: bool


def map_of(picture: Picture, *, standalone: bool = False, only: int | None = None) -> Markup:
    """Return the map as one ``svg`` element.

    Args:
        standalone: whether it has its own style sheet and legend, and needs no page around it.
        only: index of the only robot to show; None: all of them.
    """
    shown = picture if only is None else replace(picture, robots=picture.robots[only : only + 1])
    projection, first = projection_of(shown), only or 0
    legend = legend_of(picture, projection.width) if standalone else None
    emergency = [zone for zone in shown.zones if zone.use is AreaUse.EMERGENCY]
    return render(
        "map.svg",
        standalone=standalone,
        sheet=style_sheets("map", standalone=True) if standalone else "",
        title=picture.title or "mission",
        flown=picture.flown,
        width=projection.width,
        height=projection.height,
        grid=_grid(projection),
        ranges=[_range(each, projection) for each in shown.ranges],
        emergency=[_zone(zone, projection) for zone in emergency],
        tasks=[*_tasks(shown.tasks, projection)],
        kept=[_kept(zone, projection) for zone in shown.zones if zone.kept],
        areas=[*_barriers(shown, projection)],
        elements=[shapes for each in shown.elements if (shapes := [*_element(each, projection)])],
        paths=[_path(index, robot, projection) for index, robot in enumerate(shown.robots, start=first)],
        problems=_pins(shown, projection),
        names=names_on(shown, projection, first),
        bar=projection.bar_length(),
        bar_pixels=projection.bar_length() * projection.scale,
        legend=legend,
        badge_radius=BADGE,
        stay_radius=STAY,
        pin_radius=PIN,
    )


def _range(range: RadioRange, projection: Projection) -> Shape:
    """Return the circle within which a radio reaches at its own height."""
    (x, y), radius = projection.place(range.at), range.metres * projection.scale
    arcs = "".join(
        f"a{number(radius)} {number(radius)} 0 1 0 {number(each)} 0" for each in (2 * radius, -2 * radius)
    )
    tip = f"{range.whose}: its radio reaches {length(range.metres)}"
    return Shape("range", f"M{number(x - radius)} {number(y)}{arcs}", tip)


def _pins(picture: Picture, projection: Projection) -> list[tuple[float, float, Problem]]:
    """Return (x, y, problem) of every problem with a position; those at one position stand side by side."""
    pins: list[tuple[float, float, Problem]] = []
    for problem in picture.problems:
        if problem.at is not None:
            x, y = projection.place(problem.at)
            while any(dist((x, y), pin[:2]) < 2 * PIN for pin in pins):
                x += 2 * PIN + 1
            pins.append((x, y, problem))
    return pins


def _grid(projection: Projection) -> str:
    """Return the lines of a grid half as wide as the scale bar."""
    step = projection.bar_length() / 2
    first, last = int(projection.west // step) + 1, int(projection.east // step)
    lower, upper = int(projection.south // step) + 1, int(projection.north // step)
    columns = (((i * step, projection.south), (i * step, projection.north)) for i in range(first, last + 1))
    rows = (((projection.west, i * step), (projection.east, i * step)) for i in range(lower, upper + 1))
    return projection.lines((*columns, *rows))


def _barriers(picture: Picture, projection: Projection) -> Iterator[Shape]:
    """Yield forbidden areas and obstacles, small ones over large ones."""
    barriers = (zone for zone in picture.zones if zone.use is not AreaUse.EMERGENCY)
    for zone in sorted(barriers, key=lambda zone: -Polygon(zone.shell).area if len(zone.shell) > 2 else 0.0):
        passed = any(True for robot in picture.robots for _ in crossings(robot, [zone]))
        yield _zone(zone, projection, passed=passed)


def _zone(zone: Zone, projection: Projection, *, passed: bool = False) -> Shape:
    """Return an area as drawn; one that robots pass over or under is drawn lightly."""
    extent = heights(zone.low, zone.high) if zone.types is None else f"for {', '.join(sorted(zone.types))}"
    kind = _marked(f"zone {zone.use.value}" + (" passed" if passed else ""), zone.gap)
    outline = projection.lines(zone.pieces) if zone.pieces else projection.closed((zone.shell,))
    return Shape(kind, outline, f"{zone.name}: {USES[zone.use]}, {extent}{incomplete(zone.gap)}")


def _marked(kind: str, gap: str) -> str:
    """Return the classes of a path, one more where it is incomplete."""
    return f"{kind} incomplete" if gap else kind


def _kept(zone: Zone, projection: Projection) -> Shape:
    """Return the outline that robots keep to."""
    verb = "shrunk" if zone.use is AreaUse.EMERGENCY else "grown"
    tip = f"{zone.name}, {verb} by the clearance of {length(zone.clearance)}"
    if zone.unknown:
        tip += f", which is not known of {', '.join(zone.unknown)}"
    return Shape(f"kept {zone.use.value}", projection.closed(zone.kept), tip)


def _tasks(tasks: tuple[TaskPicture, ...], projection: Projection) -> Iterator[Shape | SymbolShape]:
    """Yield every task that has a position: its area, line or point."""
    places = badge_places(tasks, projection)
    for task in tasks:
        tip, colour = task.tip, task.symbol.colour
        if task.rings:
            yield Shape(_marked("task area", task.gap), projection.closed(task.rings), tip, colour)
        if task.lines:
            yield Shape(_marked("task line", task.gap), projection.lines(task.lines), tip, colour)
        elif task.name in places:
            yield SymbolShape(task.symbol, *places[task.name], tip)


def _element(element: ElementPicture, projection: Projection) -> Iterator[Shape | SymbolShape]:
    """Yield the outlines, lines and marks of a context element."""
    tip, colour = element.tip, element.symbol.colour
    if element.outlines:
        yield Shape(_marked("element area", element.gap), projection.closed(element.outlines), tip, colour)
    for line in element.lines:
        yield Shape(_marked("element line", element.gap), projection.lines([line]), tip, colour)
    for mark in element.marks:
        yield SymbolShape(element.symbol, *projection.place(mark), tip, STEM)


def _path(index: int, robot: RobotPicture, projection: Projection) -> _Path:
    dots = (projection.place(at) for leg in robot.legs for at in leg.actions)
    covered = [ring for leg in robot.legs for ring in leg.covered]
    kind = f"{robot.type_name}, {robot.symbol.label}" if robot.symbol else robot.type_name
    return _Path(
        index,
        robot.name,
        style_of(index),
        tuple(_legs(robot, projection)),
        tuple(_stays(robot, projection)),
        tuple(_heads(robot, projection)),
        "".join(f"M{number(x)} {number(y)}h0" for x, y in dots),
        projection.closed(covered),
        projection.lines(robot.planned),
        tuple((mark.kind, *projection.place(mark.at), f"{robot.name}: {mark.tip}") for mark in robot.marks),
        projection.place(robot.home),
        f"home of {robot.name} ({kind}){incomplete(robot.gap)}",
        bool(robot.gap),
    )


def _legs(robot: RobotPicture, projection: Projection) -> Iterator[tuple[int, Shape]]:
    for index, leg in enumerate(robot.legs):
        if not _is_point(leg, projection):
            tip = leg.tip(robot.name)
            yield index, Shape(f"leg {leg.kind}", projection.lines([leg.points]), tip)


def _is_point(leg: Leg, projection: Projection) -> bool:
    return len({projection.place(point) for point in leg.points}) < 2


def _stays(robot: RobotPicture, projection: Projection) -> Iterator[tuple[float, float, str]]:
    """Yield a mark for each position at which the robot stays, which names all its stays there."""
    tips: dict[Point, list[str]] = {}
    for leg in robot.legs:
        if leg.kind in STAYING and _is_point(leg, projection):
            x, y = projection.place(leg.points[0])
            tips.setdefault((round(x, 1), round(y, 1)), []).append(leg.tip(robot.name))
    yield from ((x, y, "\n".join(lines)) for (x, y), lines in tips.items())


def _heads(robot: RobotPicture, projection: Projection) -> Iterator[tuple[float, float, float]]:
    """Yield arrow heads on long stretches that show the direction of travel."""
    since = _ARROW_EVERY / 2
    for leg in robot.legs:
        for start, end in pairwise(projection.place(point) for point in leg.points):
            since += dist(start, end)
            if since >= _ARROW_EVERY and dist(start, end) > 12:
                angle = degrees(atan2(end[1] - start[1], end[0] - start[0]))
                yield (start[0] + end[0]) / 2, (start[1] + end[1]) / 2, angle
                since = 0.0
