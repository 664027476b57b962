"""Corners of a path that a robot may pass without a stop."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import pairwise
from math import dist, inf, pi
from typing import NamedTuple

import shapely

from mmrs_core.scene import Area, Corridor, Kinematics, Position, Robot
from mmrs_core.scene.headings import turn_at
from mmrs_core.scene.passing import SHORTEST_RUN

LEAST_CUT = 2.0
"""Metres by which a corner may be cut at least: autopilots count a place as passed within a radius, and may
accelerate less than the robot's type says."""

STRAIGHT = pi / 180
"""Turns smaller than this, in radians, cut no corner."""

_ON = 1e-6
"""Metres within which a corner is on a line."""


class Corners:
    """The corners that a robot may pass among some areas, and in corridors.

    A robot that goes round a corner without a stop cuts it by up to v² / 2a, or by the radius within which
    its autopilot counts the corner as passed. One that needs room to turn passes where its narrowest curve
    fits into the corner, which it then cuts by less than the radius that it keeps everywhere.
    """

    def __init__(self, robot: Robot, areas: Iterable[Area], corridors: Iterable[Corridor] = ()) -> None:
        """Make it for a robot that keeps away from areas, and goes along the lines of corridors."""
        self._robot, self._areas, self._corridors = robot, list(areas), list(corridors)

    @cached_property
    def _shapes(self) -> list[tuple[shapely.Polygon, float]]:
        own = self._robot.clearance
        return [(shapely.Polygon(area.shell), area.safety_distance + own) for area in self._areas]

    @cached_property
    def _lines(self) -> list[tuple[shapely.LineString, Corridor]]:
        return [(shapely.LineString(each.line), each) for each in self._corridors]

    def _spare(self, corner: Position) -> float:
        """Return the metres by which a robot may be off a corner on the line of a corridor; inf elsewhere."""
        point, own = shapely.Point(corner[:2]), self._robot.clearance
        rooms = (
            min(each.width / 2.0, corner[2] - each.low, each.high - corner[2])
            for line, each in self._lines
            if line.distance(point) <= _ON
        )
        return min(rooms, default=inf) - own

    def may_pass(self, start: Position | None, corner: Position, end: Position, speed: float | None) -> bool:
        """Return whether the robot need not stop at a corner.

        Args:
            start: where the leg to the corner begins; None: not known.
            corner: between two legs.
            end: of the leg from there.
            speed: commanded on the leg to the corner, metres per second; None: its cruise.
        """
        if start is not None and turn_at(start, corner, end) < STRAIGHT:
            return True
        kinematics = self._robot.kinematics
        if kinematics is None:
            return False
        if kinematics.turning_radius > 0.0:
            return start is not None and _fits(kinematics, start, corner, end)
        cut = max(LEAST_CUT, kinematics.timing.cut(speed or kinematics.cruise))
        if cut > self._spare(corner):
            return False
        point = shapely.Point(corner[:2])
        return all(shape.distance(point) >= keep + cut for shape, keep in self._shapes)


def _fits(kinematics: Kinematics, start: Position, corner: Position, end: Position) -> bool:
    shorter = min(dist(start[:2], corner[:2]), dist(corner[:2], end[:2]))
    turn = turn_at(start, corner, end)
    return turn < pi and kinematics.fits_curve(turn, shorter)


class InMissions(NamedTuple):
    """What of some legs is part of missions that are uploaded.

    Attributes:
        legs: their numbers.
        ends: of missions that end with one of them.
    """

    legs: frozenset[int] = frozenset()
    ends: int = 0


def runs_between(halts: Sequence[bool], beside: tuple[int, int]) -> Iterator[tuple[range, int]]:
    """Yield the legs that may be part of a mission that is uploaded, and how many of its ends continue.

    Args:
        halts: whether the robot stops for certain before each leg, and after the last.
        beside: legs before the first and after the last that may continue them.
    """
    last = len(halts) - 1
    stops = [0, *(i for i in range(1, last) if halts[i]), last]
    for begin, end in pairwise(stops):
        before, after = not begin and not halts[0], end == last and not halts[last]
        if end - begin + before * beside[0] + after * beside[1] >= SHORTEST_RUN:
            yield range(begin, end), before + after
