"""Corners that a robot cuts since it goes through them without a stop.

How far: a robot that turns from one leg into the next at a steady acceleration goes by within v² / 2a;
an autopilot that counts places as passed within a radius goes by within that. The larger one is taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import acos, dist, hypot, radians

from mmrs_core.analysis.figures import MissingFigureError, kinematics_of
from mmrs_core.analysis.motion import Leg, Motion
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.scene import Position

RADIUS = 2.0
"""Metres within which an autopilot counts a place as passed, at most."""

STRAIGHT = radians(1.0)
"""Turns smaller than this cut no corner."""

SAME = 1e-6
"""Metres within which one leg begins where another ends."""

Cut = tuple[Position, int, float]
"""A corner, the move that ends there, and the metres by which it is cut at most."""


def cuts(input: CheckInput, robot: RobotProgram, motion: Motion) -> Iterator[Cut]:
    """Yield the corners that a robot cuts.

    A robot that needs room to turn keeps that room everywhere, and is counted by it alone.
    """
    legs: dict[int, list[Leg]] = {}
    for leg in motion.legs:
        legs.setdefault(leg.move, []).append(leg)
    for source, transition in robot.transitions.items():
        if not transition.fluid or transition.condition is not None or transition.waits:
            continue
        arriving, leaving = legs.get(source, ()), legs.get(transition.to, ())
        for leg in arriving:
            if any(_turns(leg, after) for after in leaving):
                yield leg.points[-1], source, _cut(input, robot, source)


def _cut(input: CheckInput, robot: RobotProgram, move: int) -> float:
    try:
        kinematics = kinematics_of(input, robot)
    except MissingFigureError:
        return RADIUS
    if kinematics.turning_radius > 0.0:
        return 0.0
    pace = robot.moves[move].speed or kinematics.cruise
    return max(RADIUS, pace * pace / (2.0 * kinematics.acceleration))


def _turns(leg: Leg, after: Leg) -> bool:
    """Return whether a way turns where one leg goes over into the next."""
    corner = leg.points[-1]
    if dist(corner, after.points[0]) > SAME:
        return False
    before = next((point for point in reversed(leg.points) if dist(point, corner) > SAME), None)
    beyond = next((point for point in after.points if dist(point, corner) > SAME), None)
    if before is None or beyond is None:
        return False
    a = tuple(q - p for p, q in zip(before, corner, strict=True))
    b = tuple(q - p for p, q in zip(corner, beyond, strict=True))
    cosine = sum(p * q for p, q in zip(a, b, strict=True)) / (hypot(*a) * hypot(*b))
    return acos(max(-1.0, min(1.0, cosine))) >= STRAIGHT
