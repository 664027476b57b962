"""Where planned robots may be, and when: the paths and stays of their steps, within spans of time.

A robot need not go steadily along a path: it speeds up, slows down, and may be quicker than planned
wherever it need not turn, or takes the shorter arm of a choice. All that is certain is when it may
begin at the earliest, when it has come to the end at the latest, and that it is nowhere faster than
commanded. Robots on the ground and at home take up their places too, from before the first moment
until after the last.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import IntEnum
from itertools import pairwise
from math import dist, hypot, inf
from typing import TypeAlias

from mmrs_core.errors import InternalError
from mmrs_core.planning.strokes import NEAR, action_seconds, longest_end, stops_of, uncertain_seconds
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
from mmrs_core.scene.timing import Rates, acting, noticing

_Given: TypeAlias = tuple[float, float, Mapping[str, int]]
"""Seconds at which a signal is given at the earliest, and at the latest, and what is then known."""

_State: TypeAlias = tuple[Position, float, bool, bool, bool]
"""How a robot is: see the attributes of `_Walk` from `here` on."""

_Passages: TypeAlias = "dict[tuple[_State, tuple[object, ...]], _Passage]"

_Part: TypeAlias = "tuple[Sequence[Ride], float, float, int]"
"""Rides, seconds by which they begin later and end later than they say, and the index of their step."""

_Place: TypeAlias = "tuple[Position, float, float, float, HomeRelation]"
"""Where a robot stands: place, earliest and latest time, radius."""


_MOST_PASSAGES = 1000
"""Passages of a robot that are kept at most."""


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
        step: index of the plan's step that it belongs to; after the last step, their number.
        over: index of the step with whose begin it is over for certain.
    """

    points: tuple[Position, ...]
    early: float
    late: float
    least: tuple[float, ...] = ()
    radius: float = 0.0
    relation: HomeRelation = HomeRelation.ELSEWHERE
    step: int = 0
    over: int = 1


@dataclass(frozen=True, slots=True)
class Timeline:
    """Where one robot may be, and what it waits for.

    Attributes:
        parts: rides, each with what it is later by than they say, see `rides`.
        places: where it stands when each step begins, and after the last one, see `stops`.
        known: for each step, by other robot: the step that this one has begun at least by then.
        moments: seconds at which each step begins, and the last one ends, at the earliest and at the latest.
        states: how it is when each step begins, and after the last one.
    """

    parts: tuple[_Part, ...]
    places: tuple[_Place, ...]
    known: tuple[Mapping[str, int], ...]
    moments: tuple[tuple[float, float], ...]
    states: tuple[_State, ...]

    @property
    def rides(self) -> tuple[Ride, ...]:
        """Return the rides in order; whatever the robot does last, it then stays where it is."""
        return tuple(_rides(self.parts))

    @property
    def stops(self) -> tuple[Ride, ...]:
        """Return where the robot stands when each step begins, and after the last one."""
        return tuple(
            Ride((here,), early, late, (), radius, relation, step, step + 1)
            for step, (here, early, late, radius, relation) in enumerate(self.places)
        )


def _rides(parts: Iterable[_Part]) -> Iterator[Ride]:
    return (
        Ride(
            each.points,
            each.early + early,
            each.late + late,
            each.least,
            each.radius,
            each.relation,
            each.step + step,
            each.over + step,
        )
        for rides, early, late, step in parts
        for each in rides
    )


def timelines_of(
    plan: Plan,
    robots: Mapping[str, Robot],
    *,
    hasty: bool = False,
    longest: Callable[[str, Step], float] = lambda robot, step: 0.0,
) -> dict[str, Timeline]:
    """Return the timeline of every robot, as `Timelines` does of one plan after the other."""
    return Timelines(robots, hasty=hasty, longest=longest).of(plan)


class Timelines:
    """Makes the timelines of plans in which the same robots do much the same, at other times.

    How a robot goes through a step is the same whenever it begins it: so that is found once.
    """

    def __init__(
        self,
        robots: Mapping[str, Robot],
        *,
        hasty: bool = False,
        longest: Callable[[str, Step], float] = lambda robot, step: 0.0,
    ) -> None:
        """Make it.

        Args:
            robots: by name.
            hasty: whether charging may end before its declared time.
            longest: returns the seconds that a robot's step takes at most, if that may be more than by its
                legs.
        """
        self._robots, self._hasty, self._longest = robots, hasty, longest
        self._passages: dict[str, _Passages] = {name: {} for name in robots}

    def of(self, plan: Plan, names: Collection[str] | None = None) -> dict[str, Timeline]:
        """Return the timeline of every robot of a plan, all arms of choices included.

        Robots without steps stay at home.

        Args:
            plan: of all robots.
            names: of those that are asked for, to which those are added that these wait for; None: all.

        Raises:
            InternalError: robots wait for each other.
        """
        asked = None if names is None else _with_senders(plan, names)
        robots = [each for each in plan.robots if asked is None or each.robot in asked]
        walks = {each.robot: self._walk(each.robot) for each in robots}
        left = {each.robot: list(reversed(each.steps)) for each in robots}
        given: dict[str, _Given] = {}
        while any(left.values()):
            before = sum(map(len, left.values()))
            for name, steps in left.items():
                while steps and walks[name].may_begin(steps[-1], given):
                    walks[name].begin(steps.pop(), given)
            if sum(map(len, left.values())) == before:
                raise InternalError("robots of a plan wait for each other")
        return {name: walk.ended() for name, walk in walks.items()}

    def instead(self, name: str, timeline: Timeline, index: int, steps: Sequence[Step]) -> Iterator[Ride]:
        """Yield the rides of a robot that from a step on does other steps, in which it waits for no robot."""
        walk = self._walk(name)
        walk.state, (walk.now, walk.by) = timeline.states[index], timeline.moments[index]
        for step in steps:
            walk.begin(step, {})
        yield from (
            replace(each, step=each.step + index, over=each.over + index) for each in _rides(walk.parts)
        )

    def _walk(self, name: str) -> _Walk:
        robot = self._robots[name]
        return _Walk(robot, kinematics_of(robot), self._hasty, self._longest, self._passages[name])


def _with_senders(plan: Plan, names: Collection[str]) -> set[str]:
    """Return some robots of a plan and all whose signals they wait for, or wait for in turn."""
    steps = {each.robot: each.steps for each in plan.robots}
    senders = {step.signal: name for name, mine in steps.items() for step in mine if isinstance(step, Signal)}
    found, left = set[str](), [*names]
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            awaits = (step for step in steps[name] if isinstance(step, Await))
            left += (senders[signal] for step in awaits for signal in step.signals)
    return found


@dataclass(frozen=True, slots=True)
class _Passage:
    """How a robot goes through a step, whenever it begins it.

    Attributes:
        step: that it goes through, kept so that its key stays its own.
        rides: seconds and indices count from the begin of the step.
        early, late: seconds that it takes at least, and at most, as far as its moves tell.
        after: how the robot is then.
    """

    step: Step
    rides: tuple[Ride, ...]
    early: float
    late: float
    after: _State


def _key(step: Step) -> tuple[object, ...]:
    """Return what a step has in common with itself at another time; to be asked of steps that are kept."""
    seconds = round(step.end - step.begin, 6)
    match step:
        case Transit():
            return Transit, step.route, step.speed
        case Serve():
            return Serve, id(step.stroke), step.speed, seconds
        case Launch() | Recover():
            return type(step), step.at, step.up, seconds
        case _:
            return type(step), seconds


@dataclass(slots=True)
class _Walk:
    """One robot in its steps, as early and as late as it may be.

    Attributes:
        hasty, longest: see `Timelines`. passages: of steps that were gone through before.
        now: seconds at which it is there at the earliest; by: at the latest.
        here: where it is; radius: how far from there it may be.
        gone: whether it has gone anywhere yet. off: whether its motors are, as at home.
        merges: whether it comes from the arms of a choice, and must stop before it gives a signal.
        parts, places, known, moments, states: see `Timeline`.
    """

    robot: Robot
    kinematics: Kinematics
    hasty: bool
    longest: Callable[[str, Step], float]
    passages: _Passages
    now: float = 0.0
    by: float = 0.0
    here: Position = (0.0, 0.0, 0.0)
    radius: float = 0.0
    gone: bool = False
    off: bool = True
    merges: bool = False
    parts: list[_Part] = field(default_factory=list)
    places: list[_Place] = field(default_factory=list)
    moments: list[tuple[float, float]] = field(default_factory=list)
    states: list[_State] = field(default_factory=list)
    known: list[Mapping[str, int]] = field(default_factory=lambda: [{}])

    def __post_init__(self) -> None:
        self.here, self.by = self.robot.home, noticing(self.kinematics.timing)

    @property
    def state(self) -> _State:
        return self.here, self.radius, self.gone, self.off, self.merges

    @state.setter
    def state(self, state: _State) -> None:
        self.here, self.radius, self.gone, self.off, self.merges = state

    def may_begin(self, step: Step, given: Mapping[str, _Given]) -> bool:
        return not isinstance(step, Await) or all(signal in given for signal in step.signals)

    def begin(self, step: Step, given: dict[str, _Given]) -> None:
        self._arrive()
        self.add(step, given)
        self._learn(step.signals if isinstance(step, Await) else (), given)

    def _arrive(self) -> None:
        self.places.append((self.here, self._since(), self.by, self.radius, self._relation()))
        self.moments.append((self.now, self.by))
        self.states.append(self.state)

    def ended(self) -> Timeline:
        self._arrive()
        self.by = inf
        self._stay(0.0)
        return Timeline(
            tuple(self.parts), tuple(self.places), tuple(self.known), tuple(self.moments), tuple(self.states)
        )

    def add(self, step: Step, given: dict[str, _Given]) -> None:
        if isinstance(step, Await):
            self._await(step, given)
        elif isinstance(step, Signal):
            if self.merges:
                self._pause()
            place = self._place()
            given[step.signal] = (self.now, self.by, {**self.known[place], self.robot.name: place})
        elif isinstance(step, Branch):
            self._branch(step, given)
        else:
            self._pass(step)

    def _pass(self, step: Step) -> None:
        """Go through a step that takes as long whenever it begins."""
        key = self.state, _key(step)
        passage = self.passages.get(key)
        if passage is None:
            if len(self.passages) >= _MOST_PASSAGES:
                self.passages.clear()
            passage = self.passages[key] = self._passage(step)
        self.parts.append((passage.rides, self.now, self.by, self._place()))
        late = max(passage.late, self.longest(self.robot.name, step))
        self.now, self.by, self.state = self.now + passage.early, self.by + late, passage.after

    def _passage(self, step: Step) -> _Passage:
        """Return how the robot, as it is, goes through a step."""
        walk = replace(self, parts=[], places=[], moments=[], states=[], now=0.0)
        walk.by, walk.state = 0.0, self.state
        walk._arrive()
        walk._go_through(step)
        rides = tuple(ride for each in walk.parts for ride in each[0])
        return _Passage(step, rides, walk.now, walk.by, walk.state)

    def _go_through(self, step: Step) -> None:
        if isinstance(step, Serve):
            self._serve(step)
        elif isinstance(step, Transit):
            self._transit(step)
        elif isinstance(step, Launch | Recover):
            self._upright(step)
        else:
            charging = self.kinematics.charging_time(step.end - step.begin)
            self._stay(charging.shortest if self.hasty else charging.expected, charging.longest)
            self.off = True

    def _upright(self, step: Launch | Recover) -> None:
        column = self.here, (step.at[0], step.at[1], step.up)
        over_home = all(dist(point[:2], self.robot.home[:2]) <= NEAR for point in column)
        relation = HomeRelation.COLUMN if over_home else HomeRelation.ELSEWHERE
        seconds = self.kinematics.upright_bounds(step.end - step.begin)
        self._ride(column, [seconds.shortest], seconds.longest, self.kinematics.rates(), relation=relation)

    def _await(self, step: Await, given: Mapping[str, _Given]) -> None:
        waits = 0.0 if step.until is None else max(0.0, step.until - step.begin)
        noticed = 0.0 if step.until is None else noticing(self.kinematics.timing)
        early, late = self.now + waits, max(self.by + waits, step.end) + noticed
        self.by = max([late, *(given[signal][1] for signal in step.signals)])
        self._stay(max([early, *(given[signal][0] for signal in step.signals)]) - self.now, 0.0)

    def _learn(self, signals: Sequence[str], given: Mapping[str, _Given]) -> None:
        """Record what signals tell from the next step on: how far others have come."""
        known = dict(self.known[-1])
        for signal in signals:
            for name, step in given[signal][2].items():
                known[name] = max(step, known.get(name, 0))
        self.known.append(known)

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
        self.now, self.here, self.merges = min(now for now, _, _ in ends), step.exit, True

    def _transit(self, step: Transit) -> None:
        rates = self.kinematics.rates(step.speed)
        moves = list(moves_along(list(pairwise(step.route))))
        for number, points in enumerate(moves):
            self._go(points, rates, step.speed, last=number == len(moves) - 1)
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
        self._stay(max(0.0, left - uncertain), longest_end(step.stroke, self.kinematics))
        self.merges = False

    def _go(
        self, points: tuple[Position, ...], rates: Rates, speed: float | None, *, last: bool = True
    ) -> None:
        """Go along points; `last`: the next move, if there is one, is of the next step."""
        soonest, latest = rates.soonest(), rates.latest()
        legs = list(pairwise(points))
        least = [soonest.from_stop_to_stop(*leg) for leg in legs]
        most = sum(latest.from_stop_to_stop(*leg) for leg in legs)
        slowest = min(rates.cruise, rates.climb, rates.descent)
        search = (self.radius / slowest if slowest > 0.0 else inf) if self.radius else 0.0
        out = self.kinematics.setting_out().longest if self.off else 0.0
        self.off = False
        early = self.now
        self._ride(points, least, most + search + out, rates, search=search)
        if self.kinematics.timing.overshoot > 0.0:
            over = self._place() + (2 if last else 1)
            self._overshoot(legs, early, speed or self.kinematics.cruise, over)

    def _overshoot(
        self, legs: Sequence[tuple[Position, Position]], early: float, speed: float, over: int
    ) -> None:
        """Add where the robot turns back beyond the ends of legs, for as long as that may take.

        When it comes to a corner within a move is not known.
        """
        soonest = self.kinematics.rates(speed).soonest()
        begin = early
        for one, two in legs:
            early += soonest.from_stop_to_stop(one, two)
            if not _upright(one, two):
                beyond = (two, self.kinematics.beyond(one, two, speed))
                since = max(begin, early - BACK_SECONDS) if len(legs) == 1 else begin
                until = self.by + BACK_SECONDS
                place = self._place()
                self._add(Ride(beyond, since, until, (0.0,), self.radius, step=place, over=over))

    def _ride(
        self,
        points: tuple[Position, ...],
        quickest: Sequence[float],
        longest: float,
        rates: Rates,
        *,
        search: float = 0.0,
        relation: HomeRelation = HomeRelation.ELSEWHERE,
    ) -> None:
        """Go along points, as quick as that on each leg but for a search, and for so long at most."""
        even = [rates.even(one, two) for one, two in pairwise(points)]
        least = tuple(_least_seconds(even, quickest, search))
        seconds = max(0.0, sum(quickest) - search)
        self.by += longest
        place = self._place()
        self._add(Ride(points, self.now, self.by, least, self.radius, relation, place, place + 1))
        self.now, self.here, self.gone = self.now + seconds, points[-1], True

    def _pause(self) -> None:
        """Stop on the spot, as behaviours may have to between two waits."""
        self._stay(0.0, noticing(self.kinematics.timing))

    def _stay(self, seconds: float, longest: float | None = None) -> None:
        """Stay for so long at least, and at most."""
        self.by += seconds if longest is None else longest
        if self.by > self.now:
            place, relation = self._place(), self._relation()
            self._add(Ride((self.here,), self._since(), self.by, (), self.radius, relation, place, place + 1))
        self.now += seconds

    def _add(self, ride: Ride) -> None:
        self.parts.append(((ride,), 0.0, 0.0, 0))

    def _since(self) -> float:
        """Return since when it may stand where it is."""
        return self.now if self.gone else -inf

    def _relation(self) -> HomeRelation:
        return HomeRelation.HOME if dist(self.here, self.robot.home) <= NEAR else HomeRelation.ELSEWHERE

    def _place(self) -> int:
        return len(self.places) - 1


def _least_seconds(even: Sequence[float], quickest: Sequence[float], search: float) -> Iterator[float]:
    """Yield the seconds that each leg of a ride takes at least, whichever of its legs in a row are one move.

    A move is that much quicker on all of its legs by which it may be quicker than at even speed.

    Args:
        even: seconds of each leg at even speed. quickest: from a stop to a stop, as quick as may be.
        search: seconds by which a move may be shorter, or longer, as its ends are not known.
    """
    for i, each in enumerate(even):
        moves = [slice(begin, end) for begin in range(i + 1) for end in range(i + 1, len(even) + 1)]
        whole = [(sum(quickest[move]) - search, sum(even[move])) for move in moves]
        shares = (max(0.0, seconds / steady) for seconds, steady in whole if steady)
        yield each * min([1.0, *shares])


def moves_along(legs: Sequence[tuple[Position, Position]]) -> Iterator[tuple[Position, ...]]:
    """Yield the legs of a route, upright and level ones in a row together.

    A robot kind may make one move of these, during which the time at the corner is unknown. Of two level
    legs, or of two upright ones, none does: their corner ends a move.
    """
    run: list[tuple[Position, Position]] = []
    for leg in legs:
        if run and (_slopes(*run[-1]) or _slopes(*leg) or _upright(*run[-1]) == _upright(*leg)):
            yield (run[0][0], *(two for _, two in run))
            run = []
        run.append(leg)
    if run:
        yield (run[0][0], *(two for _, two in run))


def _upright(one: Position, two: Position) -> bool:
    return hypot(two[0] - one[0], two[1] - one[1]) <= NEAR


def _slopes(one: Position, two: Position) -> bool:
    return abs(two[2] - one[2]) > NEAR and not _upright(one, two)
