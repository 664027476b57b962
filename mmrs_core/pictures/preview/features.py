"""What the map shows of a scene: its areas, its tasks, the context elements of plug-ins, its origin."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, groupby
from math import isfinite
from types import MappingProxyType

from shapely.errors import ShapelyError

from mmrs_core.contributions.symbols import MapSymbol, has_symbol, symbol_of, words_of
from mmrs_core.diagnostics import Place
from mmrs_core.errors import PluginError
from mmrs_core.geometry.clearance import grow, shrink
from mmrs_core.geometry.polygons import parts, rings
from mmrs_core.pictures.palette import SYMBOL
from mmrs_core.pictures.preview.picture import Details, ElementPicture, MapGap, TaskPicture, Zone
from mmrs_core.scene import (
    Area,
    AreaUse,
    Frame,
    Metaclasses,
    Name,
    Part,
    Point,
    Ring,
    RobotType,
    Scene,
    Task,
    Value,
)
from mmrs_core.scene.attributes import element_called

NO_CONTEXT = MapGap("context", "there is none, so areas and obstacles are unknown")
_RING = ("urn:mmrs:mission:1.0", "Ring")


def origin_of(frame: Frame) -> str:
    """Return where the origin of the local frame lies, in words."""
    if frame.latitude is None or frame.longitude is None:
        return "local coordinates"
    return f"{frame.latitude:.6f}, {frame.longitude:.6f} ({frame.crs})"


def zones_of(areas: Iterable[Area], clearances: Mapping[str, float | None]) -> tuple[Zone, ...]:
    """Return areas as drawn, with the outline that the robot of the widest clearance keeps to.

    Where no robot's clearance is known, there is no such outline.

    Args:
        areas: as drawn.
        clearances: of each robot without the areas' safety distances, metres; None: unknown.
    """
    known = [clearance for clearance in clearances.values() if clearance is not None]
    unknown = tuple(name for name, clearance in clearances.items() if clearance is None)
    return tuple(
        _zone(area, area.safety_distance + max(known), unknown)
        if known
        else Zone(area.name, area.use, area.shell, area.low, area.high, types=area.types, unknown=unknown)
        for area in areas
    )


def _zone(area: Area, clearance: float, unknown: tuple[str, ...]) -> Zone:
    change = shrink if area.use is AreaUse.EMERGENCY else grow
    try:
        pieces = parts(change(area.shell, clearance))
    except (ValueError, ShapelyError):  # the outline crosses itself
        pieces = ()
    outlines = tuple(ring for piece in pieces for ring in (rings(piece)[0], *rings(piece)[1]))
    return Zone(
        area.name, area.use, area.shell, area.low, area.high, outlines, clearance, area.types, unknown
    )


def gap_of_clearances(zones: Iterable[Zone]) -> tuple[MapGap, ...]:
    """Return whose clearance is unknown, if areas are drawn without it."""
    listed = tuple(zones)
    robots = dict.fromkeys(chain.from_iterable(zone.unknown for zone in listed))
    grown = "only that of other robots is drawn" if any(zone.kept for zone in listed) else "none is drawn"
    return (MapGap(f"clearance of {', '.join(robots)}", f"unknown; {grown}", drawn=True),) if robots else ()


def task_pictures(
    scene: Scene,
    begins: Mapping[str, float],
    ends: Mapping[str, float],
    symbols: Mapping[Name, MapSymbol],
    gaps: Mapping[Place, str] = MappingProxyType({}),
) -> tuple[TaskPicture, ...]:
    """Return the tasks, those without a position (Fork, Join) included.

    A task's position is found by the shape of its attributes: ``shell`` and ``holes`` make an area,
    ``points`` a line, ``point`` a point, whichever plug-in the task comes from. A task that only refers to a
    context element is where that element is.

    Args:
        gaps: why elements cannot be drawn whole, by where they stand in their files.
    """
    return tuple(
        _task_picture(
            task,
            begins.get(task.name),
            ends.get(task.name),
            _symbol_of(task.part.metaclasses, symbols),
            scene.elements,
            gaps,
        )
        for task in scene.tasks
    )


def _task_picture(
    task: Task,
    begin: float | None,
    end: float | None,
    symbol: MapSymbol,
    elements: Iterable[Part],
    gaps: Mapping[Place, str],
) -> TaskPicture:
    attributes = task.part.attributes
    shell, line = attributes.get("shell"), attributes.get("points")
    outlines = (shell, *_holes(attributes.get("holes"))) if shell else ()
    rings = tuple(points for ring in outlines if not is_broken(ring) and (points := points_of(ring)))
    broken = (pieces_of(ring, closed=True) for ring in outlines if is_broken(ring))
    lines = (*chain.from_iterable(broken), *pieces_of(line))
    point, gap = point_of(attributes.get("point")), gaps.get(task.part.place, "")
    if point is None and not (rings or lines):
        point, incomplete_element = _referred(task.part, elements, gaps)
        gap = gap or incomplete_element
    return TaskPicture(
        name=task.name,
        symbol=symbol,
        rings=rings,
        lines=lines,
        point=point,
        begin=begin,
        end=end,
        details=details_of(task.part, symbol),
        gap=gap,
        model=task.part,
    )


def _referred(part: Part, elements: Iterable[Part], gaps: Mapping[Place, str]) -> tuple[Point | None, str]:
    """Return the middle of the first element, of those with a position, that another element refers to.

    And what is incomplete, if that element is.
    """
    named, known = set(_names_in(part)), tuple(elements)
    for outer in known:
        for element in _every([outer]):
            name = element.attributes.get("name")
            if name in named or element.place.path in named:
                points = _placed(element, known).points
                if points:
                    gap = f"{name or element.place.path} is incomplete" if outer.place in gaps else ""
                    return middle_of(points), gap
    return None, ""


def _names_in(part: Part) -> list[str]:
    """Return the texts of an element but its name, in order: what it refers to is among them."""
    values = [value for name, value in part.attributes.items() if name != "name"]
    listed = chain.from_iterable(value if isinstance(value, tuple) else (value,) for value in values)
    return [each for each in listed if isinstance(each, str) and each]


def _placed(part: Part, elements: Sequence[Part], depth: int = 3) -> _Shapes:
    """Return where an element is; one that only refers to others leads from the middle of one to the next."""
    shapes = _shapes(part)
    if shapes.points or shapes.parts or not depth:
        return shapes
    referred = (element_called(_every(elements), name) for name in _names_in(part))
    found = (_placed(each, elements, depth - 1).points for each in referred if each is not None)
    middles = tuple(middle_of(points) for points in found if points)
    return _Shapes(lines=[middles]) if len(middles) > 1 else _Shapes(marks=[*middles])


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


def _symbol_of(metaclasses: Metaclasses, symbols: Mapping[Name, MapSymbol]) -> MapSymbol:
    """Return the symbol of an element, with a colour."""
    symbol = symbol_of(metaclasses, symbols)
    return symbol if symbol.colour else replace(symbol, colour=SYMBOL)


def _holes(value: Value) -> Iterator[Value]:
    for hole in value if isinstance(value, tuple) else ():
        ring = hole.attributes.get("points") if isinstance(hole, Part) else hole
        if ring:
            yield ring


@dataclass(slots=True)
class _Shapes:
    """What the attributes of one element show of where it is."""

    outlines: list[Ring] = field(default_factory=list)
    lines: list[tuple[Point, ...]] = field(default_factory=list)
    marks: list[Point] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)

    @property
    def points(self) -> list[Point]:
        """Return all points, without those of contained elements."""
        return [*self.marks, *chain(*self.outlines, *self.lines)]


def elements_of(
    elements: Iterable[Part],
    symbols: Mapping[Name, MapSymbol],
    gaps: Mapping[Place, str] = MappingProxyType({}),
) -> tuple[ElementPicture, ...]:
    """Return what elements, and what they contain, look like.

    An element is found by the shape of its attributes, whichever plug-in it comes from: a coordinate
    is a mark, coordinates called ``shell`` an outline, those called ``points`` a line, others a mark
    each; and what the symbol makes of its figures are outlines too. One that it contains has its own
    symbol, or else that of what it is in. One without coordinates that refers to other elements is a
    line from the middle of one to the middle of the next.

    Args:
        gaps: why elements cannot be drawn whole, by where they stand in their files.
    """
    known = tuple(elements)
    return tuple(
        element
        for index, part in enumerate(known)
        for element in _elements(
            part,
            _placed(part, known),
            _symbol_of(part.metaclasses, symbols),
            symbols,
            gaps.get(part.place, ""),
            f"elements[{index}]",
        )
    )


def _elements(
    part: Part,
    shapes: _Shapes,
    symbol: MapSymbol,
    symbols: Mapping[Name, MapSymbol],
    gap: str,
    otherwise: str = "",
) -> Iterator[ElementPicture]:
    """Yield an element and what it contains; `otherwise` is what one without a name is called."""
    shapes.outlines.extend(_figures(part, symbol, gap))
    own = part.attributes.get("name")
    name = own if isinstance(own, str) and own else otherwise
    places = tuple(shapes.outlines), tuple(shapes.lines), tuple(shapes.marks)
    if otherwise or any(places):
        details = details_of(part, symbol)
        yield ElementPicture(name, symbol, *places, details, inner=not otherwise, gap=gap, model=part)
    for inner in shapes.parts:
        known = has_symbol(inner.metaclasses, symbols)
        own_symbol = _symbol_of(inner.metaclasses, symbols) if known else symbol
        yield from _elements(inner, _shapes(inner), own_symbol, symbols, gap)


def _shapes(part: Part) -> _Shapes:
    shapes = _Shapes()
    for name, value in part.attributes.items():
        point = point_of(value)
        if point is not None:
            shapes.marks.append(point)
        elif isinstance(value, Part):
            _add_part(shapes, value)
        elif isinstance(value, tuple):
            _add_points(shapes, name, value)
            for each in value:
                if isinstance(each, Part):
                    _add_part(shapes, each)
    return shapes


def _figures(part: Part, symbol: MapSymbol, gap: str) -> tuple[Ring, ...]:
    """Return the outlines that an element's figures make; of an incomplete one, as far as these allow.

    Raises:
        PluginError: if the symbol's plug-in fails on an element that is complete.
    """
    if symbol.outlines is None or not part.is_a(symbol.metaclass):
        return ()
    try:
        outlines = symbol.outlines(part)
    except PluginError:
        if gap:
            return ()
        raise
    return tuple(ring for ring in outlines if all(isfinite(east + north) for east, north in ring))


def _add_part(shapes: _Shapes, part: Part) -> None:
    if part.is_a(_RING):
        _add_points(shapes, "shell", part.attributes.get("points"))
    else:
        shapes.parts.append(part)


def _add_points(shapes: _Shapes, name: str, value: Value) -> None:
    points = points_of(value)
    if is_broken(value) and name in ("shell", "points"):
        shapes.lines.extend(pieces_of(value, closed=name == "shell"))
    elif name == "shell" and len(points) > 2:
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


def is_broken(value: Value) -> bool:
    """Return whether some of the positions of a value are unknown: not numbers."""
    return isinstance(value, tuple) and any(
        isinstance(each, tuple) and len(each) == 3 and each[0] != each[0] for each in value
    )


def pieces_of(value: Value, *, closed: bool = False) -> tuple[tuple[Point, ...], ...]:
    """Return the stretches of a line, or of a closed outline, between its unknown positions.

    >>> from math import nan
    >>> pieces_of(((0.0, 0.0, 0.0), (9.0, 0.0, 0.0), (nan, nan, nan), (0.0, 9.0, 0.0)), closed=True)
    (((0.0, 9.0), (0.0, 0.0), (9.0, 0.0)),)
    """
    points = [point_of(each) for each in value] if isinstance(value, tuple) else []
    if closed and None in points:
        begin = points.index(None)
        points = points[begin:] + points[:begin]
    runs = groupby(points, lambda point: point is not None)
    return tuple(tuple(point for point in run if point is not None) for known, run in runs if known)


def point_of(value: Value) -> Point | None:
    """Return (east, north) of a position; None for anything else."""
    if not isinstance(value, tuple) or len(value) != 3:
        return None
    east, north = value[0], value[1]
    if isinstance(east, float | int) and isinstance(north, float | int) and isfinite(east + north):
        return float(east), float(north)
    return None
