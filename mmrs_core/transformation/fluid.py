"""Where a robot may go from one move into the next without a stop."""

from __future__ import annotations

from math import acos, dist, hypot, pi

import numpy as np
import shapely

from mmrs_core.contributions.rules import MoveSpec
from mmrs_core.scene import Kinematics, Position, Robot, Scene
from mmrs_core.transformation.chain import Chain, DraftTransition

LEAST_CUT = 2.0
"""Metres by which a corner may be cut at least: autopilots count a place as passed within a radius, and may
accelerate less than the robot's type says."""

STRAIGHT = pi / 180
"""Turns smaller than this, in radians, cut no corner."""


class Corners:
    """Corners of a robot's moves, and whether it may pass them without a stop.

    A robot that goes round a corner without a stop cuts it by up to v² / 2a, or by the radius within which
    its autopilot counts the corner as passed. One that needs room to turn passes where its narrowest curve
    fits into the corner, which it then cuts by less than the radius that it keeps everywhere. Where robots
    must keep apart they stop at every corner, so that it is certain when they are where.
    """

    def __init__(self, robot: Robot, scene: Scene, chain: Chain) -> None:
        areas = list(scene.kept_from(robot))
        self._shapes = np.array([shapely.Polygon(area.shell) for area in areas], dtype=object)
        self._keep = np.array([area.safety_distance + robot.clearance for area in areas])
        self._robot, self._chain = robot, chain
        self._timed = scene.minimum_separation is not None
        self._before = {after: edge.source for edge in chain.edges for after in (edge.to, edge.otherwise)}

    def may_flow(self, edge: DraftTransition) -> bool:
        """Return whether the transition along that edge may be fluid."""
        if self._timed or edge.to is None or edge.waits or edge.condition is not None:
            return False
        nodes = self._chain.nodes
        first, second = nodes[edge.source], nodes[edge.to]
        settles = first.spec.settles or second.spec.settles
        if first.after or second.before or settles:
            return False
        if not (_travels(first.spec) and _travels(second.spec)):
            return False
        start = nodes[self._before[edge.source]].spec.target
        corner, end = first.spec.target, second.spec.target
        if corner is None or end is None:
            return False
        if start is not None and _turn(start, corner, end) < STRAIGHT:
            return True
        if self._robot.kinematics is not None and self._robot.kinematics.turning_radius > 0.0:
            return _fits(self._robot.kinematics, self._place_before(edge.source), corner, end)
        return self._is_clear(corner, first.spec.speed)

    def _place_before(self, node: int) -> Position:
        """Return where the robot is when a move begins: its home, unless a move before has led elsewhere."""
        at = self._before.get(node)
        while at is not None:
            target = self._chain.nodes[at].spec.target
            if target is not None:
                return target
            at = self._before.get(at)
        return self._robot.home

    def _is_clear(self, corner: Position, speed: float | None) -> bool:
        kinematics = self._robot.kinematics
        if kinematics is None:
            return False
        pace = speed or kinematics.cruise
        cut = max(LEAST_CUT, kinematics.timing.cut(pace))
        point = shapely.Point(corner[:2])
        return all(
            shape.distance(point) >= keep + cut for shape, keep in zip(self._shapes, self._keep, strict=True)
        )


def _travels(spec: MoveSpec) -> bool:
    return spec.metaclass[1] == "GoTo" and spec.object is None and spec.target is not None


def _fits(kinematics: Kinematics, start: Position, corner: Position, end: Position) -> bool:
    shorter = min(dist(start[:2], corner[:2]), dist(corner[:2], end[:2]))
    turn = _turn(start, corner, end)
    return turn < pi and kinematics.fits_curve(turn, shorter)


def _turn(start: Position, corner: Position, end: Position) -> float:
    """Return the angle by which the path turns at the corner, in radians; pi where it is not defined."""
    a = tuple(y - x for x, y in zip(start, corner, strict=True))
    b = tuple(y - x for x, y in zip(corner, end, strict=True))
    lengths = hypot(*a) * hypot(*b)
    if lengths == 0.0:
        return pi
    cosine = sum(x * y for x, y in zip(a, b, strict=True)) / lengths
    return acos(max(-1.0, min(1.0, cosine)))
