"""Whether robots that are under way at the same time keep apart.

Two occupations are apart if the ways are far enough from each other, if they never overlap in time, if
one is over before the other begins because robots wait for each other, or if at every time the parts
of the ways on which the robots may then be are far enough from each other. What then is left is
violated where times are exact, and otherwise undecided. Times are those of the kinds of moves: where
these reckon without wind and accelerations, so does this check, and only waits for each other are proof.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import pairwise
from math import inf

import numpy as np
import shapely

from mmrs_core.analysis.distance import Floats, paired_distances
from mmrs_core.analysis.figures import MissingFigureError
from mmrs_core.analysis.motion import motions
from mmrs_core.analysis.occupations import Occupation, occupations_of
from mmrs_core.analysis.order import HappensBefore
from mmrs_core.analysis.times import times_of
from mmrs_core.analysis.verdicts import TOLERANCE, Gap, unknown, unknown_moves
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict
from mmrs_core.scene import Position

NAME = "separation"

FINEST = 0.01
"""Seconds: stretches of time that are no longer are not divided further."""

MOST_STRETCHES = 200
"""So many stretches too near, none of them certain, are enough to leave it undecided."""


@dataclass(frozen=True, slots=True)
class Encounter:
    """Two occupations that come too near, `apart` metres at a time; `needed` would do.

    Attributes:
        decided: whether both robots are certainly there at that time.
    """

    one: Occupation
    other: Occupation
    time: float
    apart: float
    needed: float
    decided: bool


def _run(input: CheckInput) -> Iterator[Verdict]:
    if input.program.minimum_separation is None:
        yield Verdict(NAME, Status.NOT_CHECKED, message="no minimum separation is asked for")
        return
    occupations: list[Occupation] = []
    undecided = False
    for robot in input.program.robots:
        try:
            occupations += occupations_of(input, robot)
        except MissingFigureError as missing:
            undecided = True
            yield unknown(NAME, robot, str(missing))
            continue
        for gaps in _gaps(input, robot):
            undecided = True
            yield unknown_moves(NAME, robot, gaps)
    needed = input.program.minimum_separation + 2.0 * input.program.position_error
    encounters = _encounters(input, occupations, needed)
    worst = _worst(encounters)
    yield from (_verdict(input, encounter) for encounter in worst)
    if not worst and not undecided:
        yield Verdict(
            NAME, Status.SAFE, message=f"robots keep {needed:.2f} m apart wherever they may be at once"
        )


def _gaps(input: CheckInput, robot: RobotProgram) -> Iterator[list[Gap]]:
    gaps = motions(input)[robot.id].gaps
    if gaps:
        yield gaps


def _encounters(input: CheckInput, occupations: list[Occupation], needed: float) -> Iterator[Encounter]:
    order: HappensBefore | None = None
    for i, j in _near(occupations, needed):
        one, other = occupations[i], occupations[j]
        order = order or HappensBefore(input.program, times_of(input).dependencies)
        if not _ordered(order, one, other):
            yield from _meeting(one, other, needed)


def _near(occupations: list[Occupation], needed: float) -> list[tuple[int, int]]:
    """Return the pairs of different robots whose ways are too near and whose times overlap."""
    boxes = np.array([_box(each) for each in occupations]).reshape(-1, 4)
    shapes = shapely.box(*boxes.T)
    reach = needed + max((each.radius for each in occupations), default=0.0) * 2
    grown = shapely.box(*(boxes + np.array([-reach, -reach, reach, reach])).T)
    first, second = shapely.STRtree(shapes).query(grown)
    found = dict.fromkeys(
        (int(i), int(j))
        for i, j in zip(first, second, strict=True)
        if i < j and _may_meet(occupations[i], occupations[j])
    )
    return [
        (i, j)
        for i, j in found
        if _apart(occupations[i].points, occupations[j].points)
        < _needed(occupations[i], occupations[j], needed)
    ]


def _may_meet(one: Occupation, other: Occupation) -> bool:
    return one.robot != other.robot and max(one.begin, other.begin) < min(one.end, other.end)


def _needed(one: Occupation, other: Occupation, needed: float) -> float:
    return needed + one.radius + other.radius - TOLERANCE


def _ordered(order: HappensBefore, one: Occupation, other: Occupation) -> bool:
    return order.is_over((one.robot, one.move), one.waiting, (other.robot, other.move)) or order.is_over(
        (other.robot, other.move), other.waiting, (one.robot, one.move)
    )


def _meeting(one: Occupation, other: Occupation, needed: float) -> Iterator[Encounter]:
    """Yield the nearest encounter that is certain, or else the nearest of all.

    The time that both may be there is halved, always where the parts of the ways are nearest to each
    other, until they are far enough apart or the time is short.
    """
    required = _needed(one, other, needed)
    begin, end = _common_time(one, other)
    pending = [(_apart(one.between(begin, end), other.between(begin, end)), begin, end)]
    nearest: Encounter | None = None
    left = MOST_STRETCHES if _certain_together(one, other) else 1
    while pending and left and pending[0][0] < required:
        apart, begin, end = heappop(pending)
        if end - begin > FINEST:
            middle = (begin + end) / 2
            for half in ((begin, middle), (middle, end)):
                heappush(pending, (_apart(one.between(*half), other.between(*half)), *half))
            continue
        decided = _certainly(one, begin, end) and _certainly(other, begin, end)
        if decided:
            apart = _apart_moving(one, other, begin, end)
            if apart >= required:
                continue
        left -= 1
        found = Encounter(one, other, begin, apart - one.radius - other.radius, needed, decided)
        if decided:
            yield found
            return
        nearest = nearest or found
    if nearest is not None:
        yield nearest


def _apart_moving(one: Occupation, other: Occupation, begin: float, end: float) -> float:
    """Return how near two robots come whose places are known at the begin and the end of a short time."""
    first = np.subtract(one.between(begin, begin)[0], other.between(begin, begin)[0])
    last = np.subtract(one.between(end, end)[0], other.between(end, end)[0])
    return _apart((tuple(first), tuple(last)), ((0.0, 0.0, 0.0),))


def _common_time(one: Occupation, other: Occupation) -> tuple[float, float]:
    """Return when both may be there; where there is no end, until both may have come everywhere."""
    begin, end = max(one.begin, other.begin), min(one.end, other.end)
    return begin, end if end < inf else begin + max(FINEST, sum(one.least), sum(other.least))


def _certain_together(one: Occupation, other: Occupation) -> bool:
    begin, end = (max(one.certain[0], other.certain[0]), min(one.certain[1], other.certain[1]))
    return begin <= end + TOLERANCE


def _certainly(occupation: Occupation, begin: float, end: float) -> bool:
    return occupation.certain[0] - TOLERANCE <= begin and end <= occupation.certain[1] + TOLERANCE


def _apart(one: tuple[Position, ...], other: tuple[Position, ...]) -> float:
    p, q = _pieces(one)
    c, d = _pieces(other)
    return float(paired_distances(p[:, None], q[:, None], c[None], d[None]).min())


def _pieces(points: tuple[Position, ...]) -> tuple[Floats, Floats]:
    line = points if len(points) > 1 else points * 2
    ends = np.array(list(pairwise(line)))
    return ends[:, 0], ends[:, 1]


def _box(occupation: Occupation) -> tuple[float, float, float, float]:
    east = [point[0] for point in occupation.points]
    north = [point[1] for point in occupation.points]
    return min(east), min(north), max(east), max(north)


def _worst(encounters: Iterator[Encounter]) -> list[Encounter]:
    """Return, for each two robots, the encounter that says most: a decided one, then the nearest."""
    worst: dict[tuple[str, str], Encounter] = {}
    for encounter in encounters:
        pair = (encounter.one.robot, encounter.other.robot)
        known = worst.get(pair)
        if known is None or (not encounter.decided, encounter.apart) < (not known.decided, known.apart):
            worst[pair] = encounter
    return list(worst.values())


def _verdict(input: CheckInput, encounter: Encounter) -> Verdict:
    one, other = encounter.one, encounter.other
    move = input.program.robot(one.robot).moves[one.move]
    meeting = input.program.robot(other.robot).moves[other.move]
    words = (
        f"{one.robot}: {_words(one)} '{move.id}' is {max(0.0, encounter.apart):.2f} m from {other.robot}"
        f" {_words(other)} '{meeting.id}' at {encounter.time:.1f} s, {encounter.needed:.2f} m are required"
    )
    status = Status.VIOLATED if encounter.decided else Status.UNKNOWN
    if status is Status.UNKNOWN:
        words += "; times are not certain enough: let one wait for the other, or lead them apart"
    margin = encounter.apart - encounter.needed
    return Verdict(NAME, status, one.robot, margin, "m", move.id, message=words, place=move.place)


def _words(occupation: Occupation) -> str:
    return "after" if occupation.waiting else "on"


SEPARATION = Check(
    name=NAME,
    title="Robots that are under way at the same time keep the minimum separation.",
    run=_run,
    hint="let one task wait for the other, move the homes apart, or lower minimumSeparation",
)
