"""Borders that bound no area as they are drawn, corrected so that no area is lost."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, dist, radians

from shapely.geometry import LinearRing, LineString, MultiPoint, Point, Polygon, box

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
