"""Strokes along polylines: parallel passes over a corridor, actions at even distances, places to split."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate, pairwise
from math import ceil, dist, floor
from typing import TypeVar

import numpy as np
import shapely

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.limits import MOST
from mmrs_core.scene import Point, Position

_Place = TypeVar("_Place", Point, Position)

LONGEST_SHARE = 50.0
"""Metres after which a line without actions may be split."""

MOST_PASSES = 1_000
"""Passes at most beside each other."""

LEFT_OUT = 1e-3
"""Share of a corridor that passes may leave out."""

_DENSE, _OFF = 5.0, 0.1
"""Metres along a line, and off it, below which a point only makes robots slow; freehand lines have many."""


def at_altitude(points: Sequence[Position], up: float | None) -> tuple[Position, ...]:
    """Return points at one height, or at their own where none is given."""
    return tuple(points) if up is None else tuple((east, north, up) for east, north, _ in points)


def without_dense(points: Sequence[_Place]) -> list[_Place]:
    """Return the polyline with fewer points, as drawn but for 0.1 m.

    Only legs of up to 5 m are made of several; points that repeat the one before are left out.

    >>> without_dense([(0.1 * step, 0.0, 0.0) for step in range(101)])
    [(0.0, 0.0, 0.0), (5.0, 0.0, 0.0), (10.0, 0.0, 0.0)]
    """
    distinct = list(points[:1])
    distinct += [b for a, b in pairwise(points) if dist(a, b) > 1e-6]
    kept, last = distinct[:1], 0
    for end in range(2, len(distinct)):
        leg = kept[-1], distinct[end]
        if dist(*leg) > _DENSE or off_leg(leg, distinct[last + 1 : end]) > _OFF:
            last = end - 1
            kept.append(distinct[last])
    return kept + distinct[1:][-1:]


def off_leg(leg: tuple[_Place, _Place], points: Sequence[_Place]) -> float:
    """Return the largest distance of points from a leg, metres."""
    along, there = np.subtract(leg[1], leg[0]), np.subtract(points, leg[0])
    shares = np.clip(there @ along / max(along @ along, 1e-12), 0.0, 1.0)
    return float(np.linalg.norm(there - shares[:, None] * along, axis=1).max())


def length_of(points: Sequence[Position]) -> float:
    """Return the length of a polyline, metres."""
    return sum(dist(a, b) for a, b in pairwise(points))


def even_distances(length: float, spacing: float) -> tuple[float, ...]:
    """Return arc lengths from 0 to the end, `spacing` apart; only the last two may be nearer.

    Raises:
        InfeasibleError: these are too many to be planned.

    >>> even_distances(25.0, 10.0)
    (0.0, 10.0, 20.0, 25.0)
    """
    if length > MOST * spacing:
        wanted = length / spacing
        raise InfeasibleError(
            f"takes about {wanted:,.0f} photos or samples, of which {MOST:,} can be planned"
        )
    whole = floor(length / spacing + 1e-9)
    at = [index * spacing for index in range(whole + 1)]
    return (*at, length) if length - at[-1] > 1e-6 else (*at[:-1], length)


def cuts_between(points: Sequence[Position], actions: Sequence[float]) -> tuple[float, ...]:
    """Return where a stroke may be split: midway between actions, or else at its corners and evenly."""
    if actions:
        return tuple((a + b) / 2 for a, b in pairwise(actions))
    corners = list(accumulate(dist(a, b) for a, b in pairwise(points)))
    return tuple(
        begin + (end - begin) * part / parts
        for begin, end in pairwise((0.0, *corners))
        for parts in (max(1, ceil((end - begin) / LONGEST_SHARE)),)
        for part in range(1, parts + 1)
    )[:-1]


def lines_over(
    line: tuple[Position, ...], width: float | None, strip: float | None
) -> tuple[tuple[Position, ...], ...]:
    """Return the passes over a road, as `passes`; the line alone where one strip is as wide as the road."""
    if len(line) == 1 or strip is None or (width or 0.0) <= strip:
        return (line,)
    return passes(line, width or 0.0, strip)


def passes(points: Sequence[Position], width: float, strip: float) -> tuple[tuple[Position, ...], ...]:
    """Return polylines to and fro, side by side, from which strips cover a corridor.

    The first leads the way the line does. A pass covers all that is within half a strip of it; where
    the line bends, that is while the robot turns.

    Args:
        points: the middle of the corridor, at least two.
        width: of the corridor, metres. strip: what is seen across a pass, metres.

    Raises:
        InfeasibleError: the line bends too sharply for so wide a corridor, or takes too many passes.
    """
    if width > MOST_PASSES * strip:
        raise InfeasibleError(
            f"takes about {width / strip:,.0f} passes, of which {MOST_PASSES:,} can be planned"
        )
    count = max(1, ceil(width / strip - 1e-9))
    middle = shapely.LineString(points)
    offsets = [(index + 0.5) * width / count - width / 2 for index in range(count)]
    lines = [line for offset in offsets for line in _beside(middle, offset)]
    corridor = shapely.buffer(shapely.force_2d(middle), width / 2, cap_style="flat")
    seen = shapely.union_all([shapely.buffer(shapely.LineString(line), strip / 2) for line in lines])
    if shapely.difference(corridor, seen).area > LEFT_OUT * corridor.area:
        raise InfeasibleError(f"the line bends too sharply for passes over a width of {width:g} m")
    return tuple(line[::-1] if index % 2 else line for index, line in enumerate(lines))


def _beside(middle: shapely.LineString, offset: float) -> Iterator[tuple[Position, ...]]:
    if abs(offset) < 1e-9:
        yield tuple(_position(middle, east, north) for east, north, *_ in middle.coords)
        return
    curve = shapely.offset_curve(shapely.force_2d(middle), offset, join_style="mitre")
    for part in shapely.get_parts(curve):
        if shapely.is_empty(part):  # inside of a hairpin
            continue
        yield tuple(_position(middle, east, north) for east, north in part.coords)


def _position(middle: shapely.LineString, east: float, north: float) -> Position:
    nearest = shapely.line_interpolate_point(middle, _arc(middle, east, north))
    return (float(east), float(north), float(nearest.z) if nearest.has_z else 0.0)


def _arc(middle: shapely.LineString, east: float, north: float) -> float:
    return float(shapely.line_locate_point(middle, shapely.Point(east, north)))
