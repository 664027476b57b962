"""What the preview shows of the context elements that plug-ins add, whatever they are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite

from mmrs_core.contributions.symbols import MapSymbol, has_symbol, symbol_of, words_of
from mmrs_core.pictures.preview.picture import Details, Thing
from mmrs_core.scene import Name, Part, Point, Ring, Value

_RING = ("urn:mmrs:mission:1.0", "Ring")


@dataclass(slots=True)
class _Shapes:
    """What the attributes of one element show of where it is."""

    outlines: list[Ring] = field(default_factory=list)
    lines: list[tuple[Point, ...]] = field(default_factory=list)
    marks: list[Point] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)


def things_of(elements: Iterable[Part], symbols: Mapping[Name, MapSymbol]) -> tuple[Thing, ...]:
    """Return what elements, and what they contain, look like.

    An element is found by the shape of its attributes, whichever plug-in it comes from: a coordinate
    is a mark, coordinates called ``shell`` an outline, those called ``points`` a line, others a mark
    each; and what the symbol makes of its figures are outlines too. One that it contains has its own
    symbol, or else that of what it is in.
    """
    return tuple(
        thing
        for index, part in enumerate(elements)
        for thing in _things(part, symbol_of(part.metaclasses, symbols), symbols, f"elements[{index}]")
    )


def _things(
    part: Part, symbol: MapSymbol, symbols: Mapping[Name, MapSymbol], otherwise: str = ""
) -> Iterator[Thing]:
    """Yield an element and what it contains; `otherwise` is what one without a name is called."""
    shapes = _shapes(part)
    if symbol.outlines is not None and part.is_a(symbol.metaclass):
        shapes.outlines.extend(symbol.outlines(part))
    own = part.attributes.get("name")
    name = own if isinstance(own, str) and own else otherwise
    places = tuple(shapes.outlines), tuple(shapes.lines), tuple(shapes.marks)
    if otherwise or any(places):
        yield Thing(name, symbol, *places, details=details_of(part, symbol), inner=not otherwise)
    for inner in shapes.parts:
        known = has_symbol(inner.metaclasses, symbols)
        yield from _things(inner, symbol_of(inner.metaclasses, symbols) if known else symbol, symbols)


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
    """Return what an element's attributes say that its symbol offers, those left out that say nothing."""
    told = ((words_of(name), _told(part.attributes.get(name))) for name in symbol.fields if name != "name")
    return tuple((what, words) for what, words in told if words)


def _told(value: Value) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, tuple) and point_of(value) is None:
        return ", ".join(words for words in map(_told, value) if words)
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
