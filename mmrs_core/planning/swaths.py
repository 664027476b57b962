"""Swaths over polygons: the sweep direction, the lines themselves, and the check that they cover.

The fewer lines, the fewer turns: so directions are judged by how wide the polygons are across them (Huang,
2001), which is had for all directions at once by the formula of Cauchy and Crofton (Santaló, 1976).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, pi, sin
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.geometry.polygons import parts
from mmrs_core.planning.footprints import needed, uncovered_by
from mmrs_core.planning.lines import Swath
from mmrs_core.planning.strips import swaths_along_x
from mmrs_core.planning.tours import hop_length, tour

Floats: TypeAlias = NDArray[np.float64]

_ANGLES = 8
_SHIFTED = 3
_SHIFTS = (0.0, 0.5, 1.0)
_REPAIRS = 4
_LEFT_OUT = 1e-7
"""Share of the target that swaths may leave out: rounding."""


@dataclass(frozen=True, slots=True)
class _Reach:
    """What swaths cover across and along, where they may not go, and whether their direction counts."""

    width: float
    length: float
    closed: BaseGeometry
    strict: bool


def swaths(
    target: Sequence[Polygon],
    width: float,
    *,
    length: float = 0.0,
    closed: BaseGeometry | None = None,
    angle: float | None = None,
    strict: bool = False,
    start: tuple[float, float] | None = None,
) -> list[Swath]:
    """Return swaths in a good order whose footprints cover the target.

    The footprint of a swath is the union, over its legs, of rectangles as long as the leg and `width`
    wide; with a `length`, the union, over its spots, of rectangles `length` along and `width` across
    the leg. The sweep direction is the best of promising ones, by the metres of swaths and hops and
    the numbers of turns and actions.

    Args:
        target: polygons that do not overlap; concave ones and holes are welcome.
        width: metres, positive.
        length: of what an action covers along the swath, metres; 0: the swath itself covers.
        closed: where swaths may not go, its edge excepted; None: nowhere. Anywhere else they may.
        angle: direction of the swaths, radians from east to north; None: the best.
        strict: whether only what is covered in that direction counts, wherever the swaths can have it.
        start: where the first swath should be near; None: anywhere.

    Raises:
        ValueError: the width is not positive.
    """
    if not width > 0:
        raise ValueError(f"swath width {width} is not positive")
    pieces = [piece for piece in target if piece.area > 0.0]
    if not pieces:
        return []
    reach = _Reach(width, length, _near(closed, pieces, width), strict)
    angles = [angle] if angle is not None else sweep_angles(pieces)
    lines = _repaired(pieces, _best_sweep(pieces, reach, angles, start), reach, angle)
    if not lines:
        place = pieces[0].representative_point()
        return [Swath(np.array([[place.x, place.y]]))]
    if length > 0.0:
        lines = needed(pieces, lines, width, length, angle if strict else None)
    begins, ends = _ends(lines)
    return [lines[i].reversed() if back else lines[i] for i, back in tour(begins, ends, start)]


def _best_sweep(
    pieces: Sequence[Polygon], reach: _Reach, angles: Sequence[float], start: tuple[float, float] | None
) -> list[Swath]:
    """Return the best sweep at all angles, with strips shifted at the best angles."""
    sweeps = [(_sweep(pieces, reach, angle), angle) for angle in angles]
    sweeps.sort(key=lambda each: _cost(each[0], reach, start))
    shifted = [_sweep(pieces, reach, angle, shift) for _, angle in sweeps[:_SHIFTED] for shift in _SHIFTS]
    return min([sweeps[0][0], *shifted], key=lambda lines: _cost(lines, reach, start))


def sweep_angles(pieces: Sequence[Polygon]) -> list[float]:
    """Return the most promising directions, radians in [0, pi), best first.

    The number of swaths at a direction u is about half the sum of |edge x u| over the width
    (Cauchy-Crofton); as a function of the direction it is concave between the directions of edges.
    """
    edges, directions = _edges(pieces)
    best = directions[np.argsort(_across(directions, edges), kind="stable")][: _ANGLES - 2].tolist()
    return list(dict.fromkeys([*best, 0.0, pi / 2]))


def hatch_angle(pieces: Sequence[Polygon]) -> float:
    """Return the direction, radians in [0, pi), at which swaths along and across it are fewest in all."""
    edges, along = _edges(pieces)
    directions = np.sort(np.concatenate([along, (along + pi / 2.0) % pi]))
    both = _across(directions, edges) + _across((directions + pi / 2.0) % pi, edges)
    return float(directions[int(np.argmin(np.round(both, 6)))])


def _edges(pieces: Sequence[Polygon]) -> tuple[Floats, Floats]:
    """Return (n, 2) edges of pieces with their holes, and their directions, each once."""
    rings = [ring for piece in pieces for ring in (piece.exterior, *piece.interiors)]
    edges = np.concatenate([np.diff(shapely.get_coordinates(ring), axis=0) for ring in rings])
    return edges, np.unique(np.round(np.arctan2(edges[:, 1], edges[:, 0]) % pi, 6) % pi)


def _across(directions: Floats, edges: Floats) -> Floats:
    """Return for each direction how far the edges reach across it, in all; n log n in both numbers.

    Edges are turned to point to their left in [0, pi). Those behind a direction reach across it on one
    side, those before it on the other: sums up to each edge, in the order of their own directions, tell.
    """
    own = np.arctan2(edges[:, 1], edges[:, 0])
    upright = np.where(((own < 0.0) | (own >= pi))[:, None], -edges, edges)
    order = np.argsort(own % pi, kind="stable")
    sums = np.vstack([np.zeros(2), np.cumsum(upright[order], axis=0)])
    before = np.searchsorted((own % pi)[order], directions)
    east, north = (sums[-1] - 2.0 * sums[before]).T
    across: Floats = north * np.cos(directions) - east * np.sin(directions)
    return across


def _near(closed: BaseGeometry | None, pieces: Sequence[Polygon], width: float) -> BaseGeometry:
    """Return what is closed about the pieces."""
    if closed is None:
        return Polygon()
    left, bottom, right, top = shapely.total_bounds(pieces).tolist()
    about = shapely.box(left - width, bottom - width, right + width, top + width)
    near: BaseGeometry = shapely.intersection(closed, about)
    return near


def _sweep(pieces: Sequence[Polygon], reach: _Reach, angle: float, shift: float | None = None) -> list[Swath]:
    turned = [_turned(piece, angle) for piece in pieces]
    closed = _turned(reach.closed, angle)
    back = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
    lines = swaths_along_x(
        turned, reach.width, length=reach.length, closed=closed, shift=shift, facing=reach.strict
    )
    return [replace(line, points=line.points @ back) for line in lines]


def _turned(shape: BaseGeometry, angle: float) -> BaseGeometry:
    return affinity.rotate(shape, -angle, origin=(0.0, 0.0), use_radians=True)


def _ends(lines: Sequence[Swath]) -> tuple[Floats, Floats]:
    return np.array([line.points[0] for line in lines]), np.array([line.points[-1] for line in lines])


def _cost(lines: Sequence[Swath], reach: _Reach, start: tuple[float, float] | None) -> float:
    """Return the metres of lines and hops in a quickly made order, with some for each turn and action."""
    if not lines:
        return float("inf")
    along = sum(line.length for line in lines)
    stops = reach.width * len(lines) + reach.length * sum(len(line.spots) for line in lines)
    begins, ends = _ends(lines)
    order = tour(begins, ends, start, improve=False)
    return along + stops + hop_length(begins, ends, order, start)


def _repaired(
    pieces: Sequence[Polygon], lines: list[Swath], reach: _Reach, angle: float | None
) -> list[Swath]:
    """Add lines through what the lines leave out, until next to nothing is left.

    They have the direction that is asked for; what these leave out gets them in any.
    """
    area = sum(piece.area for piece in pieces)
    for again in range(_REPAIRS):
        asked = angle if again < 1 + reach.strict else None
        only = asked if reach.strict else None
        rest = parts(uncovered_by(pieces, lines, reach.width, reach.length, only), smallest=1e-9 * area)
        if sum(piece.area for piece in rest) <= _LEFT_OUT * area:
            return lines
        for piece in rest:
            lines = lines + _sweep([piece], reach, _long_side(piece) if asked is None else asked)
    return lines


def _long_side(piece: Polygon) -> float:
    """Return the direction of the longer side of the smallest rectangle about a polygon."""
    box = shapely.get_coordinates(shapely.oriented_envelope(piece))
    sides = np.diff(box, axis=0)
    if not len(sides):
        return 0.0
    longest = sides[int(np.argmax(np.hypot(sides[:, 0], sides[:, 1])))]
    return float(np.arctan2(longest[1], longest[0]) % pi)
