"""Where planned robots may be, and when: the paths and stays of their steps, within spans of time.

A robot need not go steadily along a path: it speeds up, slows down, and may be quicker than planned
wherever it need not turn, or takes the shorter arm of a choice. All that is certain is when it may
begin at the earliest, when it has come to the end at the latest, and that it is nowhere faster than
commanded. Robots on the ground and at home take up their places too, from before the first moment
until after the last.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from itertools import groupby, pairwise
from math import dist, hypot, inf

from mmrs_core.errors import InternalError
from mmrs_core.planning.layers import Rates
from mmrs_core.planning.strokes import NEAR, action_seconds, rates_of, stops_of, uncertain_seconds
from mmrs_core.planning.travel import kinematics_of
from mmrs_core.scene import (
    Await,
    Branch,
    Launch,
    Plan,
    Position,
    Recover,
    Robot,
    Serve,
    Signal,
    Step,
    Transit,
)


class HomeRelation(IntEnum):
    """Where a ride is, seen from the robot's own home."""

    ELSEWHERE = 0
    COLUMN = 1
    """Upright over its home: part of a launch or a recovery."""
    HOME = 2
    """A stay at its home."""


@dataclass(frozen=True, slots=True)
class Ride:
    """A path, or a stay at one place.

    Attributes:
        points: at least one; several: straight legs between them.
        early: seconds at which it may begin, -inf where the robot is from the start; late: by which it
            has ended, inf where it stays to the end.
        least: seconds of each leg at even speed, which the robot does not exceed.
        radius: metres from the path within which the robot may be.
        relation: whether it is at or over the robot's own home.
    """

    points: tuple[Position, ...]
    early: float
    late: float
    least: tuple[float, ...] = ()
    radius: float = 0.0
    relation: HomeRelation = HomeRelation.ELSEWHERE


def rides_of(plan: Plan, robots: Mapping[str, Robot]) -> dict[str, tuple[Ride, ...]]:
    """Return the rides of every robot, all arms of choices included.

    Whatever a robot does last, it then stays where it is; robots without steps stay at home.
    """
    walks = {
        each.robot: _Walk(robots[each.robot], rates_of_robot(robots[each.robot])) for each in plan.robots
    }
    left = {each.robot: list(each.steps) for each in plan.robots}
    given: dict[str, float] = {}
    while any(left.values()):
        before = sum(map(len, left.values()))
        for name, steps in left.items():
            while steps and walks[name].may_begin(steps[0], given):
                walks[name].add(steps.pop(0), given)
        if sum(map(len, left.values())) == before:
            raise InternalError("robots of a plan wait for each other")
    for walk in walks.values():
        walk.stay_to_the_end()
    return {name: tuple(walk.rides) for name, walk in walks.items()}


def rates_of_robot(robot: Robot) -> Rates:
    """Return the rates of a robot at its cruise."""
    kinematics = kinematics_of(robot)
    return rates_of(kinematics, kinematics.cruise)


@dataclass(slots=True)
class _Walk:
    """One robot in its steps, as early as it may be.

    Attributes:
        now: seconds; here: where it is; radius: how far from there it may be.
        gone: whether it has gone anywhere yet.
    """

    robot: Robot
    rates: Rates
    rides: list[Ride] = field(default_factory=list)
    now: float = 0.0
    here: Position = (0.0, 0.0, 0.0)
    radius: float = 0.0
    gone: bool = False

    def __post_init__(self) -> None:
        self.here = self.robot.home

    def may_begin(self, step: Step, given: Mapping[str, float]) -> bool:
        return not isinstance(step, Await) or all(signal in given for signal in step.signals)

    def add(self, step: Step, given: dict[str, float]) -> None:
        if isinstance(step, Await):
            self._await(step, given)
        elif isinstance(step, Signal):
            given[step.signal] = self.now
        elif isinstance(step, Branch):
            self._branch(step, given)
        elif isinstance(step, Serve):
            self._serve(step)
        elif isinstance(step, Transit):
            self._transit(step)
        elif isinstance(step, Launch | Recover):
            self._upright(step)
        else:
            self._stay(step.end - step.begin, step.end)

    def stay_to_the_end(self) -> None:
        self._stay(0.0, inf)

    def _upright(self, step: Launch | Recover) -> None:
        column = self.here, (step.at[0], step.at[1], step.up)
        over_home = all(dist(point[:2], self.robot.home[:2]) <= NEAR for point in column)
        relation = HomeRelation.COLUMN if over_home else HomeRelation.ELSEWHERE
        self._ride(column, step.end - step.begin, step.end, relation=relation)

    def _await(self, step: Await, given: Mapping[str, float]) -> None:
        own = self.now + (0.0 if step.until is None else max(0.0, step.until - step.begin))
        self._stay(max([own, *(given[signal] for signal in step.signals)]) - self.now, step.end)

    def _branch(self, step: Branch, given: dict[str, float]) -> None:
        """Take every arm; continue as soon as the quickest one may."""
        begin, ends = (self.now, self.here, self.radius), []
        for _, arm in step.arms:
            self.now, self.here, self.radius = begin
            for inner in arm:
                self.add(inner, given)
            self._stay(0.0, step.end)
            ends.append(self.now)
        self.now, self.here = min(ends), step.exit

    def _transit(self, step: Transit) -> None:
        rates = self.rates if step.speed is None else rates_of(kinematics_of(self.robot), step.speed)
        legs = list(pairwise(step.route))
        late = step.begin
        for points in _moves_along(legs):
            late += sum(rates.from_stop_to_stop(one, two) for one, two in pairwise(points))
            least = sum(rates.straight_on().from_stop_to_stop(one, two) for one, two in pairwise(points))
            self._ride(points, least, late, rates)
        self.radius = 0.0

    def _serve(self, step: Serve) -> None:
        rates = rates_of(kinematics_of(self.robot), step.speed)
        todo, done, late = list(step.stroke.actions), 0.0, step.begin
        for place in stops_of(step.stroke):
            done += dist(self.here, place)
            late += rates.from_stop_to_stop(self.here, place)
            if place != self.here:
                least = rates.straight_on().from_stop_to_stop(self.here, place)
                self._ride((self.here, place), least, late, rates)
            while todo and todo[0].at <= done + NEAR:
                acting = action_seconds(self.robot.type, todo.pop(0))
                late += acting
                self._stay(acting, late)
        if step.stroke.object is not None:
            self.radius = step.stroke.object_tolerance or 0.0
        certain = step.end - late - uncertain_seconds(step.stroke, kinematics_of(self.robot))
        self._stay(max(0.0, certain), step.end)

    def _ride(
        self,
        points: tuple[Position, ...],
        seconds: float,
        late: float,
        rates: Rates | None = None,
        *,
        relation: HomeRelation = HomeRelation.ELSEWHERE,
    ) -> None:
        least = tuple((rates or self.rates).leg(one, two) for one, two in pairwise(points))
        self.rides.append(Ride(points, self.now, late, least, self.radius, relation))
        self.now, self.here, self.gone = self.now + seconds, points[-1], True

    def _stay(self, seconds: float, late: float) -> None:
        """Stay for so long at least; what comes next may begin then, or as late as `late`."""
        if late > self.now:
            relation = (
                HomeRelation.HOME if dist(self.here, self.robot.home) <= NEAR else HomeRelation.ELSEWHERE
            )
            early = self.now if self.gone else -inf
            self.rides.append(Ride((self.here,), early, late, (), self.radius, relation))
        self.now += seconds


def _moves_along(legs: Sequence[tuple[Position, Position]]) -> Iterator[tuple[Position, ...]]:
    """Yield the legs of a route, upright and level ones in a row together.

    A robot kind may make one move of these, during which the time at the corner is unknown.
    """
    for _, run in groupby(enumerate(legs), key=lambda pair: pair[0] if _slopes(*pair[1]) else -1):
        joined = [leg for _, leg in run]
        if len(joined) == 1 or not any(_upright(*leg) for leg in joined):
            yield from joined
        else:
            yield (joined[0][0], *(two for _, two in joined))


def _upright(one: Position, two: Position) -> bool:
    return hypot(two[0] - one[0], two[1] - one[1]) <= NEAR


def _slopes(one: Position, two: Position) -> bool:
    return abs(two[2] - one[2]) > NEAR and not _upright(one, two)
