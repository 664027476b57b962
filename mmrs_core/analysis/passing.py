"""Whether two robots must come too near to each other, however long what they do takes.

Each robot goes through the pieces of its path in order. A run of both is a path through the grid of pairs
of pieces (a coordination diagram, O'Donnell and Lozano-Pérez 1989) from the first pair to the last that
never leads back, over pairs on which both may be at one time. Where every such path leads over a pair
all of whose points are too near to each other, no run avoids it.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, dist

import numpy as np
import numpy.typing as npt

from mmrs_core.analysis.distance import Flags, Floats
from mmrs_core.analysis.motion import Motion
from mmrs_core.analysis.occupations import Occupation
from mmrs_core.analysis.verdicts import TOLERANCE
from mmrs_core.behaviour.program import RobotProgram

FINEST = 0.25
"""Share of the distance to keep that pieces have at least."""

MOST_PIECES = 1000
"""Pieces of a robot's path, about, at most; they are longer if need be."""


MOST_PAIRS = 10_000_000
"""Where two robots have more pairs of pieces, whether they must meet is left undecided."""


def in_sequence(
    robot: RobotProgram, motion: Motion, occupations: Collection[Occupation]
) -> list[Occupation] | None:
    """Return a robot's own occupations in order; None if Choices, loops or unknown paths leave it open."""
    order: dict[int, int] = {}
    move: int | None = robot.start
    while move is not None:
        transition = robot.transitions.get(move)
        if move in order or (transition is not None and len(transition.next_moves) > 1):
            return None
        order[move] = len(order)
        move = transition.to if transition is not None else None
    if motion.gaps or sorted(order) != sorted(leg.move for leg in motion.paths):
        return None
    return sorted(occupations, key=lambda each: order[each.move])


def must_meet(
    one: Sequence[Occupation],
    other: Sequence[Occupation],
    near: Collection[tuple[Occupation, Occupation]],
    needed: float,
) -> bool:
    """Return whether two robots come nearer to each other than needed in every run that ends.

    Only pairs of occupations in `near` count: in others, robots are far enough apart, or excused.
    """
    first = _pieces(one, {pair[0] for pair in near}, needed)
    second = _pieces(other, {pair[1] for pair in near}, needed)
    if len(first.of) * len(second.of) > MOST_PAIRS:
        return False
    free = np.less_equal.outer(first.times[:, 0], second.times[:, 1] + TOLERANCE)
    free &= np.less_equal.outer(second.times[:, 0], first.times[:, 1] + TOLERANCE).T
    for a, b in near:
        i, j = first.of == one.index(a), second.of == other.index(b)
        least = needed - a.radius - b.radius - TOLERANCE
        free[np.ix_(i, j)] &= _farthest(first.ends[i], second.ends[j]) >= least
    return not _passable(free)


@dataclass(frozen=True, slots=True)
class _Pieces:
    """Attributes: of (n,) which occupation; ends (n, 2, 3); times (n, 2) between which it is there."""

    of: npt.NDArray[np.intp]
    ends: Floats
    times: Floats


def _pieces(occupations: Sequence[Occupation], cut: Collection[Occupation], needed: float) -> _Pieces:
    """Return the pieces of a robot's occupations, in order; only those to be cut are cut."""
    whole = sum(dist(a, b) for each in cut for a, b in pairwise(each.points))
    longest = max(FINEST * needed, whole / MOST_PIECES, TOLERANCE)
    of, ends, times = [], [], []
    for number, each in enumerate(occupations):
        left = sum(each.least)
        passed = 0.0
        for (a, b), seconds in zip(pairwise(each.points), each.least, strict=True):
            parts = max(1, ceil(dist(a, b) / longest)) if each in cut else 1
            left -= seconds
            for low, high in pairwise(np.linspace(0.0, 1.0, parts + 1)):
                ends.append([np.asarray(a) + share * np.subtract(b, a) for share in (low, high)])
                times.append((each.begin + passed + low * seconds, each.end - left - (1.0 - high) * seconds))
                of.append(number)
            passed += seconds
        if each.stands:
            ends.append([np.asarray(each.points[0])] * 2)
            times.append((each.begin, each.end))
            of.append(number)
    return _Pieces(np.array(of), np.array(ends), np.array(times))


def _farthest(one: Floats, other: Floats) -> Floats:
    """Return how far points of straight pieces are apart at most, (n, m): that is so at their ends."""
    ends = [np.linalg.norm(one[:, None, a] - other[None, :, b], axis=2) for a in (0, 1) for b in (0, 1)]
    farthest: Floats = np.maximum.reduce(ends)
    return farthest


def _passable(free: Flags) -> bool:
    """Return whether a path that never leads back joins the first and the last cell over free ones."""
    columns = np.arange(free.shape[1])
    reached = np.logical_and.accumulate(free[0])
    for row in free[1:]:
        entered = row & (reached | np.concatenate([[False], reached[:-1]]))
        last_entered = np.maximum.accumulate(np.where(entered, columns, -1))
        last_closed = np.maximum.accumulate(np.where(row, -1, columns))
        reached = last_entered > last_closed
    return bool(reached[-1])
