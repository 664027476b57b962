"""Keeps robots that fly apart by flight levels: where two may meet, one goes higher, on that leg only.

Each leg has several ways: as planned, at levels, or up and down on a slant. One of them is chosen for each
leg such that no two are too near that robots may be on at once. That is a constraint satisfaction problem as
the colouring of graphs is. Of what conflicts, that is changed with which conflicts become fewest (Minton,
Johnston, Philips and Laird, 1992), and what was left is not taken again for some steps (Hertz and de Werra,
1987). The mission's end is a limit that rises until a choice keeps it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple, TypeAlias

import numpy as np

from mmrs_core.planning.delaying import delayed, retimed
from mmrs_core.planning.effort import SLICE, UNLIMITED, SearchLimit
from mmrs_core.planning.proximity import joined, pieces_of
from mmrs_core.planning.search import broken_times
from mmrs_core.planning.separation import Traffic, distance_to_keep, levels_above, recharges
from mmrs_core.planning.sweep import Flags, Floats, Indices
from mmrs_core.planning.team import Team
from mmrs_core.planning.timeline import Ride, Timelines
from mmrs_core.planning.travel import Travel
from mmrs_core.scene import Await, Launch, Plan, Position, Recover, Scene, Serve, Step, Transit

_Way: TypeAlias = tuple[Step, ...]

_SLANTED_LEVELS = 4
_PEAKS = (0.25, 0.5, 0.75)
"""Shares of a leg after which it is highest, where it goes up and down on a slant; and levels of that."""

_ROUNDS = 6
"""Choices that are made, each with the times that follow from the one before."""

_LIMITS = (*np.arange(1.0, 1.1, 0.01).tolist(), 1.12, 1.15, 1.2, 1.3, 1.5)
"""Times the mission time without separation that is the limit."""

_STEPS, _STEPS_PER_LEG = 1500, 100
"""Ways that are changed at most with one limit."""

_VAIN = 2
"""Limits in a row after which no more are tried where conflicts are left and become no fewer."""

_LEFT_FOR = (5, 15)
"""Steps between which a way that was left is not taken again."""

_CONFLICTS_PER_SECOND = 0.2
"""What a second beyond the limit weighs."""

_AT_MOST = 1.2
"""Times the seconds expected of going higher that count against a charge."""

_LATER = 0.1
"""Times the mission time by which robots may be later that fly higher, about."""

_EARLY = 1e-6
"""Seconds by which a step may begin before its task may: rounding."""

_MOST_PAIRS = 1_000_000
"""Pairs of ways that are too near, up to which a choice is sought."""


def on_levels(team: Team, plan: Plan, limit: SearchLimit = UNLIMITED) -> Traffic:
    """Return what becomes of a plan as robots fly legs at other levels, so that fewer, mostly none, conflict.

    Args:
        team: of the scene, with a minimum separation.
        plan: of the team.
        limit: what the mission must beat, and until when to seek.
    """
    least, timing = distance_to_keep(team.scene) or 0.0, team.timelines(hasty=recharges(plan))
    planned = traffic = Traffic(team.scene, plan, least, timing=timing, charges=team.charges)
    legs = {each.robot: list(_legs(team, each.robot, each.steps)) for each in plan.robots}
    best, grounded, share, spare = planned, set[str](), 1.0, planned.left_of_charges()
    if all(_meet_at_work(planned, legs, *pair) for pair in planned.conflicts):
        return planned
    for turn in range(_ROUNDS):
        if limit.over:
            break
        met = dict.fromkeys(_met(traffic, legs))
        closed = [leg for leg in met if len(leg.ways) == 1 and leg.robot not in grounded]
        for leg in closed:
            leg.ways += _higher(team.pilots[leg.robot].travel, leg.ways[0], least)
        choice = _Choice(traffic, plan, legs, spare)
        if not choice.pairs or choice.pairs > _MOST_PAIRS:
            break
        share, changed = choice.improve(np.random.default_rng(turn), share, limit)
        made = _made(team.scene, plan, legs, timing)
        overdrawn = planned.overdrawn_in(made)
        if overdrawn:
            grounded |= overdrawn
            for leg in (leg for name in overdrawn for leg in legs[name]):
                leg.chosen, leg.ways = 0, leg.ways[:1]
            made = _made(team.scene, plan, legs, timing)
        spans = {name: (begin, made.ends[name]) for name, begin in made.begins.items()}
        if (
            planned.overdrawn_in(made)
            or broken_times(team, spans)
            or any(_too_soon(team.scene, made, timing))
        ):
            break
        traffic = planned.with_plan(made)
        better = min(best, traffic, key=lambda each: (len(each.conflicts), each.cost))
        vain = better is best and not any(len(leg.ways) > 1 for leg in closed)
        best = better
        if not traffic.conflicts or not (changed or overdrawn) or vain:
            break
    return best


def _made(scene: Scene, plan: Plan, legs: Mapping[str, Sequence[_Leg]], timing: Timelines) -> Plan:
    """Return the plan with the ways that are chosen; after quicker ones, robots wait longer."""
    made = retimed(
        scene, plan, {name: tuple(step for leg in mine for step in leg.way) for name, mine in legs.items()}
    )
    for _ in range(sum(len(each.steps) for each in plan.robots)):
        soon = next(_too_soon(scene, made, timing), None)
        if soon is None or not isinstance(soon.before, Await) or soon.before.until is None:
            break
        made = delayed(scene, made, soon.robot, {soon.step: soon.seconds})
    return made


class _TooSoon(NamedTuple):
    """A step, by its number, that may begin some seconds before its task may; `before`: the one before."""

    robot: str
    step: int
    before: Step | None
    seconds: float


def _too_soon(scene: Scene, plan: Plan, timing: Timelines) -> Iterator[_TooSoon]:
    """Yield the first of each robot's steps that may begin before its task may."""
    earliest = {task.name: task.earliest for task in scene.tasks if task.earliest}
    timelines = timing.of(plan) if earliest else {}
    for each in plan.robots if earliest else ():
        for index, step in enumerate(each.steps):
            begin = earliest.get(step.task) if isinstance(step, Serve) else None
            short = 0.0 if begin is None else begin - timelines[each.robot].moments[index][0]
            if short > _EARLY:
                yield _TooSoon(each.robot, index, each.steps[index - 1] if index else None, short)
                break


@dataclass(slots=True, eq=False)
class _Leg:
    """Steps of a robot that are done in one of several ways.

    Attributes:
        begin, end: indices of its steps, the first and that after the last one.
        ways: as many steps each, with the times of the plan's own, which come first; lasting steps count from
            there.
        flight: how many times the robot has come down before.
        chosen: index of the way.
    """

    robot: str
    begin: int
    end: int
    ways: list[_Way]
    flight: int
    chosen: int = 0

    @property
    def way(self) -> _Way:
        return self.ways[self.chosen]

    @property
    def travels(self) -> bool:
        """Whether its robot goes from one place to another, which it may do at other levels."""
        return any(isinstance(step, Transit) for step in self.ways[0])


def _legs(team: Team, robot: str, steps: Sequence[Step]) -> Iterator[_Leg]:
    """Yield the legs of a robot; a launch and a recovery at home are parts of those after and before them."""
    home, index, flight = team.scene.robot(robot).home, 0, 0
    while index < len(steps):
        match steps[index : index + 2]:
            case (Launch(), Transit()):
                end = index + 2
            case (Transit(), Recover(at=at)) if at[:2] == home[:2]:
                end = index + 2
            case _:
                end = index + 1
        yield _Leg(robot, index, end, [tuple(steps[index:end])], flight)
        flight += isinstance(steps[end - 1], Recover)
        index = end
    yield _Leg(robot, index, index + 1, [()], flight)


def _met(traffic: Traffic, legs: Mapping[str, Sequence[_Leg]]) -> Iterator[_Leg]:
    """Yield the legs on which robots may meet."""
    for one, other in traffic.conflicts:
        for pair in _both(traffic, legs, one, other):
            yield from pair


def _both(
    traffic: Traffic, legs: Mapping[str, Sequence[_Leg]], one: str, other: str
) -> Iterator[tuple[_Leg, _Leg]]:
    """Yield the legs on which two robots may meet, that of each."""
    for late, early, _ in traffic.met(one, other):
        yield _leg_of(legs[one], early), _leg_of(legs[other], late)


def _leg_of(legs: Iterable[_Leg], step: int) -> _Leg:
    return next(leg for leg in legs if leg.begin <= step < leg.end)


def _meet_at_work(traffic: Traffic, legs: Mapping[str, Sequence[_Leg]], one: str, other: str) -> bool:
    """Return whether two robots meet where neither travels, and would also if one were somewhat later."""
    if all(mine.travels or its.travels for mine, its in _both(traffic, legs, one, other)):
        return False
    works = (
        [step for leg in legs[name] if not leg.travels for step in range(leg.begin, leg.end)]
        for name in (one, other)
    )
    return traffic.least_shift(one, other, *works) > _LATER * traffic.plan.makespan


def _higher(travel: Travel, own: _Way, least: float) -> Iterator[_Way]:
    """Yield other ways for the steps of a leg, higher so as to keep a distance."""
    for number, higher in enumerate(levels_above(least)):
        match own:
            case (Launch() as launch, Transit() as out):
                height = launch.up + higher
                up = launch.begin + travel.kinematics.launching(height - launch.at[2])
                for route in travel.from_above(height, out.route[-1], travel.entries):
                    yield replace(launch, end=up, up=height), _along(travel, replace(out, begin=up), route)
            case (Transit() as back, Recover() as recover):
                height = recover.at[2] + higher
                down = travel.kinematics.landing(height - recover.up)
                for route in travel.from_above(height, back.route[0], travel.exits):
                    there = _along(travel, back, route)
                    yield there, replace(recover, begin=there.end, end=there.end + down, at=route[-1])
            case (Transit() as step,):
                peaks = _PEAKS if number < _SLANTED_LEVELS else ()
                for route in travel.above(step.route[0], step.route[-1], higher, peaks):
                    yield (_along(travel, step, route),)


def _along(travel: Travel, step: Transit, route: tuple[Position, ...]) -> Transit:
    return replace(step, end=step.begin + travel.going(route, step.speed).expected, route=route)


class _Choice:
    """Which way of each leg is chosen, and which ways are too near to each other.

    Attributes:
        pairs: number of pairs of ways that are.
    """

    def __init__(
        self,
        traffic: Traffic,
        plan: Plan,
        legs: Mapping[str, Sequence[_Leg]],
        spare: Mapping[str, Sequence[float]],
    ) -> None:
        """Make it.

        Args:
            traffic: of the ways that are chosen so far.
            plan: of the legs' own ways.
            legs: by robot, in the order of the plan's robots.
            spare: by robot: seconds of a charge left after each flight of the plan.
        """
        self._legs = [leg for mine in legs.values() for leg in mine]
        rides = [ride for leg in self._legs for ride in _rides(traffic, leg)]
        sizes = [len(leg.ways) for leg in self._legs]
        self._first = np.cumsum([0, *sizes[:-1]])
        self._leg = np.repeat(np.arange(len(sizes)), sizes)
        self._robot = np.repeat(np.arange(len(legs)), list(map(len, legs.values())))[self._leg]
        self._seconds = np.array([_longer(leg.ways[0], way) for leg in self._legs for way in leg.ways])
        self._ends = np.array([each.steps[-1].end if each.steps else 0.0 for each in plan.robots])
        flights = {(leg.robot, leg.flight): None for leg in self._legs}
        self._spare = np.array([max(0.0, [*spare.get(name, ()), inf][flight]) for name, flight in flights])
        places = {flight: len(legs) + k for k, flight in enumerate(flights)}
        mine = np.array([places[leg.robot, leg.flight] for leg in self._legs])[self._leg]
        self._limited = np.stack([self._robot, mine], axis=1)
        self._makespan, self._steps = plan.makespan, min(_STEPS, _STEPS_PER_LEG * sum(n > 1 for n in sizes))
        parts = [pieces_of(each, int(robot)) for each, robot in zip(rides, self._robot, strict=True)]
        owner = np.repeat(np.arange(len(parts)), list(map(len, parts)))
        one, other = (owner[each] for each in traffic.meetings(joined(parts)))
        one, other = self._avoidable(one, other)
        near = np.unique(np.concatenate([one, other]) * len(parts) + np.concatenate([other, one]))
        one, other = np.divmod(near, len(parts))
        self._near = np.split(other, np.searchsorted(one, np.arange(1, len(parts))))
        self.pairs = len(near) // 2

    def _avoidable(self, one: Indices, other: Indices) -> tuple[Indices, Indices]:
        """Return those pairs of ways of which the legs have two ways that are not too near."""
        count, legs = len(self._leg), int(self._leg[-1]) + 1
        one, other = np.divmod(np.unique(np.minimum(one, other) * count + np.maximum(one, other)), count)
        a, b = self._leg[one], self._leg[other]
        _, which, pairs = np.unique(a * legs + b, return_inverse=True, return_counts=True)
        ways = np.bincount(self._leg)
        left = pairs[which] < ways[a] * ways[b]
        return one[left], other[left]

    def improve(self, random: np.random.Generator, least: float, limit: SearchLimit) -> tuple[float, bool]:
        """Choose ways of which fewest are too near, and with which the mission ends early.

        Args:
            random: chooses among ways that are equally good.
            least: times the mission time that is the first limit.
            limit: what the last one must not exceed, and until when to seek.

        Returns:
            That of the last limit, and whether ways have changed.
        """
        first = chosen = self._first + [leg.chosen for leg in self._legs]
        conflicts = np.bincount(np.concatenate([self._near[way] for way in chosen]), minlength=len(self._leg))
        longer = np.zeros(len(self._ends) + len(self._spare))
        np.add.at(longer, self._limited[chosen].ravel(), self._seconds[chosen].repeat(2))
        best, chosen, fewest, since = first, first.copy(), len(first) + 1, 0
        again = np.zeros(len(self._leg), np.intp)
        most = max(least, limit.most / self._makespan)
        share, limits = least, [each for each in _LIMITS if least <= each <= most]
        for step, share in enumerate(each for each in limits for _ in range(self._steps)):
            if step % SLICE == 0 and limit.over:
                break
            room = np.concatenate([share * self._makespan - self._ends, self._spare / _AT_MOST])
            beyond = longer > room
            wrong = (conflicts[chosen] > 0) | beyond[self._limited[chosen]].any(axis=1)
            if not wrong.any():
                best = chosen
                break
            count = int(np.count_nonzero(conflicts[chosen]) + np.count_nonzero(beyond[len(self._ends) :]))
            if count < fewest:
                best, fewest, since = chosen.copy(), count, step
            elif fewest and step >= since + _VAIN * self._steps:
                break
            way = self._changed(chosen, conflicts, longer - room, wrong, again > step, random)
            if way is None:
                continue
            left = chosen[self._leg[way]]
            conflicts[self._near[way]] += 1
            conflicts[self._near[left]] -= 1
            longer[self._limited[way]] += self._seconds[way] - self._seconds[left]
            chosen[self._leg[way]] = way
            again[left] = step + random.integers(*_LEFT_FOR)
        for leg, way in zip(self._legs, (best - self._first).tolist(), strict=True):
            leg.chosen = way
        return share, bool((best != first).any())

    def _changed(
        self,
        chosen: Indices,
        conflicts: Indices,
        beyond: Floats,
        wrong: Flags,
        barred: Flags,
        random: np.random.Generator,
    ) -> int | None:
        """Return the way that is to replace another one of its leg."""
        ways = np.nonzero(wrong[self._leg] & ~barred)[0]
        own = chosen[self._leg[ways]]
        ways, own = (each[ways != own] for each in (ways, own))
        if not len(ways):
            return None
        now, more = beyond[self._limited[ways]], (self._seconds[ways] - self._seconds[own])[:, None]
        seconds = (np.maximum(0.0, now + more) - np.maximum(0.0, now)).sum(axis=1)
        costs = conflicts[ways] - conflicts[own] + _CONFLICTS_PER_SECOND * seconds
        return int(random.choice(ways[costs <= costs.min() + 1e-9]))


def _rides(traffic: Traffic, leg: _Leg) -> Iterator[Sequence[Ride]]:
    """Yield, for each way of a leg, what the robot takes up."""
    timeline = traffic.timeline(leg.robot)
    for number, way in enumerate(leg.ways):
        rides: Iterable[Ride] = traffic.timing.instead(leg.robot, timeline, leg.begin, way)
        if number == leg.chosen:
            rides = (each for each in timeline.rides if leg.begin <= each.step < leg.end)
        yield [replace(each, step=leg.begin, over=max(each.over, leg.end)) for each in rides]


def _longer(own: _Way, way: _Way) -> float:
    return (way[-1].end - way[0].begin) - (own[-1].end - own[0].begin) if way else 0.0
