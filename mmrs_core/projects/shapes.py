"""The positions of features as models hold them: cleaned, simplified, or around points and lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi

import numpy as np
import shapely
from numpy.typing import NDArray

from mmrs_core.drawings.drawing import Geometry, HeightReference, MapFeature
from mmrs_core.geometry.frames import LocalFrame
from mmrs_core.languages.modelset import MOST_PARTS

Floats = NDArray[np.float64]

WGS84 = "EPSG:4326"
DECIMALS = 8
"""Decimals of degrees in models: a millimetre."""
_QUARTER = 4
"""Segments of a quarter of a circle."""
_LARGEST_RADIUS = 100_000.0
_LEAST = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}


class UnfitError(ValueError):
    """A feature that cannot be imported as it is; the message begins after its name."""


@dataclass(frozen=True, slots=True)
class DrawnShape:
    """The positions of a feature.

    Attributes:
        geometry: what they are.
        rings: latitudes and longitudes in degrees, as in `MapFeature`.
        heights: of the first ring, in metres above `reference`; None where it has none.
        notes: what was changed.
    """

    geometry: Geometry
    rings: tuple[Floats, ...]
    heights: Floats | None
    reference: HeightReference
    notes: tuple[str, ...] = ()


def shape(
    feature: MapFeature, geometry: Geometry, tolerance: float | None, *, covering: bool = False
) -> DrawnShape:
    """Return the positions of a feature as that geometry: its own, or the circle of a point with a radius.

    Args:
        tolerance: metres by which a simplified border may be off; None: it is not simplified.
        covering: whether a simplified area must hold all of what was drawn.

    Raises:
        UnfitError: if a position is not on the Earth, too few are left, or there are too many.
    """
    for ring in feature.rings:
        off = ~(np.isfinite(ring).all(axis=1) & (np.abs(ring) <= (90.0, 180.0)).all(axis=1))
        if off.any():
            latitude, longitude = ring[int(np.flatnonzero(off)[0])]
            raise UnfitError(f"latitude {latitude:g}, longitude {longitude:g} is not on the Earth")
    if geometry is Geometry.AREA and feature.radius:
        ring = around(feature, feature.radius, covering=False)
        return DrawnShape(
            geometry,
            (ring,),
            feature.heights[0].max().repeat(len(ring)) if feature.heights else None,
            feature.reference,
        )
    rings, kept, notes = [], [], []
    for number, ring in enumerate(feature.rings):
        indices = _distinct(ring, closed=geometry is Geometry.AREA)
        if len(indices) < len(ring):
            notes.append(f"{len(ring) - len(indices)} repeated positions removed")
        if tolerance is not None and len(indices) > _LEAST[geometry]:
            before = len(indices)
            indices = indices[_simplified(ring[indices], geometry, tolerance)]
            if len(indices) < before:
                notes.append(f"simplified from {before} to {len(indices)} positions")
        if len(indices) < _LEAST[geometry]:
            if number == 0:
                raise UnfitError(
                    f"{len(indices)} different positions; {geometry.value}s have {_LEAST[geometry]} or more"
                )
            notes.append("a hole without extent removed")
            continue
        if len(indices) > MOST_PARTS:
            advice = "--simplify METRES leaves out what hardly matters"
            raise UnfitError(f"{len(indices)} positions, more than {MOST_PARTS}: {advice}")
        rings.append(ring[indices])
        kept.append(indices)
    heights = feature.heights[0][kept[0]] if feature.heights else None
    if covering and tolerance and geometry is Geometry.AREA and len(kept[0]) < len(feature.rings[0]):
        rings[0] = _grown(rings[0], tolerance)
        heights = None if heights is None else heights.max().repeat(len(rings[0]))
        notes.append(f"then grown by {tolerance:g} m, so that it holds all that was drawn")
    return DrawnShape(geometry, tuple(rings), heights, feature.reference, tuple(notes))


def around(feature: MapFeature, radius: float, *, covering: bool) -> Floats:
    """Return the border of what is within a radius of a point or line.

    Args:
        covering: whether the border lies outside of the circle, or inside.

    Raises:
        UnfitError: if the radius is out of range.
    """
    if not 0.0 < radius < _LARGEST_RADIUS:
        raise UnfitError(f"radius {radius:g} m: expected one above 0 and below {_LARGEST_RADIUS:g} m")
    frame = LocalFrame(WGS84, *map(float, feature.rings[0][0]))
    local = frame.to_local(*feature.rings[0].T)
    centre = shapely.Point(local[0]) if len(local) == 1 else shapely.LineString(local)
    reach = radius / cos(pi / (4 * _QUARTER)) if covering else radius
    outside = shapely.get_exterior_ring(shapely.buffer(centre, reach, quad_segs=_QUARTER))
    return frame.to_geographic(shapely.get_coordinates(outside)[:-1])


def _grown(ring: Floats, metres: float) -> Floats:
    frame = LocalFrame(WGS84, *map(float, ring[0]))
    grown = shapely.buffer(shapely.Polygon(frame.to_local(*ring.T)), metres, join_style="mitre")
    return frame.to_geographic(shapely.get_coordinates(shapely.get_exterior_ring(grown))[:-1])


def begin_of(ring: Floats, home: Floats | None, closed: Sequence[Floats]) -> int:
    """Return the vertex at which a robot begins an area: the nearest to its home, clear of closed areas."""
    frame = LocalFrame(WGS84, *map(float, ring[0]))
    points = shapely.points(frame.to_local(*ring.T))
    begin = shapely.Point(frame.to_local(*(ring[0] if home is None else home))[0])
    distances = np.atleast_1d(shapely.distance(points, begin))
    for each in closed:
        keep = shapely.buffer(shapely.Polygon(frame.to_local(*each.T)), _CLEAR)
        distances[shapely.intersects(keep, points)] += 1e9
    return int(np.argmin(distances))


_CLEAR = 10.0
"""Metres from closed areas at which no robot is too large to begin."""


def _distinct(ring: Floats, *, closed: bool) -> NDArray[np.int64]:
    """Return which positions differ from the one before them."""
    rounded = np.round(ring, DECIMALS)
    same = (rounded[1:] == rounded[:-1]).all(axis=1)
    indices = np.flatnonzero(np.concatenate(([True], ~same)))
    if closed and len(indices) > 1 and (rounded[indices[-1]] == rounded[0]).all():
        indices = indices[:-1]
    return indices


def _simplified(ring: Floats, geometry: Geometry, tolerance: float) -> list[int]:
    local = LocalFrame(WGS84, *map(float, ring[0])).to_local(*ring.T)
    made = shapely.Polygon(local) if geometry is Geometry.AREA else shapely.LineString(local)
    left = shapely.get_coordinates(shapely.simplify(made, tolerance, preserve_topology=True))
    wanted = set(map(tuple, left))
    return [index for index, point in enumerate(map(tuple, local)) if point in wanted]
