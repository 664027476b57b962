"""Distances that robots keep from forbidden areas and obstacles, as these are drawn.

Every leg of every move counts, launching and landing included, and so does where a robot begins and
ends. What must be kept is the area's safety distance, half the robot's diagonal and the position
error, in all three dimensions. Emergency areas forbid nothing. Where a transition is fluid and the path
turns, the robot may be off the corner by as much as it cuts it (`cuts`). Where it stops, it overshoots first
(`stops`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import acos, dist, hypot, inf, radians

import numpy as np

from mmrs_core.analysis.distance import Floats, prism_distances
from mmrs_core.analysis.figures import MissingFigureError, half_diagonal_of, kinematics_of, type_of
from mmrs_core.analysis.motion import Motion, MovePath, motions
from mmrs_core.analysis.verdicts import TOLERANCE, Margin, for_each_robot, judged, not_checked, safe
from mmrs_core.behaviour.program import RobotProgram, Transition
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict
from mmrs_core.diagnostics import lengths
from mmrs_core.scene import Area, AreaUse, Position

NAME = "clearance"


@dataclass(frozen=True, slots=True)
class _Segments:
    """All straight pieces of a robot's legs: (n, 3) ends, the moves they belong to, their spread."""

    begins: Floats
    ends: Floats
    moves: tuple[int, ...]
    spread: Floats


def _judge(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    if input.areas is None:
        yield not_checked(NAME, robot, "no context was given")
        return
    areas = [
        area for area in input.areas if area.use is not AreaUse.EMERGENCY and area.concerns(robot.type_name)
    ]
    if not areas:
        yield safe(NAME, robot, "nothing in the context is forbidden or in the way")
        return
    own = input.program.position_error
    try:
        own += half_diagonal_of(type_of(input, robot))
        turning = kinematics_of(input, robot).turning_radius
    except MissingFigureError:
        # What is too near for the smallest robot that turns on the spot is too near for any.
        kept = _kept(input, robot, areas, max(own, 2.0 * TOLERANCE))
        yield from (each for each in kept if each.status is Status.VIOLATED)
        raise
    yield from _kept(input, robot, areas, own + turning)


def _kept(input: CheckInput, robot: RobotProgram, areas: list[Area], own: float) -> Iterator[Verdict]:
    """Yield how the robot keeps `own` metres on top of the distances of areas."""
    motion, error = motions(input)[robot.id], input.program.position_error
    segments = _segments(motion, cuts(input, robot, motion), stops(input, robot, motion))
    margins = list(_margins(segments, areas, own)) if segments.moves else []
    yield from judged(NAME, robot, "m", (_described(robot, margin, error) for margin in margins), motion.gaps)


def _segments(motion: Motion, cuts: Iterable[Cut], stops: Iterable[Piece]) -> _Segments:
    pieces = [
        (begin, end, leg.move, leg.radius)
        for leg in motion.paths
        for begin, end in pairwise(leg.points if len(leg.points) > 1 else leg.points * 2)
    ]
    pieces += [(corner, corner, move, metres) for corner, move, metres in cuts]
    pieces += stops
    return _Segments(
        begins=np.array([piece[0] for piece in pieces], dtype=np.float64).reshape(-1, 3),
        ends=np.array([piece[1] for piece in pieces], dtype=np.float64).reshape(-1, 3),
        moves=tuple(piece[2] for piece in pieces),
        spread=np.array([piece[3] for piece in pieces], dtype=np.float64),
    )


@dataclass(frozen=True, slots=True)
class _Approach:
    """How near a robot comes to one area on one move. Attributes: metres kept, metres required."""

    area: Area
    move: int
    kept: float
    required: float


def _margins(segments: _Segments, areas: list[Area], own: float) -> Iterator[_Approach]:
    """Yield the nearest approach to each area that is too near, or may be the nearest of all.

    Boxes tell which legs and areas cannot matter; of these no exact distance is taken.
    """
    bounds = [_least_margins(segments, area, own) for area in areas]
    nearest = inf
    for index in sorted(range(len(areas)), key=lambda i: float(bounds[i].min())):
        area = areas[index]
        chosen = np.flatnonzero(bounds[index] <= max(nearest, TOLERANCE))
        if not len(chosen):
            continue
        required = area.safety_distance + own
        kept = _distances(segments, chosen, area) - segments.spread[chosen]
        best = int(kept.argmin())
        nearest = min(nearest, float(kept[best]) - required)
        yield _Approach(area, segments.moves[int(chosen[best])], float(kept[best]), required)


def _distances(segments: _Segments, chosen: np.typing.NDArray[np.intp], area: Area) -> Floats:
    return prism_distances(segments.begins[chosen], segments.ends[chosen], area.shell, area.low, area.high)


def _least_margins(segments: _Segments, area: Area, own: float) -> Floats:
    """Return margins that no leg falls below: those of the boxes around legs and area."""
    shell = np.asarray(area.shell, dtype=np.float64)
    least = np.append(shell.min(axis=0), area.low)
    most = np.append(shell.max(axis=0), area.high)
    low, high = np.minimum(segments.begins, segments.ends), np.maximum(segments.begins, segments.ends)
    gaps = np.maximum(np.maximum(least - high, low - most), 0.0)
    distances: Floats = np.sqrt(np.sum(gaps * gaps, axis=1))
    return distances - segments.spread - (area.safety_distance + own)


def _described(robot: RobotProgram, approach: _Approach, error: float) -> Margin:
    move = robot.moves[approach.move]
    kept, required = lengths(approach.kept, approach.required)
    message = f"{move.kind} '{move.id}' keeps {kept} from '{approach.area.name}', {required} are required"
    return Margin(approach.kept - approach.required, approach.move, message, approach.area.name, error)


CLEARANCE = Check(
    name=NAME,
    title="Every leg keeps its distance from forbidden areas and obstacles as drawn.",
    run=for_each_robot(NAME, _judge),
    hint="move the target or the home away from the area, or lead the path around or above it",
)


RADIUS = 2.0
"""Metres within which an autopilot counts a place as passed, at most."""

STRAIGHT = radians(1.0)
"""Turns smaller than this cut no corner."""

UTURN = radians(179.0)
"""No curve fits into a corner with a larger turn."""

SAME = 1e-6
"""Metres within which one leg begins where another ends."""

Cut = tuple[Position, int, float]
"""A corner, the move that ends there, and the metres by which it is cut at most."""


Piece = tuple[Position, Position, int, float]
"""A straight piece, the move that it belongs to, and how far the robot may be from it, metres."""


def stops(input: CheckInput, robot: RobotProgram, motion: Motion) -> Iterator[Piece]:
    """Yield the pieces that a robot goes beyond the ends of its legs where it stops, until it turns back."""
    try:
        kinematics = kinematics_of(input, robot)
    except MissingFigureError:
        return
    if kinematics.timing.overshoot <= 0.0:
        return
    for leg in motion.paths:
        transition = robot.transitions.get(leg.move)
        through = transition is not None and _passes(transition)
        pace = robot.moves[leg.move].speed or kinematics.cruise
        legs = list(pairwise(leg.points))
        for start, end in legs[:-1] if through else legs:
            if start[:2] != end[:2]:
                yield end, kinematics.beyond(start, end, pace), leg.move, leg.radius


def _passes(transition: Transition) -> bool:
    return transition.fluid and transition.condition is None and not transition.waits


def cuts(input: CheckInput, robot: RobotProgram, motion: Motion) -> Iterator[Cut]:
    """Yield the corners that a robot cuts since it passes them without a stop.

    At a steady acceleration it passes within v² / 2a; an autopilot that counts positions as passed within
    a radius lets it pass within that. The larger one is taken.
    A robot that needs room to turn keeps that room everywhere, and is counted by it alone where its narrowest
    curve fits into the corner; elsewhere it swings out by as much as its turning circle is wide.
    """
    legs: dict[int, list[MovePath]] = {}
    for leg in motion.paths:
        legs.setdefault(leg.move, []).append(leg)
    for source, transition in robot.transitions.items():
        if not _passes(transition):
            continue
        arriving, leaving = legs.get(source, ()), legs.get(transition.to, ())
        for leg in arriving:
            turned = [each for after in leaving if (each := _corner(leg, after)) is not None]
            if any(turn >= STRAIGHT for turn, _ in turned):
                yield leg.points[-1], source, max(_cut(input, robot, source, *each) for each in turned)


def _cut(input: CheckInput, robot: RobotProgram, move: int, turn: float, leg: float) -> float:
    """Return the metres by which a corner is cut at most that turns so far between legs so long at least."""
    try:
        kinematics = kinematics_of(input, robot)
    except MissingFigureError:
        return RADIUS
    if kinematics.turning_radius > 0.0:
        fits = turn < UTURN and kinematics.fits_curve(turn, leg)
        return 0.0 if fits else 2.0 * kinematics.turning_radius
    pace = robot.moves[move].speed or kinematics.cruise
    return max(RADIUS, kinematics.timing.cut(pace))


def _corner(leg: MovePath, after: MovePath) -> tuple[float, float] | None:
    """Return by how many radians the path turns from one leg into the next, and the shorter's metres.

    None where it does not go over into it, or stays where it is.
    """
    corner = leg.points[-1]
    if dist(corner, after.points[0]) > SAME:
        return None
    before = next((point for point in reversed(leg.points) if dist(point, corner) > SAME), None)
    beyond = next((point for point in after.points if dist(point, corner) > SAME), None)
    if before is None or beyond is None:
        return None
    a = tuple(q - p for p, q in zip(before, corner, strict=True))
    b = tuple(q - p for p, q in zip(corner, beyond, strict=True))
    cosine = sum(p * q for p, q in zip(a, b, strict=True)) / (hypot(*a) * hypot(*b))
    return acos(max(-1.0, min(1.0, cosine))), min(hypot(*a), hypot(*b))
