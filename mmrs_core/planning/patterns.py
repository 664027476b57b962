"""Patterns in which swaths cover an area, as pilots know them: from tasks' attributes to ordered swaths."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import atan2, pi, radians
from typing import TypeAlias

import numpy as np

from mmrs_core.planning.lines import Swath
from mmrs_core.planning.tours import tour
from mmrs_core.scene import Part, Point
from mmrs_core.scene.attributes import flag, number, text

_CORNERS = {
    "NORTH_WEST": (-1.0, 1.0),
    "NORTH_EAST": (1.0, 1.0),
    "SOUTH_EAST": (1.0, -1.0),
    "SOUTH_WEST": (-1.0, -1.0),
}

Layer: TypeAlias = Callable[[float | None, Point | None], Sequence[Swath]]
"""Returns swaths over the whole area in a good order, by their angle and where they should begin."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """How swaths over an area are laid and ordered.

    Attributes:
        angle: direction of the swaths, radians from east to north; None: the best one.
        cross_hatch: whether swaths across the first ones cover the area once more.
        corner: direction to the corner at which the first swath begins; None: at the nearest end.
        turnaround: metres by which swaths are extended at both ends, where that is clear.
        alternate: whether every other swath is skipped, and covered on the return.
    """

    angle: float | None = None
    cross_hatch: bool = False
    corner: Point | None = None
    turnaround: float = 0.0
    alternate: bool = False


def pattern_of(part: Part) -> Pattern:
    """Return the pattern of a task that covers an area in swaths."""
    angle = number(part, "swathAngle")
    return Pattern(
        angle=None if angle is None else radians(90.0 - angle) % pi,
        cross_hatch=flag(part, "crossHatch"),
        corner=_CORNERS.get(text(part, "startCorner")),
        turnaround=number(part, "turnaroundDistance") or 0.0,
        alternate=flag(part, "alternateSwaths"),
    )


def layers_of(pattern: Pattern, start: Point | None, layer: Layer) -> tuple[Sequence[Swath], ...]:
    """Return the swaths of each layer of a pattern, in order.

    Args:
        pattern: of them.
        start: where the first swath should be near, unless the pattern names a corner; None: anywhere.
        layer: makes the swaths of one layer.
    """
    first = layer(pattern.angle, start if pattern.corner is None else None)
    if pattern.corner is not None:
        first = _from_corner(first, pattern.corner)
    first = _alternate(first) if pattern.alternate else first
    if not pattern.cross_hatch:
        return (first,)
    east, north = first[-1].points[-1].tolist()
    along = _direction(first) if pattern.angle is None else pattern.angle
    second = layer(along + pi / 2.0, (east, north))
    return first, _alternate(second) if pattern.alternate else second


def _from_corner(lines: Sequence[Swath], corner: Point) -> list[Swath]:
    """Return swaths in a good order that begins at the end of one that is farthest towards a corner."""
    ends = np.array([line.ends for line in lines])
    first, turned = divmod(int(np.argmax(ends @ np.array(corner))), 2)
    rest = [line for index, line in enumerate(lines) if index != first]
    ends = np.delete(ends, first, axis=0)
    begin = lines[first].reversed() if turned else lines[first]
    order = tour(ends[:, 0], ends[:, 1], begin.points[-1])
    return [begin, *(rest[index].reversed() if back else rest[index] for index, back in order)]


def _alternate(lines: Sequence[Swath]) -> list[Swath]:
    """Return every other swath, then those between in reverse, each begun at its nearer end."""
    found: list[Swath] = []
    for line in (*lines[::2], *lines[1::2][::-1]):
        here = found[-1].points[-1] if found else line.points[0]
        far = np.hypot(*(line.points[[0, -1]] - here).T)
        found.append(line if far[0] <= far[1] else line.reversed())
    return found


def _direction(lines: Sequence[Swath]) -> float:
    """Return the direction of the longest leg of swaths, radians."""
    legs = np.concatenate([np.diff(line.points, axis=0) for line in lines])
    if not len(legs):
        return 0.0
    east, north = legs[int(np.argmax(np.hypot(legs[:, 0], legs[:, 1])))].tolist()
    return atan2(north, east) % pi
