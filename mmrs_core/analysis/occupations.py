"""Which space robots take up, and when: what two of them must not do at once.

An occupation is a way along which a robot moves, or a place at which it acts or waits, with the
earliest time at which it may come there and the latest at which it may still be there. Robots on the
ground, before launching and after landing, and robots that stand at their homes take up none: how near
homes are to each other is the operator's choice.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from math import dist, hypot, inf

from mmrs_core.analysis.durations import Span
from mmrs_core.analysis.figures import kinematics_of
from mmrs_core.analysis.motion import Leg, motions
from mmrs_core.analysis.states import GROUNDED, States, states_of
from mmrs_core.analysis.times import Times, times_of
from mmrs_core.behaviour.program import Move, RobotProgram
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.scene import Kinematics, Position

HOME_SPOT = 0.1
"""Metres from its home within which a robot that stands takes no room: nobody keeps away from homes."""


@dataclass(frozen=True, slots=True)
class Occupation:
    """One movement of a robot, or what it does where it stands before or after it.

    Attributes:
        robot, move: whose it is; waiting: whether it comes after the movement.
        points: the way, at least one point. radius: how far from it the robot may be, metres.
        begin: the earliest time at which the robot is there. end: the latest.
        least: seconds, for each leg of the way, that the robot takes at least: it is no faster than it
            is commanded to be, unless its moves' kind says that it may be.
        certain: from when to when the robot is there in every run that makes the move, and where it
            is known; the first exceeds the second if never.
    """

    robot: str
    move: int
    waiting: bool
    points: tuple[Position, ...]
    radius: float
    begin: float
    end: float
    least: tuple[float, ...]
    certain: tuple[float, float]

    def between(self, first: float, last: float) -> tuple[Position, ...]:
        """Return the part of the way on which the robot may be at some time between two times.

        It is no further than it can have come since the begin, and no further back than from where it
        can still come to the end in time.
        """
        whole = sum(self.least)
        ahead = min(whole, max(0.0, last - self.begin))
        behind = min(ahead, max(0.0, whole - max(0.0, self.end - first)))
        return self._part(behind, ahead)

    def _part(self, behind: float, ahead: float) -> tuple[Position, ...]:
        passed = [self._at(behind)]
        time = 0.0
        for corner, seconds in zip(self.points[1:], self.least, strict=False):
            time += seconds
            if behind < time < ahead:
                passed.append(corner)
        return (*passed, self._at(ahead))

    def _at(self, seconds: float) -> Position:
        """Return the point that is reached after so many seconds at full speed."""
        left = seconds
        for (a, b), whole in zip(pairwise(self.points), self.least, strict=False):
            if left < whole:
                part = left / whole
                return (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2]))
            left -= whole
        return self.points[-1]


def occupations_of(input: CheckInput, robot: RobotProgram) -> Iterator[Occupation]:
    """Yield what one robot occupies.

    Raises:
        MissingFigureError: its kinematics are not known.
    """
    kinematics = kinematics_of(input, robot)
    states, times = states_of(input, robot), times_of(input)
    legs: dict[int, list[Leg]] = defaultdict(list)
    for leg in motions(input)[robot.id].legs:
        legs[leg.move].append(replace(leg, radius=leg.radius + kinematics.turning_radius))
    for index in sorted(states.before):
        if (robot.id, index) in times.earliest and not states.only_grounded(index):
            for leg in legs[index]:
                yield from _occupations(robot, leg, times, states, kinematics)


def _occupations(
    robot: RobotProgram, leg: Leg, times: Times, states: States, kinematics: Kinematics
) -> Iterator[Occupation]:
    """Yield where a robot stands before a movement, the movement, and where it stands after it."""
    duration = times.durations[robot.id].of[leg.move]
    begin = Span(times.earliest[robot.id, leg.move], times.latest.get((robot.id, leg.move), inf))
    leave, arrive = begin + duration.before, begin + duration.moved
    if len(leg.points) == 1:
        arrive = begin
    elif leave.high > begin.low and not _at_home(robot, leg.points[0]):
        yield _stand(robot, leg, begin, leave, waiting=False)
    if len(leg.points) > 1:
        yield _movement(robot, leg, (leave, arrive), duration.moved.low - duration.before.low, kinematics)
    gone = _gone(robot, leg.move, times)
    standing = states.after[leg.move] != {GROUNDED} and not _at_home(robot, leg.points[-1])
    if standing and gone.high > arrive.low:
        yield _stand(robot, leg, arrive, gone, waiting=True)


def _at_home(robot: RobotProgram, place: Position) -> bool:
    return robot.home is not None and dist(place, robot.home) <= HOME_SPOT


def _gone(robot: RobotProgram, move: int, times: Times) -> Span:
    """Return when a robot goes on after a move."""
    transition = robot.transitions.get(move)
    if transition is None:
        return Span(inf, inf)
    earliest = min((times.earliest.get((robot.id, way), inf) for way in transition.ways), default=inf)
    latest = max(times.latest_end(robot.id, move), times.latest_release(robot, transition.waits))
    return Span(max(earliest, times.earliest_end(robot.id, move)), latest)


def _stand(robot: RobotProgram, leg: Leg, come: Span, go: Span, *, waiting: bool) -> Occupation:
    place = leg.points[-1] if waiting else leg.points[0]
    certain = (come.high, go.low) if leg.radius == 0.0 else (inf, -inf)
    return Occupation(robot.id, leg.move, waiting, (place,), leg.radius, come.low, go.high, (), certain)


def _movement(
    robot: RobotProgram, leg: Leg, times: tuple[Span, Span], quickest: float, kinematics: Kinematics
) -> Occupation:
    leave, arrive = times
    least = _least_seconds(leg.points, robot.moves[leg.move], kinematics)
    if quickest < sum(least):
        least = tuple(seconds * quickest / sum(least) for seconds in least)
    pinned = leg.radius == 0.0 and arrive.high - leave.low <= sum(least) + 1e-6
    return Occupation(
        robot=robot.id,
        move=leg.move,
        waiting=False,
        points=leg.points,
        radius=leg.radius,
        begin=leave.low,
        end=arrive.high,
        least=least,
        certain=(leave.low, arrive.high) if pinned else (inf, -inf),
    )


def _least_seconds(points: tuple[Position, ...], move: Move, kinematics: Kinematics) -> tuple[float, ...]:
    """Return how long each leg takes at the commanded speed, level and upright."""
    level = min(max(move.speed or kinematics.cruise, kinematics.slowest), kinematics.fastest)
    seconds = []
    for a, b in pairwise(points):
        rise = b[2] - a[2]
        upright = rise / kinematics.climb if rise > 0 else -rise / kinematics.descent
        seconds.append(max(hypot(b[0] - a[0], b[1] - a[1]) / level, upright) if dist(a, b) else 0.0)
    return tuple(seconds)
