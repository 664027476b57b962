"""What swaths cover, as rectangles in the plane, and what they leave out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Point, Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.planning.lines import Swath

Floats: TypeAlias = NDArray[np.float64]

GRID = 1e-6
"""Metres to which overlays are rounded: unions of abutting strips lose area without it."""


_ALIGNED = 0.02
"""Sine of the angle by which a leg may deviate from a direction that counts."""


def footprint(
    lines: Sequence[Swath], width: float, length: float = 0.0, angle: float | None = None
) -> BaseGeometry:
    """Return what swaths cover.

    Without a `length`, that is the union of rectangles about the legs, as long as the legs and `width`
    wide; with one, of rectangles `length` along and `width` across the leg, about each spot. About a single
    point it is the circle that is covered whichever direction the robot faces. With an `angle`, radians from
    east to north, only legs in that direction count, either way.
    """
    shapes = [
        _along(line, width, angle) if length <= 0.0 else _about(line, width, length, angle) for line in lines
    ]
    return shapely.union_all(np.concatenate(shapes), grid_size=GRID) if shapes else Polygon()


def uncovered_by(
    pieces: Sequence[Polygon],
    lines: Sequence[Swath],
    width: float,
    length: float = 0.0,
    angle: float | None = None,
) -> BaseGeometry:
    """Return what no swath covers of the pieces, as `footprint` says."""
    whole = shapely.union_all(list(pieces), grid_size=GRID)
    return shapely.difference(whole, footprint(lines, width, length, angle), grid_size=GRID)


def needed(
    pieces: Sequence[Polygon], lines: Sequence[Swath], width: float, length: float, angle: float | None = None
) -> list[Swath]:
    """Return the swaths without spots about which all that is covered of the pieces is so about others.

    Such are where swaths step aside around corners: only spots that are near to another one are asked about.
    With an `angle`, what spots in that direction cover counts as covered about others in it only.
    """
    shapes = [_about(line, width, length) for line in lines]
    every = np.concatenate(shapes)
    centres = shapely.centroid(every)
    pairs = shapely.STRtree(centres).query(centres, "dwithin", min(width, length) / 2.0 - GRID)
    near = np.unique(pairs[0][pairs[0] != pairs[1]])
    whole, tree = shapely.union_all(list(pieces), grid_size=GRID), shapely.STRtree(every)
    line_of = np.repeat(np.arange(len(lines)), [len(each) for each in shapes])
    counts = np.concatenate([_counting(line, angle) for line in lines])
    kept = np.ones(len(every), np.bool_)
    for spot in sorted(near.tolist(), key=lambda each: len(shapes[line_of[each]])):
        kept[spot] = False
        others = tree.query(every[spot])
        own = shapely.intersection(every[spot], whole)
        covered = shapely.union_all(
            every[others[kept[others] & (counts[others] >= counts[spot])]], grid_size=GRID
        )
        kept[spot] = shapely.difference(own, covered, grid_size=GRID).area > GRID * 2.0 * (width + length)
    left = (np.array(line.spots)[kept[line_of == i]].tolist() for i, line in enumerate(lines))
    found = zip(lines, left, strict=True)
    return [line if len(spots) == len(line.spots) else line.only(spots) for line, spots in found if spots]


def _along(line: Swath, width: float, angle: float | None) -> NDArray[np.object_]:
    direction, middles = np.diff(line.points, axis=0), (line.points[:-1] + line.points[1:]) / 2
    counts = _aligned(direction, angle)
    direction, middles = direction[counts], middles[counts]
    return _rectangles(middles, direction, np.hypot(direction[:, 0], direction[:, 1]), width)


def _aligned(directions: Floats, angle: float | None) -> NDArray[np.bool_]:
    """Return which directions are that of an angle, either way; all where there is none."""
    if angle is None:
        return np.ones(len(directions), np.bool_)
    across = directions @ np.array([-np.sin(angle), np.cos(angle)])
    aligned: NDArray[np.bool_] = np.abs(across) <= _ALIGNED * np.hypot(directions[:, 0], directions[:, 1])
    return aligned


def _counting(line: Swath, angle: float | None) -> NDArray[np.bool_]:
    """Return which spots of a swath are on legs in the direction of an angle; all where there is none."""
    if len(line.points) == 1:
        return np.ones(1, np.bool_)
    return _aligned(np.diff(line.points, axis=0), angle)[line.legs_of_spots]


def _about(line: Swath, width: float, length: float, angle: float | None = None) -> NDArray[np.object_]:
    if len(line.points) == 1:
        return np.array([Point(line.points[0]).buffer(min(width, length) / 2)], dtype=object)
    direction = np.diff(line.points, axis=0)
    far = np.hypot(direction[:, 0], direction[:, 1])
    counts = _counting(line, angle)
    leg, spots = line.legs_of_spots[counts], np.array(line.spots)[counts]
    centres = line.points[leg] + direction[leg] * ((spots - line.arcs[leg]) / far[leg])[:, None]
    return _rectangles(centres, direction[leg], np.full(len(spots), length), width)


def _rectangles(centres: Floats, directions: Floats, lengths: Floats, width: float) -> NDArray[np.object_]:
    """Return rectangles about centres, along directions; none where there is no direction."""
    far = np.hypot(directions[:, 0], directions[:, 1])
    there = far > 1e-9
    ahead = directions[there] / far[there, None]
    aside = np.column_stack([-ahead[:, 1], ahead[:, 0]]) * (width / 2)
    ahead = ahead * (lengths[there, None] / 2)
    middle = centres[there]
    corners = [middle - ahead - aside, middle + ahead - aside, middle + ahead + aside, middle - ahead + aside]
    return np.asarray(shapely.polygons(np.stack(corners, axis=1)), dtype=np.object_).reshape(-1)
