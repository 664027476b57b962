"""Borders as they were drawn: vertices that repeat, and borders that hold no area."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, dist, radians

from shapely.geometry import LinearRing, LineString, MultiPoint, Point, Polygon, box

from mmrs_core.grounding.features import number
from mmrs_core.languages.element import Element, metaclass_of
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.building.drafts import placed
from mmrs_flyaq.findings import Category, Record
from mmrs_flyaq.sources.nodes import SourceNode, Text

METRES_PER_DEGREE = 111_320.0
"""Metres per degree of latitude on a sphere; good to half a per cent, which a widening does not notice."""
THINNEST = 0.01
"""Metres that a border is wide on average, at least, to hold an area."""
_NARROWEST = 1e-6
"""The least cosine of a latitude: beside a pole, a metre is any number of degrees of longitude."""

Corner = tuple[float, float]
"""Latitude and longitude in degrees."""


@dataclass(frozen=True, slots=True)
class Mended:
    """A border that holds every corner of one that bounded no area.

    Attributes:
        corners: of the new border, which is convex.
        reason: what was wrong with the old one, and what the new one is.
    """

    corners: tuple[Corner, ...]
    reason: str


def border_of(corners: tuple[Corner, ...], metres: float) -> Mended | None:
    """Return a border around all corners of one that bounds no area; None if it bounds one.

    One that crosses or touches itself becomes the hull of its corners. Of one without an area, even in its
    hull, that hull is a point or a line, and the new border is drawn around it.

    Args:
        corners: at least one.
        metres: how far from the hull the new border runs.
    """
    south, west = corners[0]
    scale = METRES_PER_DEGREE * max(cos(radians(south)), _NARROWEST)
    flat = [((east - west) * scale, (north - south) * METRES_PER_DEGREE) for north, east in corners]
    hull = MultiPoint(flat).convex_hull
    if hull.area > THINNEST * hull.length / 2:
        return _of_wide(corners, flat)
    wide = _around(flat, metres)
    degrees = [(west + x / scale, south + y / METRES_PER_DEGREE) for x, y in wide.exterior.coords]
    on_earth = Polygon(degrees).intersection(box(-180.0, -90.0, 180.0, 90.0))
    reason = f"the border holds no area, so one is drawn {metres:g} m around its vertices"
    return Mended(_ring(on_earth), reason)


def _around(flat: list[tuple[float, float]], metres: float) -> Polygon:
    """Return a rectangle around points that lie on a line, or nearly so."""
    one = max(flat, key=lambda place: dist(place, flat[0]))
    other = max(flat, key=lambda place: dist(place, one))
    line = LineString([one, other]) if dist(one, other) > THINNEST else Point(one)
    aside = max(line.distance(Point(place)) for place in flat)
    return line.buffer(metres + aside, cap_style="square")


def _of_wide(corners: tuple[Corner, ...], flat: list[tuple[float, float]]) -> Mended | None:
    """Return a border whose hull holds an area, corrected if it crosses itself or leaves that area again."""
    drawn = Polygon(flat)
    if LinearRing(flat).is_simple and drawn.area > THINNEST * drawn.length / 2:
        return None
    hull = MultiPoint([(east, north) for north, east in corners]).convex_hull
    reason = "the border crosses or touches itself, so the hull of its vertices is taken, which holds more"
    return Mended(_ring(hull), reason)


def _ring(polygon: object) -> tuple[Corner, ...]:
    assert isinstance(polygon, Polygon)  # a hull with an area, or what is drawn around one without
    return tuple((north, east) for east, north in polygon.exterior.coords[:-1])


def without_repeats(vertices: Sequence[SourceNode], record: Record) -> tuple[SourceNode, ...]:
    """Return vertices without those that equal the one before; the first follows the last."""
    kept: list[SourceNode] = []
    left_out: list[SourceNode] = []
    for vertex in vertices:
        repeats = bool(kept) and _values(vertex) == _values(kept[-1])
        (left_out if repeats else kept).append(vertex)
    if len(kept) > 1 and _values(kept[0]) == _values(kept[-1]):
        left_out.append(kept.pop())
    for vertex in left_out:
        record.item(Category.CHANGED, "repeats the vertex beside it, so it is left out", vertex)
    return tuple(kept)


def _values(vertex: SourceNode) -> tuple[str, dict[str, tuple[str, ...]]]:
    return vertex.kind, {feature: vertex.texts(feature) for feature in vertex.values}


def _place(vertex: Element) -> Corner | None:
    """Return latitude and longitude in degrees; None where they are missing or not on the Earth."""
    north, east = number(vertex, "latitude"), number(vertex, "longitude")
    if north is None or east is None or not (abs(north) <= 90 and abs(east) <= 180):
        return None
    return north, east


def border_around(
    node: SourceNode,
    feature: str,
    vertices: Sequence[Element],
    metres: float,
    registry: Registry,
    record: Record,
) -> Sequence[Element]:
    """Return the vertices of a border; for one that bounds no area, those of a border that holds them all.

    A border with a vertex that has no place on the Earth stays as it is.
    """
    known = tuple(place for each in vertices if (place := _place(each)) is not None)
    mended = border_of(known, metres) if known and len(known) == len(vertices) else None
    if mended is None:
        return vertices
    key = metaclass_of(vertices[0]).key
    places = ", ".join(f"({north!r}, {east!r})" for north, east in known)
    record.value(Category.DOUBTFUL, f"{mended.reason}: draw it again", node, feature, Text(places, node.line))
    return [
        placed(registry.create(*key, latitude=north, longitude=east), node) for north, east in mended.corners
    ]
