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
from typing import TypeAlias

from mmrs_core.errors import InternalError
from mmrs_core.planning.strokes import NEAR, action_seconds, stops_of, uncertain_seconds
from mmrs_core.planning.travel import kinematics_of
from mmrs_core.scene import (
    Await,
    Branch,
    Kinematics,
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
from mmrs_core.scene.robots import BACK_SECONDS
from mmrs_core.scene.timing import Rates, acting, bounded, noticing

_Given: TypeAlias = tuple[float, float]
"""Seconds at which a signal is given at the earliest, and at the latest."""


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
        least: seconds that each leg takes at least.
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
    walks = {each.robot: _Walk(robots[each.robot], kinematics_of(robots[each.robot])) for each in plan.robots}
    left = {each.robot: list(each.steps) for each in plan.robots}
    given: dict[str, _Given] = {}
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


@dataclass(slots=True)
class _Walk:
    """One robot in its steps, as early and as late as it may be.

    Attributes:
        now: seconds at which it is there at the earliest; by: at the latest.
        here: where it is; radius: how far from there it may be.
        gone: whether it has gone anywhere yet.
    """

    robot: Robot
    kinematics: Kinematics
    rides: list[Ride] = field(default_factory=list)
    now: float = 0.0
    by: float = 0.0
    here: Position = (0.0, 0.0, 0.0)
    radius: float = 0.0
    gone: bool = False

    def __post_init__(self) -> None:
        self.here, self.by = self.robot.home, noticing(self.kinematics.timing)

    def may_begin(self, step: Step, given: Mapping[str, _Given]) -> bool:
        return not isinstance(step, Await) or all(signal in given for signal in step.signals)

    def add(self, step: Step, given: dict[str, _Given]) -> None:
        if isinstance(step, Await):
            self._await(step, given)
        elif isinstance(step, Signal):
            self._pause()
            given[step.signal] = (self.now, self.by)
        elif isinstance(step, Branch):
            self._branch(step, given)
        elif isinstance(step, Serve):
            self._serve(step)
        elif isinstance(step, Transit):
            self._transit(step)
        elif isinstance(step, Launch | Recover):
            self._upright(step)
        else:
            charging = self.kinematics.charging_time(step.end - step.begin)
            self._stay(charging.shortest, charging.longest)

    def stay_to_the_end(self) -> None:
        self.by = inf
        self._stay(0.0)

    def _upright(self, step: Launch | Recover) -> None:
        column = self.here, (step.at[0], step.at[1], step.up)
        over_home = all(dist(point[:2], self.robot.home[:2]) <= NEAR for point in column)
        relation = HomeRelation.COLUMN if over_home else HomeRelation.ELSEWHERE
        seconds = bounded(step.end - step.begin, self.kinematics.timing)
        self._ride(column, seconds.shortest, seconds.longest, self.kinematics.rates(), relation=relation)

    def _await(self, step: Await, given: Mapping[str, _Given]) -> None:
        waits = 0.0 if step.until is None else max(0.0, step.until - step.begin)
        noticed = 0.0 if step.until is None else noticing(self.kinematics.timing)
        early, late = self.now + waits, max(self.by + waits, step.end) + noticed
        self.by = max([late, *(given[signal][1] for signal in step.signals)])
        self._stay(max([early, *(given[signal][0] for signal in step.signals)]) - self.now, 0.0)

    def _branch(self, step: Branch, given: dict[str, _Given]) -> None:
        """Take every arm; continue as soon as the quickest one may."""
        self._pause()
        begin, ends, latest = (self.now, self.by, self.here, self.radius), [], step.end
        for _, arm in step.arms:
            self.now, self.by, self.here, self.radius = begin
            for inner in arm:
                self.add(inner, given)
            if not arm:
                self._pause()
            latest = max(latest, self.by)
            ends.append((self.now, self.here, self.radius))
        for self.now, self.here, self.radius in ends:
            self.by = latest
            self._stay(0.0)
        self.now, self.here = min(now for now, _, _ in ends), step.exit

    def _transit(self, step: Transit) -> None:
        rates = self.kinematics.rates(step.speed)
        for points in _moves_along(list(pairwise(step.route))):
            self._go(points, rates, step.speed)
        self.radius = 0.0

    def _serve(self, step: Serve) -> None:
        rates, timing = self.kinematics.rates(step.speed), self.kinematics.timing
        todo, done, planned = list(step.stroke.commands), 0.0, 0.0
        if step.stroke.object is not None:
            self.radius = step.stroke.object_tolerance or 0.0
        for place in stops_of(step.stroke):
            done += dist(self.here, place)
            planned += rates.from_stop_to_stop(self.here, place)
            if place != self.here:
                self._go((self.here, place), rates, step.speed)
            while todo and todo[0].at <= done + NEAR:
                found = acting(action_seconds(self.robot.type, todo.pop(0)), timing)
                planned += found.expected
                self._stay(found.shortest, found.longest)
        left = step.end - step.begin - planned
        uncertain = uncertain_seconds(step.stroke, self.kinematics)
        holds = step.stroke.hold > 0.0 or len(step.stroke.points) == 1 or step.stroke.object is not None
        late = timing.spread * uncertain + (noticing(timing) if holds else 0.0)
        self._stay(max(0.0, left - uncertain), max(0.0, left) + late)

    def _go(self, points: tuple[Position, ...], rates: Rates, speed: float | None) -> None:
        soonest, latest = rates.soonest(), rates.latest()
        legs = list(pairwise(points))
        least = sum(soonest.from_stop_to_stop(*leg) for leg in legs)
        most = sum(latest.from_stop_to_stop(*leg) for leg in legs)
        slowest = min(rates.cruise, rates.climb, rates.descent)
        search = (self.radius / slowest if slowest > 0.0 else inf) if self.radius else 0.0
        early = self.now
        self._ride(points, max(0.0, least - search), most + search, rates)
        if self.kinematics.timing.overshoot > 0.0:
            self._overshoot(legs, early, speed or self.kinematics.cruise)

    def _overshoot(self, legs: Sequence[tuple[Position, Position]], early: float, speed: float) -> None:
        """Add where the robot turns back beyond the ends of legs, for as long as that may take."""
        soonest = self.kinematics.rates(speed).soonest()
        begin = early
        for one, two in legs:
            early += soonest.from_stop_to_stop(one, two)
            if not _upright(one, two):
                beyond = (two, self.kinematics.beyond(one, two, speed))
                since, until = max(begin, early - BACK_SECONDS), self.by + BACK_SECONDS
                self.rides.append(Ride(beyond, since, until, (0.0,), self.radius))

    def _ride(
        self,
        points: tuple[Position, ...],
        seconds: float,
        longest: float,
        rates: Rates,
        *,
        relation: HomeRelation = HomeRelation.ELSEWHERE,
    ) -> None:
        """Go along points for so long at least, and at most."""
        even = [rates.even(one, two) for one, two in pairwise(points)]
        share = min(1.0, seconds / sum(even)) if sum(even) else 1.0
        least = tuple(share * each for each in even)
        self.by += longest
        self.rides.append(Ride(points, self.now, self.by, least, self.radius, relation))
        self.now, self.here, self.gone = self.now + seconds, points[-1], True

    def _pause(self) -> None:
        """Stop on the spot, as behaviours may have to between two waits."""
        self._stay(0.0, noticing(self.kinematics.timing))

    def _stay(self, seconds: float, longest: float | None = None) -> None:
        """Stay for so long at least, and at most."""
        self.by += seconds if longest is None else longest
        if self.by > self.now:
            relation = (
                HomeRelation.HOME if dist(self.here, self.robot.home) <= NEAR else HomeRelation.ELSEWHERE
            )
            early = self.now if self.gone else -inf
            self.rides.append(Ride((self.here,), early, self.by, (), self.radius, relation))
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
