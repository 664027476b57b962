"""What the map shows of a scene: its areas, its tasks, the context elements of plug-ins, its origin."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from math import isfinite

from shapely.errors import ShapelyError

from mmrs_core.contributions.symbols import MapSymbol, has_symbol, symbol_of, words_of
from mmrs_core.geometry.clearance import grow, shrink
from mmrs_core.geometry.polygons import parts, rings
from mmrs_core.pictures.preview.picture import Details, ElementPicture, TaskPicture, Zone
from mmrs_core.scene import Area, AreaUse, Frame, Name, Part, Point, Ring, RobotType, Scene, Task, Value

_RING = ("urn:mmrs:mission:1.0", "Ring")


def origin_of(frame: Frame) -> str:
    """Return where the origin of the local frame lies, in words."""
    if frame.latitude is None or frame.longitude is None:
        return "local coordinates"
    return f"{frame.latitude:.6f}, {frame.longitude:.6f} ({frame.crs})"


def zones_of(areas: Iterable[Area], clearances: Iterable[float]) -> tuple[Zone, ...]:
    """Return areas as drawn, with the outline that the robot of the widest clearance keeps to.

    Args:
        areas: as drawn.
        clearances: of each robot without the areas' safety distances, metres.
    """
    widest = max(clearances, default=0.0)
    return tuple(_zone(area, area.safety_distance + widest) for area in areas)


def _zone(area: Area, clearance: float) -> Zone:
    change = shrink if area.use is AreaUse.EMERGENCY else grow
    try:
        pieces = parts(change(area.shell, clearance))
    except (ValueError, ShapelyError):  # the outline crosses itself
        pieces = ()
    outlines = tuple(ring for piece in pieces for ring in (rings(piece)[0], *rings(piece)[1]))
    return Zone(area.name, area.use, area.shell, area.low, area.high, outlines, clearance, area.types)


def task_pictures(
    scene: Scene,
    begins: Mapping[str, float],
    ends: Mapping[str, float],
    symbols: Mapping[Name, MapSymbol],
) -> tuple[TaskPicture, ...]:
    """Return the tasks, those without a position (Fork, Join) included.

    A task's position is found by the shape of its attributes: ``shell`` and ``holes`` make an area,
    ``points`` a line, ``point`` a point, whichever plug-in the task comes from. A task that only refers to a
    context element is where that element is.
    """
    return tuple(
        _task_picture(
            task,
            begins.get(task.name),
            ends.get(task.name),
            symbol_of(task.part.metaclasses, symbols),
            scene.elements,
        )
        for task in scene.tasks
    )


def _task_picture(
    task: Task, begin: float | None, end: float | None, symbol: MapSymbol, elements: Iterable[Part]
) -> TaskPicture:
    attributes = task.part.attributes
    shell, line = points_of(attributes.get("shell")), points_of(attributes.get("points"))
    return TaskPicture(
        name=task.name,
        symbol=symbol,
        rings=(shell, *_holes(attributes.get("holes"))) if shell else (),
        line=line,
        point=point_of(attributes.get("point"))
        or (None if shell or line else _referred(task.part, elements)),
        begin=begin,
        end=end,
        details=details_of(task.part, symbol),
    )


def _referred(part: Part, elements: Iterable[Part]) -> Point | None:
    """Return the middle of the first element, of those with a position, that another element refers to."""
    values = [value for name, value in part.attributes.items() if name != "name"]
    listed = chain.from_iterable(value if isinstance(value, tuple) else (value,) for value in values)
    named = {each for each in listed if isinstance(each, str) and each}
    for element in _every(elements):
        if element.attributes.get("name") in named or element.place.path in named:
            shapes = _shapes(element)
            points = [*shapes.marks, *chain(*shapes.outlines, *shapes.lines)]
            if points:
                return middle_of(points)
    return None


def _every(elements: Iterable[Part]) -> Iterator[Part]:
    """Yield elements with all that they contain."""
    for element in elements:
        yield element
        yield from _every(_shapes(element).parts)


def middle_of(points: Sequence[Point]) -> Point:
    """Return the mean of points."""
    return sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points)


def symbol_of_robot(robot_type: RobotType, symbols: Mapping[Name, MapSymbol]) -> MapSymbol | None:
    """Return the symbol of a robot's type, else that of how it moves; None where neither has one."""
    for metaclasses in (robot_type.metaclasses, robot_type.capability_metaclasses):
        if has_symbol(metaclasses, symbols):
            return symbol_of(metaclasses, symbols)
    return None


def _holes(value: Value) -> Iterator[Ring]:
    for hole in value if isinstance(value, tuple) else ():
        ring = points_of(hole.attributes.get("points") if isinstance(hole, Part) else hole)
        if ring:
            yield ring


@dataclass(slots=True)
class _Shapes:
    """What the attributes of one element show of where it is."""

    outlines: list[Ring] = field(default_factory=list)
    lines: list[tuple[Point, ...]] = field(default_factory=list)
    marks: list[Point] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)


def elements_of(elements: Iterable[Part], symbols: Mapping[Name, MapSymbol]) -> tuple[ElementPicture, ...]:
    """Return what elements, and what they contain, look like.

    An element is found by the shape of its attributes, whichever plug-in it comes from: a coordinate
    is a mark, coordinates called ``shell`` an outline, those called ``points`` a line, others a mark
    each; and what the symbol makes of its figures are outlines too. One that it contains has its own
    symbol, or else that of what it is in.
    """
    return tuple(
        element
        for index, part in enumerate(elements)
        for element in _elements(part, symbol_of(part.metaclasses, symbols), symbols, f"elements[{index}]")
    )


def _elements(
    part: Part, symbol: MapSymbol, symbols: Mapping[Name, MapSymbol], otherwise: str = ""
) -> Iterator[ElementPicture]:
    """Yield an element and what it contains; `otherwise` is what one without a name is called."""
    shapes = _shapes(part)
    if symbol.outlines is not None and part.is_a(symbol.metaclass):
        shapes.outlines.extend(symbol.outlines(part))
    own = part.attributes.get("name")
    name = own if isinstance(own, str) and own else otherwise
    places = tuple(shapes.outlines), tuple(shapes.lines), tuple(shapes.marks)
    if otherwise or any(places):
        yield ElementPicture(name, symbol, *places, details=details_of(part, symbol), inner=not otherwise)
    for inner in shapes.parts:
        known = has_symbol(inner.metaclasses, symbols)
        yield from _elements(inner, symbol_of(inner.metaclasses, symbols) if known else symbol, symbols)


def _shapes(part: Part) -> _Shapes:
    shapes = _Shapes()
    for name, value in part.attributes.items():
        point = point_of(value)
        if point is not None:
            shapes.marks.append(point)
        elif isinstance(value, Part):
            _add_part(shapes, value)
        elif isinstance(value, tuple):
            _add_points(shapes, name, points_of(value))
            for each in value:
                if isinstance(each, Part):
                    _add_part(shapes, each)
    return shapes


def _add_part(shapes: _Shapes, part: Part) -> None:
    if part.is_a(_RING):
        shapes.outlines.append(points_of(part.attributes.get("points")))
    else:
        shapes.parts.append(part)


def _add_points(shapes: _Shapes, name: str, points: tuple[Point, ...]) -> None:
    if name == "shell" and len(points) > 2:
        shapes.outlines.append(points)
    elif name in ("shell", "points") and len(points) > 1:
        shapes.lines.append(points)
    else:
        shapes.marks.extend(points)


def details_of(part: Part, symbol: MapSymbol) -> Details:
    """Return the values of the attributes that an element's symbol names, empty ones left out."""
    shown = ((words_of(name), _words(part.attributes.get(name))) for name in symbol.fields if name != "name")
    return tuple((what, words) for what, words in shown if words)


def _words(value: Value) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, tuple) and point_of(value) is None:
        return ", ".join(words for words in map(_words, value) if words)
    return str(value) if isinstance(value, int | str) else ""


def points_of(value: Value) -> tuple[Point, ...]:
    """Return (east, north) of the positions among the items of a value."""
    found = tuple(point_of(item) for item in value) if isinstance(value, tuple) else ()
    return tuple(point for point in found if point is not None)


def point_of(value: Value) -> Point | None:
    """Return (east, north) of a position; None for anything else."""
    if not isinstance(value, tuple) or len(value) != 3:
        return None
    east, north = value[0], value[1]
    if isinstance(east, float | int) and isinstance(north, float | int) and isfinite(east + north):
        return float(east), float(north)
    return None
