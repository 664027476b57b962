"""What of a line no robot may follow, since it is too near to what is kept away from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import dist

import shapely
from shapely.geometry.base import BaseGeometry

from mmrs_core.analysis.constraints.findings import called
from mmrs_core.analysis.constraints.sketch import DrawnArea, Sketch
from mmrs_core.geometry.stretches import Stretch, Vertex, between, blocked_stretches, open_stretches
from mmrs_core.scene import Position

SEGMENTS = 64
"""Segments of a quarter circle about a corner: exact to a ten-thousandth of its radius."""


@dataclass(frozen=True, slots=True)
class BlockedLine:
    """A line, and what of it may not be followed.

    Attributes:
        length: metres. left: stretches that may be followed, metres from its beginning.
        blocked: the others, each with what it is too near to.
    """

    length: float
    left: Sequence[Stretch]
    blocked: Sequence[tuple[Stretch, str]]


def blocked_line(sketch: Sketch, line: Sequence[Position], clearance: float) -> BlockedLine:
    """Return what of a line a robot with a clearance may not follow, as planning takes it.

    Args:
        sketch: of the mission.
        line: at least one point.
        clearance: metres that the robot keeps beyond the distances of areas.
    """
    near = {
        called(area.element): found
        for area in sketch.kept_from
        if (
            found := blocked_stretches(
                line, _ring_of(area), area.low, area.high, area.safety_distance + clearance, _all_within
            )
        )
    }
    length = sum(dist(a, b) for a, b in pairwise(line))
    left = open_stretches(near.values(), length)
    blocked = [
        (
            (begin, end),
            ", ".join(name for name, found in near.items() if any(a <= end and b >= begin for a, b in found)),
        )
        for begin, end in (between(left, length) if near else ())
    ]
    return BlockedLine(length, left, blocked)


def _all_within(ring: Sequence[Vertex], distance: float) -> BaseGeometry:
    return shapely.buffer(shapely.Polygon(ring), distance, quad_segs=SEGMENTS)


def _ring_of(area: DrawnArea) -> list[Vertex]:
    return [(east, north) for east, north in shapely.get_coordinates(area.shape.exterior)[:-1].tolist()]
