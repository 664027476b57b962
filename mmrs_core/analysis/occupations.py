"""Which space robots take up, and when: what two of them must not do at once.

An occupation is a path along which a robot moves, or a place at which it stands, acts or waits, with the
earliest time at which it may come there and the latest at which it may still be there. A robot occupies
its place from the first moment to the last: on the ground before it launches and after it has landed,
at its home, and after its Stop.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import dist, hypot, inf

from mmrs_core.analysis.clearance import Piece, stops
from mmrs_core.analysis.durations import Span
from mmrs_core.analysis.figures import kinematics_of
from mmrs_core.analysis.motion import MovePath, motions
from mmrs_core.analysis.states import GROUNDED, States, states_of
from mmrs_core.analysis.times import Times, times_of
from mmrs_core.behaviour.program import Move, RobotProgram
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.scene import Kinematics, Position
from mmrs_core.scene.robots import BACK_SECONDS

HOME_SPOT = 0.1
"""Metres from its home within which a robot stands there, from the axis of its column within which it is
in it, and from each other within which two homes are one place."""


@dataclass(frozen=True, slots=True)
class Column:
    """What is straight over a robot's home, up to the transit altitude.

    Homes may be nearer to each other than robots must keep in flight. Robots that stand at such homes are
    excused, and so is one that rises or descends straight over its own while the other stands at its own,
    as long as their distance is at least that of their homes. Nothing else is: neither two that rise side
    by side, nor one that comes to another's home, nor any two whose homes are at one position.

    Attributes:
        home: the foot.
        ceiling: the lowest height at which the robot enters or leaves the column sideways; inf if it
            never does.
    """

    home: Position
    ceiling: float

    def at_foot(self, place: Position) -> bool:
        """Return whether a robot that stands there stands at its home."""
        return dist(place, self.home) <= HOME_SPOT

    def contains(self, points: Iterable[Position]) -> bool:
        """Return whether a path is straight over the home, at whatever height."""
        return all(self._aside(point) <= HOME_SPOT for point in points)

    def above_ceiling(self, points: tuple[Position, ...]) -> tuple[Position, ...]:
        """Return the part above the ceiling of a path in the column; empty if there is none.

        At the transit height itself a path is still below.
        """
        highest = max(point[2] for point in points)
        if highest <= self.ceiling:
            return ()
        lowest = max(self.ceiling, min(point[2] for point in points))
        return tuple((points[0][0], points[0][1], height) for height in (lowest, highest))

    def _aside(self, point: Position) -> float:
        return hypot(point[0] - self.home[0], point[1] - self.home[1])


def column_over(home: Position, paths: Iterable[tuple[Position, ...]]) -> Column:
    """Return the column over a home, up to the lowest height at which one of the paths crosses its side."""
    column = Column(home, inf)
    crossings = (
        _lowest_near_axis(home, a, b)
        for path in paths
        for a, b in pairwise(path)
        if not column.contains((a, b))
    )
    return Column(home, min(crossings, default=inf))


def _lowest_near_axis(home: Position, a: Position, b: Position) -> float:
    """Return the least height of a leg within the column; inf if it does not come into it."""
    east, north = a[0] - home[0], a[1] - home[1]
    along = (b[0] - a[0], b[1] - a[1])
    square = along[0] ** 2 + along[1] ** 2
    if square == 0.0:
        return min(a[2], b[2]) if hypot(east, north) <= HOME_SPOT else inf
    middle = -(east * along[0] + north * along[1]) / square
    aside = HOME_SPOT**2 - (east + middle * along[0]) ** 2 - (north + middle * along[1]) ** 2
    if aside < 0.0:
        return inf
    half = (aside / square) ** 0.5
    first, last = max(0.0, middle - half), min(1.0, middle + half)
    return min(a[2] + part * (b[2] - a[2]) for part in (first, last)) if first <= last else inf


@dataclass(frozen=True, slots=True)
class Occupation:
    """One movement of a robot, or what it does where it stands before or after it.

    Attributes:
        robot, move: whose it is; waiting: whether it comes after the movement.
        points: the path, at least one point. radius: how far from it the robot may be, metres.
        begin: the earliest time at which the robot is there. end: the latest.
        least: seconds, for each leg of the path, that the robot takes at least: it is no faster than it
            is commanded to be, unless its moves' kind says that it may be.
        certain: from when to when the robot is there in every run that makes the move, within the
            radius of a place that is known; the first exceeds the second if never.
        column: the one over its home, where its home is known.
        leaves_by: the moves with whose begin a stand ends; none if it has no end, or is not a wait.
        overshot: whether it is the stretch beyond the movement's end, on which the robot turns back.
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
    column: Column | None
    leaves_by: tuple[int, ...] = ()
    overshot: bool = False

    @property
    def stands(self) -> bool:
        """Whether the robot stands at one place all the time."""
        return len(self.points) == 1

    def between(self, first: float, last: float) -> tuple[Position, ...]:
        """Return the part of the path on which the robot may be at some time between two times.

        It is at most as far as it can have come since the begin, and far enough to come to the end in time.
        """
        if self.overshot:
            return self.points
        whole = sum(self.least)
        ahead = min(whole, max(0.0, last - self.begin))
        behind = min(ahead, max(0.0, whole - max(0.0, self.end - first)))
        return self.stretch(behind, ahead)

    def stretch(self, behind: float, ahead: float) -> tuple[Position, ...]:
        """Return the part of the path between two numbers of seconds at full speed from its begin."""
        passed = [self._at(behind)]
        time = 0.0
        for corner, seconds in zip(self.points[1:], self.least, strict=False):
            time += seconds
            if behind < time < ahead:
                passed.append(corner)
        return (*passed, self._at(ahead))

    def _at(self, seconds: float) -> Position:
        """Return the point that is reached after `seconds` at full speed."""
        left = seconds
        for (a, b), whole in zip(pairwise(self.points), self.least, strict=False):
            if left < whole:
                part = left / whole
                return (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2]))
            left -= whole
        return self.points[-1]


def occupations_of(input: CheckInput, robot: RobotProgram) -> Iterator[Occupation]:
    """Yield what one robot occupies, from the first moment to the last.

    Raises:
        MissingFigureError: its kinematics are not known.
    """
    kinematics = kinematics_of(input, robot)
    states, times = states_of(input, robot), times_of(input)
    legs: dict[int, list[MovePath]] = defaultdict(list)
    motion = motions(input)[robot.id]
    for leg in motion.paths:
        legs[leg.move].append(leg)
    beyond: dict[int, list[Piece]] = defaultdict(list)
    for piece in stops(input, robot, motion):
        beyond[piece[2]].append(piece)
    paths = (leg.points for of_move in legs.values() for leg in of_move)
    column = column_over(robot.home, paths) if robot.home is not None else None
    for index in sorted(states.before):
        if (robot.id, index) in times.earliest:
            for leg in legs[index]:
                yield from _occupations(robot, leg, times, states, kinematics, column)
            for piece in beyond[index]:
                last = any(piece[0] == leg.points[-1] for leg in legs[index])
                yield _overshot(robot, piece, times, column, last=last)


def _occupations(
    robot: RobotProgram,
    leg: MovePath,
    times: Times,
    states: States,
    kinematics: Kinematics,
    column: Column | None,
) -> Iterator[Occupation]:
    """Yield where a robot stands before a movement, the movement, and where it stands after it."""
    duration = times.durations[robot.id].of[leg.move]
    begin = Span(times.earliest[robot.id, leg.move], times.latest.get((robot.id, leg.move), inf))
    leave, arrive = begin + duration.before, begin + duration.moved
    circle = kinematics.turning_radius
    if len(leg.points) == 1:
        arrive = begin
    elif leave.high > begin.low:
        around = 0.0 if states.before[leg.move] == {GROUNDED} else circle
        yield _stand(robot, leg, (begin, leave), around, column, waiting=False)
    if len(leg.points) > 1:
        quickest = duration.moved.low - duration.before.low
        yield _movement(robot, leg, (leave, arrive), quickest, kinematics, column)
    gone = _gone(robot, leg.move, times)
    if gone.high > arrive.low:
        still = leg.move == robot.start or leg.move not in robot.transitions
        around = 0.0 if still or states.after[leg.move] == {GROUNDED} else circle
        yield _stand(robot, leg, (arrive, gone), around, column, waiting=True)


def _gone(robot: RobotProgram, move: int, times: Times) -> Span:
    transition = robot.transitions.get(move)
    if transition is None:
        return Span(inf, inf)
    earliest = min(
        (times.earliest.get((robot.id, after), inf) for after in transition.next_moves), default=inf
    )
    latest = max(times.latest_end(robot.id, move), times.latest_release(robot, transition.waits))
    return Span(max(earliest, times.earliest_end(robot.id, move)), latest)


def _stand(
    robot: RobotProgram,
    leg: MovePath,
    times: tuple[Span, Span],
    around: float,
    column: Column | None,
    *,
    waiting: bool,
) -> Occupation:
    """Return a stand, within which the robot may turn about a circle of the radius `around`."""
    come, go = times
    radius = leg.radius + around
    transition = robot.transitions.get(leg.move) if waiting else None
    return Occupation(
        robot=robot.id,
        move=leg.move,
        waiting=waiting,
        points=(leg.points[-1] if waiting else leg.points[0],),
        radius=radius,
        begin=come.low,
        end=go.high,
        least=(),
        certain=(come.high, go.low),
        column=column,
        leaves_by=tuple(transition.next_moves) if transition is not None else (),
    )


def _movement(
    robot: RobotProgram,
    leg: MovePath,
    times: tuple[Span, Span],
    quickest: float,
    kinematics: Kinematics,
    column: Column | None,
) -> Occupation:
    leave, arrive = times
    least = _least_seconds(leg.points, robot.moves[leg.move], kinematics)
    if quickest < sum(least):
        least = tuple(seconds * quickest / sum(least) for seconds in least)
    radius = leg.radius + kinematics.turning_radius
    pinned = radius == 0.0 and arrive.high - leave.low <= sum(least) + 1e-6
    return Occupation(
        robot=robot.id,
        move=leg.move,
        waiting=False,
        points=leg.points,
        radius=radius,
        begin=leave.low,
        end=arrive.high,
        least=least,
        certain=(leave.low, arrive.high) if pinned else (inf, -inf),
        column=column,
    )


def _overshot(
    robot: RobotProgram, piece: Piece, times: Times, column: Column | None, *, last: bool
) -> Occupation:
    """Return where a robot goes beyond the end of a leg, before or just after its movement counts as over.

    Only the `last` leg of a movement ends when that does; earlier ones may end as soon as it has begun.
    What is done before the movement is done where it begins.
    """
    target, turns_back, move, radius = piece
    duration = times.durations[robot.id].of[move]
    ahead = max(duration.before.low, duration.moved.low - BACK_SECONDS if last else 0.0)
    return Occupation(
        robot=robot.id,
        move=move,
        waiting=False,
        points=(target, turns_back),
        radius=radius,
        begin=times.earliest[robot.id, move] + ahead,
        end=times.latest.get((robot.id, move), inf) + duration.moved.high + BACK_SECONDS,
        least=(0.0,),
        certain=(inf, -inf),
        column=column,
        overshot=True,
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
