"""Swaths over polygons: which way to sweep, the lines themselves, and the check that they cover."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.geometry.polygons import parts
from mmrs_core.planning.strips import Swath, swaths_along_x
from mmrs_core.planning.tours import hop_length, tour

Floats: TypeAlias = NDArray[np.float64]

GRID = 1e-6
"""Metres to which overlays are rounded: unions of abutting strips lose area without it."""

_ANGLES = 8
_REPAIRS = 4
_LEFT_OUT = 1e-5
"""Share of the target that swaths may leave out: a hundredth of what is promised."""


def swaths(
    target: Sequence[Polygon],
    width: float,
    *,
    angle: float | None = None,
    start: tuple[float, float] | None = None,
) -> list[Swath]:
    """Return swaths inside the target, in a good order, whose footprints cover the target.

    The footprint of a swath is the union, over its covering legs, of rectangles as long as the leg and
    `width` wide. The way to sweep is the best of the directions of the target's edges (the number
    of swaths is least at one of them) and of the axes, by the length of swaths and hops and
    the number of turns.

    Args:
        target: polygons that do not overlap; concave ones and holes are welcome.
        width: metres, positive.
        angle: direction of the swaths, radians from east to north; None: the best.
        start: where the first swath should be near; None: anywhere.

    Raises:
        ValueError: the width is not positive.
    """
    if not width > 0:
        raise ValueError(f"swath width {width} is not positive")
    pieces = [piece for piece in target if piece.area > 0.0]
    if not pieces:
        return []
    angles = [angle] if angle is not None else sweep_angles(pieces, width)
    sweeps = [_sweep(pieces, width, direction) for direction in angles]
    lines = min(sweeps, key=lambda sweep: _cost(sweep, width, start)) if len(sweeps) > 1 else sweeps[0]
    lines = _repaired(pieces, lines, width)
    begins, ends = _ends(lines)
    return [lines[i].reversed() if back else lines[i] for i, back in tour(begins, ends, start)]


def sweep_angles(pieces: Sequence[Polygon], width: float, count: int = _ANGLES) -> list[float]:
    """Return the most promising directions, radians in [0, pi), best first.

    The number of swaths at a direction u is about half the sum of |edge x u| over the width
    (Cauchy-Crofton); as a function of the direction it is concave between the directions of edges.
    """
    edges = np.concatenate(
        [
            np.diff(shapely.get_coordinates(ring), axis=0)
            for piece in pieces
            for ring in (piece.exterior, *piece.interiors)
        ]
    )
    directions = np.unique(np.round(np.arctan2(edges[:, 1], edges[:, 0]) % pi, 6) % pi)
    across = np.abs(
        np.outer(np.sin(directions), edges[:, 0]) - np.outer(np.cos(directions), edges[:, 1])
    ).sum(axis=1)
    best = directions[np.argsort(across, kind="stable")][: count - 2].tolist()
    return list(dict.fromkeys([*best, 0.0, pi / 2]))


def footprint(lines: Sequence[Swath], width: float) -> BaseGeometry:
    """Return the union of rectangles about the covering legs, as long as the legs and `width` wide."""
    rectangles = [_rectangles(line, width) for line in lines]
    return shapely.union_all(np.concatenate(rectangles), grid_size=GRID) if rectangles else Polygon()


def left_out(pieces: Sequence[Polygon], lines: Sequence[Swath], width: float) -> BaseGeometry:
    """Return what no line's footprint covers."""
    whole = shapely.union_all(list(pieces), grid_size=GRID)
    return shapely.difference(whole, footprint(lines, width), grid_size=GRID)


def _rectangles(line: Swath, width: float) -> NDArray[np.object_]:
    way = np.diff(line.points, axis=0)
    length = np.hypot(way[:, 0], way[:, 1])
    whole = line.covers & (length > 1e-9)
    begin, way, length = line.points[:-1][whole], way[whole], length[whole]
    side = np.column_stack([-way[:, 1], way[:, 0]]) / length[:, None] * (width / 2)
    corners = np.stack([begin - side, begin + way - side, begin + way + side, begin + side], axis=1)
    return np.asarray(shapely.polygons(corners), dtype=np.object_).reshape(-1)


def _sweep(pieces: Sequence[Polygon], width: float, angle: float) -> list[Swath]:
    turned = [affinity.rotate(piece, -angle, origin=(0.0, 0.0), use_radians=True) for piece in pieces]
    back = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
    return [Swath(line.points @ back, line.covers) for line in swaths_along_x(turned, width)]


def _ends(lines: Sequence[Swath]) -> tuple[Floats, Floats]:
    return np.array([line.points[0] for line in lines]), np.array([line.points[-1] for line in lines])


def _cost(lines: Sequence[Swath], width: float, start: tuple[float, float] | None) -> float:
    """Return the metres of lines and hops in a quickly made order, and a width for each line's turns."""
    if not lines:
        return float("inf")
    along = sum(line.length for line in lines)
    begins, ends = _ends(lines)
    return (
        along + width * len(lines) + hop_length(begins, ends, tour(begins, ends, start, improve=False), start)
    )


def _repaired(pieces: Sequence[Polygon], lines: list[Swath], width: float) -> list[Swath]:
    """Add lines through what the lines leave out, until next to nothing is left."""
    area = sum(piece.area for piece in pieces)
    for _ in range(_REPAIRS):
        rest = parts(left_out(pieces, lines, width), smallest=1e-7 * area)
        if sum(piece.area for piece in rest) <= _LEFT_OUT * area:
            return lines
        lines = lines + [line for piece in rest for line in _sweep([piece], width, _long_side(piece))]
    return lines


def _long_side(piece: Polygon) -> float:
    """Return the direction of the longer side of the smallest rectangle about a polygon."""
    box = shapely.get_coordinates(shapely.oriented_envelope(piece))
    sides = np.diff(box, axis=0)
    if not len(sides):
        return 0.0
    longest = sides[int(np.argmax(np.hypot(sides[:, 0], sides[:, 1])))]
    return float(np.arctan2(longest[1], longest[0]) % pi)
