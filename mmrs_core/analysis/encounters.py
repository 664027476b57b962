"""When two occupations bring robots too near to each other, and whether they certainly do.

Certainty does not need exact times. A robot that moves passes a point of its path no earlier than it can
have come there, and no later than it must to arrive in time: if another stands beside that point all this
while, they meet in every run. Waits for each other prove as much where times prove nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import pairwise
from math import inf

import numpy as np

from mmrs_core.analysis.dependencies import certain_moves
from mmrs_core.analysis.distance import Floats, paired_distances, segment_distance
from mmrs_core.analysis.occupations import Occupation
from mmrs_core.analysis.times import order_of
from mmrs_core.analysis.verdicts import TOLERANCE
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.scene import Position

FINEST = 0.01
"""Seconds: stretches of time that are no longer are not divided further."""

MOST_STRETCHES = 200
"""So many stretches too near, none of them certain, are enough to leave it undecided."""


@dataclass(frozen=True, slots=True)
class Encounter:
    """Two occupations that come too near at a time; `needed` metres would do.

    Attributes:
        apart: metres that the robots are then apart: at most if decided, at least if not.
        decided: whether both robots are certainly there at that time.
        anyhow: whether they certainly come too near somewhere, if not there; apart is a lower bound then.
    """

    one: Occupation
    other: Occupation
    time: float
    apart: float
    needed: float
    decided: bool
    anyhow: bool = False


class ProvenOrder:
    """What waits for each other prove of a behaviour's occupations."""

    def __init__(self, input: CheckInput) -> None:
        self._before = order_of(input)
        self._certain = {robot.id: certain_moves(robot) for robot in input.program.robots}

    def keeps_apart(self, one: Occupation, other: Occupation) -> bool:
        """Return whether one of two occupations is over before the other begins."""
        return self._over(one, other.robot, other.move) or self._over(other, one.robot, one.move)

    def stand_during(self, stand: Occupation, other: Occupation) -> tuple[float, float]:
        """Return from when to when a robot stands certainly, as far as the other occupation matters.

        Without end to that side on which waits prove it for all the time of the other.
        """
        first, last = stand.certain
        if self._sure(stand) and self._sure(other):
            here, there = (stand.robot, stand.move), (other.robot, other.move)
            if stand.waiting and self._before.is_over(here, False, there):
                first = -inf
            if stand.leaves_by and all(self._over(other, stand.robot, move) for move in stand.leaves_by):
                last = inf
        return first, last

    def _over(self, earlier: Occupation, robot: str, move: int) -> bool:
        return self._before.is_over(
            (earlier.robot, earlier.move), earlier.waiting or earlier.overshot, (robot, move)
        )

    def _sure(self, occupation: Occupation) -> bool:
        return occupation.move in self._certain[occupation.robot]


def required(one: Occupation, other: Occupation, needed: float) -> float:
    """Return how far two paths have to be from each other, metres."""
    return needed + _astray(one, other) - TOLERANCE


def _astray(one: Occupation, other: Occupation) -> float:
    """Return by how many metres two robots may be nearer to each other than their paths, or further apart."""
    return one.radius + other.radius


def certain_encounter(
    one: Occupation, other: Occupation, needed: float, order: ProvenOrder
) -> Encounter | None:
    """Return where one robot certainly comes too near to another that stands; None if that is not proven."""
    if not (one.stands or other.stands):
        return None
    if one.stands and other.stands:
        found = _standing(one, other, order)
    else:
        found = _passing(other, one, order) if one.stands else _passing(one, other, order)
    if found is None:
        return None
    nearness, time = found[0] + _astray(one, other), found[1]
    return Encounter(one, other, time, nearness, needed, True) if nearness < needed - TOLERANCE else None


def _standing(one: Occupation, other: Occupation, order: ProvenOrder) -> tuple[float, float] | None:
    """Return the distance of two robots that certainly stand at one time, and that time."""
    spans = (order.stand_during(one, other), order.stand_during(other, one))
    begin, end = max(span[0] for span in spans), min(span[1] for span in spans)
    if begin > end + TOLERANCE:
        return None
    return apart(one.points, other.points), max(begin, one.begin, other.begin)


def _passing(mover: Occupation, stand: Occupation, order: ProvenOrder) -> tuple[float, float] | None:
    """Return how near a robot comes on what it passes while another certainly stands, and when at least."""
    begin, end = order.stand_during(stand, mover)
    whole = sum(mover.least)
    first = max(0.0, begin - mover.begin)
    last = whole if end == inf else min(whole, end - mover.end + whole)
    if first > last:
        return None
    nearness, seconds = _nearest_pass(mover, (first, last), stand.points[0])
    return nearness, mover.begin + seconds


def _nearest_pass(mover: Occupation, part: tuple[float, float], place: Position) -> tuple[float, float]:
    """Return how near a part of a path comes to a place, and the seconds at full speed to there."""
    corners = [part[0], *(t for t in np.cumsum(mover.least) if part[0] < t < part[1]), part[1]]
    found = []
    for first, last in pairwise(corners):
        a, b = (np.asarray(mover.stretch(t, t)[0]) for t in (first, last))
        square = float((b - a) @ (b - a))
        share = min(1.0, max(0.0, float((np.asarray(place) - a) @ (b - a)) / square)) if square else 0.0
        nearness = float(np.linalg.norm(a + share * (b - a) - np.asarray(place)))
        found.append((nearness, first + share * (last - first)))
    return min(found)


def nearest_encounter(one: Occupation, other: Occupation, needed: float) -> Encounter | None:
    """Return the nearest encounter that is certain, or else the nearest of all; None if there is none.

    The time that both may be there is halved, always where the parts of the ways are nearest to each
    other, until they are far enough apart or the time is short.
    """
    least, astray = required(one, other, needed), _astray(one, other)
    begin, end = _common_time(one, other)
    pending = [(apart(one.between(begin, end), other.between(begin, end)), begin, end)]
    nearest: Encounter | None = None
    left = MOST_STRETCHES if _certain_together(one, other) else 1
    while pending and left and pending[0][0] < least:
        nearness, begin, end = heappop(pending)
        if end - begin > FINEST:
            middle = (begin + end) / 2
            for half in ((begin, middle), (middle, end)):
                heappush(pending, (apart(one.between(*half), other.between(*half)), *half))
            continue
        decided = _certainly(one, begin, end) and _certainly(other, begin, end)
        if decided:
            nearness = _apart_moving(one, other, begin, end)
            if nearness >= least:
                continue
            decided = nearness + astray < needed - TOLERANCE
        left -= 1
        found = Encounter(one, other, begin, nearness + (astray if decided else -astray), needed, decided)
        if decided:
            return found
        nearest = nearest or found
    return nearest


def _apart_moving(one: Occupation, other: Occupation, begin: float, end: float) -> float:
    """Return how near two robots come whose places are known at the begin and the end of a short time."""
    first = np.subtract(one.between(begin, begin)[0], other.between(begin, begin)[0])
    last = np.subtract(one.between(end, end)[0], other.between(end, end)[0])
    return apart((tuple(first), tuple(last)), ((0.0, 0.0, 0.0),))


def _common_time(one: Occupation, other: Occupation) -> tuple[float, float]:
    """Return when both may be there; where there is no end, until both may have come everywhere."""
    begin, end = max(one.begin, other.begin), min(one.end, other.end)
    return begin, end if end < inf else begin + max(FINEST, sum(one.least), sum(other.least))


def _certain_together(one: Occupation, other: Occupation) -> bool:
    begin, end = (max(one.certain[0], other.certain[0]), min(one.certain[1], other.certain[1]))
    return begin <= end + TOLERANCE


def _certainly(occupation: Occupation, begin: float, end: float) -> bool:
    return occupation.certain[0] - TOLERANCE <= begin and end <= occupation.certain[1] + TOLERANCE


def apart(one: tuple[Position, ...], other: tuple[Position, ...]) -> float:
    """Return the distance of two paths, metres."""
    if len(one) <= 2 and len(other) <= 2:
        return segment_distance(one[0], one[-1], other[0], other[-1])
    p, q = _pieces(one)
    c, d = _pieces(other)
    return float(paired_distances(p[:, None], q[:, None], c[None], d[None]).min())


def _pieces(points: tuple[Position, ...]) -> tuple[Floats, Floats]:
    line = points if len(points) > 1 else points * 2
    ends = np.array(list(pairwise(line)))
    return ends[:, 0], ends[:, 1]
