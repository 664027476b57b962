"""Keeps robots apart: where planned robots may come too near to each other, one of them waits."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import replace
from itertools import chain
from math import inf

import numpy as np

from mmrs_core.planning.charges import Charges
from mmrs_core.planning.conflicts import Conflict, TooNearError
from mmrs_core.planning.delaying import delayed
from mmrs_core.planning.effort import UNLIMITED, SearchLimit
from mmrs_core.planning.proximity import Pieces, Proximity, joined, pieces_of, some_of
from mmrs_core.planning.schedule import Decisions
from mmrs_core.planning.search import broken_times
from mmrs_core.planning.sweep import Flags, Floats, Indices
from mmrs_core.planning.team import Team
from mmrs_core.planning.timeline import HomeRelation, Timeline, Timelines
from mmrs_core.planning.waiting import DelayedStep, Span, waits_before
from mmrs_core.scene import (
    Await,
    Launch,
    Plan,
    Recharge,
    Recover,
    Scene,
    Serve,
    Signal,
    Step,
    Transit,
    distinct_works,
)

_ROUNDING = 1e-3
"""Metres that robots keep apart beyond what is required, since files round coordinates."""

_SPARE = 0.05
"""Seconds that robots are apart in time at one place, since times follow from rounded coordinates."""


_ROUNDS = 8
"""Schedules that are made with later starts."""

_ORDERS = 16
"""Orders at most that are tried to find who starts later."""

_LEVELS = 8
"""Levels at most that are tried for a leg."""

_ABOVE = 0.1
"""Metres by which levels are further apart than robots have to be."""


def distance_to_keep(scene: Scene) -> float | None:
    """Return the metres that planned robots keep apart; None where none are asked for.

    Each of two robots may be off by the position error, and by the radius that it turns in.
    """
    if scene.minimum_separation is None or scene.minimum_separation <= 0:
        return None
    radii = sorted(robot.kinematics.turning_radius for robot in scene.robots if robot.kinematics is not None)
    return scene.minimum_separation + 2.0 * scene.position_error + sum(radii[-2:]) + _ROUNDING


def separated(team: Team, plan: Plan, limit: SearchLimit = UNLIMITED) -> Plan:
    """Return the plan in which robots wait where they must so that all keep apart; itself if they do.

    Of the two robots that come too near to each other first, that one waits with which the mission ends
    sooner, wherever along its path it keeps apart from all others. Robots on the ground and at home count
    as all others do, but for neighbouring homes (see `Proximity`). They keep apart also if charging ends
    early: waits that are long enough for that are sought where those for the declared time are not.

    Args:
        team: of the scene.
        plan: of the team.
        limit: until when to seek.

    Raises:
        TooNearError: waiting did not help, or it is too late to seek where.
    """
    least = distance_to_keep(team.scene)
    if least is None:
        return plan
    timing, hasty = team.timelines(hasty=False), team.timelines(hasty=True)
    made = _separated(team, Traffic(team.scene, plan, least, timing=timing, charges=team.charges), limit)
    if recharges(made) and Traffic(team.scene, made, least, timing=hasty).conflicts:
        made = _separated(team, Traffic(team.scene, plan, least, timing=hasty, charges=team.charges), limit)
    return made


def recharges(plan: Plan) -> bool:
    """Return whether a robot recharges in a plan."""
    return any(isinstance(step, Recharge) for each in plan.robots for step in each.steps)


def _separated(team: Team, traffic: Traffic, limit: SearchLimit) -> Plan:
    while traffic.conflicts:
        first = traffic.earliest()
        options = [] if limit.over else list(_waiting(team, traffic, first))
        better = [each for each in options if len(each.conflicts) < len(traffic.conflicts)]
        if not better:
            homes = {robot.name: robot.home for robot in team.scene.robots}
            raise TooNearError(traffic.plan, traffic.measured(first), traffic.least, homes)
        traffic = min(better, key=lambda each: each.cost)
    return traffic.plan


def starting_later(
    team: Team, decisions: Decisions, planned: Callable[[Decisions], Plan | None]
) -> Plan | None:
    """Return a plan in which robots keep apart since some start later; None if none is found.

    The whole schedule is made again, so that others may take over.

    Args:
        team: of the scene, with a minimum separation.
        decisions: to begin with.
        planned: makes the plan of decisions; None where they lead to none.
    """
    least, hasty = distance_to_keep(team.scene) or 0.0, False
    for _ in range(_ROUNDS):
        found = planned(decisions)
        if found is None:
            break
        traffic = Traffic(team.scene, found, least, timing=team.timelines(hasty=hasty))
        if not traffic.conflicts and not hasty and recharges(found):
            hasty = True
            traffic = Traffic(team.scene, found, least, timing=team.timelines(hasty=True))
        if not traffic.conflicts:
            return found
        later = traffic.later_starts()
        if not later:
            break
        decisions = replace(decisions, delays={**decisions.delays, **later})
    return None


def _waiting(team: Team, traffic: Traffic, conflict: Conflict) -> Iterator[Traffic]:
    """Yield what becomes of the traffic if a robot waits so that it keeps apart from all others."""
    for name in (conflict.first, conflict.second):
        for at_home in (False, True):
            waits = traffic.waits(name, at_home=at_home)
            if waits is None:
                break
            plan = delayed(team.scene, traffic.plan, name, waits)
            if allowed(team, traffic, plan):
                yield traffic.with_plan(plan)
                break


def allowed(team: Team, before: Traffic, plan: Plan) -> bool:
    """Return whether a plan keeps times, and charges too of those robots that wait longer than before."""
    spans = {task: (begin, plan.ends[task]) for task, begin in plan.begins.items()}
    return not broken_times(team, spans) and not before.overdrawn_in(plan)


class Traffic:
    """A plan with what its robots take up, and where they come too near to each other.

    Attributes:
        plan: of all robots.
        least: metres that they have to keep apart.
        timing: makes its timelines.
        conflicts: the earliest of each two robots, by their names.
    """

    def __init__(
        self,
        scene: Scene,
        plan: Plan,
        least: float,
        *,
        timing: Timelines | None = None,
        charges: Charges | None = None,
    ) -> None:
        """Make it.

        Args:
            scene: of the plan.
            plan: of all robots.
            least: metres that they have to keep apart.
            timing: makes timelines of such plans; None: charging takes as long as declared.
            charges: of the robots, which must suffice; None: they are not looked at.
        """
        self.plan, self.least = plan, least
        self._charges = charges
        self._robots = {robot.name: robot for robot in scene.robots}
        self.timing = timing or Timelines(self._robots)
        self._names = tuple(each.robot for each in plan.robots)
        self._timelines: Mapping[str, Timeline] = {}
        self._pieces: Mapping[str, Pieces] = {}
        self._delays: dict[tuple[str, int | None], list[tuple[DelayedStep, bool]]] = {}
        self._apart: dict[tuple[str, str], Floats] = {}
        self._meetings: Mapping[tuple[str, str], tuple[Indices, Indices]] = {}
        self.conflicts: Mapping[tuple[str, str], Conflict] = {}
        self._update(frozenset(self._names), self._names)

    def with_plan(self, plan: Plan, names: Collection[str] | None = None) -> Traffic:
        """Return the traffic of a plan in which some robots do the same at other times.

        Args:
            plan: of all robots.
            names: of those of which is found where they meet; None: all.
        """
        other = copy(self)
        other.plan = plan
        other._update(self._changed_in(plan), self._names if names is None else names)
        return other

    def _update(self, changed: frozenset[str], names: Collection[str]) -> None:
        """Find where those of some robots who have changed come too near to others of them."""
        self._timelines, self._delays, self._apart = self.timing.of(self.plan, names), {}, {}
        fresh = {
            name: pieces_of(self._timelines[name].rides, number)
            for number, name in enumerate(self._names)
            if name in changed and name in names
        }
        self._pieces = {**self._pieces, **fresh}
        proximity = self._proximity([self._pieces[name] for name in self._names if name in names])
        moved = np.array([name in changed for name in self._names])[proximity.pieces.owners]
        i, j = self._unordered(proximity.pieces, *proximity.meetings(_SPARE, moved))
        found = {names: (meeting, conflict) for names, meeting, conflict in self._met(proximity, i, j)}
        kept = {pair: each for pair, each in self._meetings.items() if changed.isdisjoint(pair)}
        self._meetings = {**kept, **{names: meeting for names, (meeting, _) in found.items()}}
        conflicts = {names: conflict for names, (_, conflict) in found.items()}
        self.conflicts = {**{pair: self.conflicts[pair] for pair in kept}, **conflicts}

    def _proximity(self, parts: Sequence[Pieces]) -> Proximity:
        return Proximity(joined(parts), [self._robots[name].home for name in self._names], self.least)

    def meetings(self, pieces: Pieces) -> tuple[Indices, Indices]:
        """Return the pairs of other pieces of its robots, at their steps, on which two may come too near."""
        return self._unordered(pieces, *self._proximity([pieces]).meetings(_SPARE))

    def _unordered(self, pieces: Pieces, i: Indices, j: Indices) -> tuple[Indices, Indices]:
        """Return those pairs of which neither piece is over for certain before the other one begins."""
        known = [self._timelines[name].known if name in self._timelines else () for name in self._names]
        if not any(each[-1] for each in known if each):
            return i, j
        begun = np.full((sum(map(len, known)), len(known)), -1)
        for row, told in enumerate(chain.from_iterable(known)):
            for name, step in told.items():
                begun[row, self._names.index(name)] = step
        rows = np.cumsum([0, *map(len, known[:-1])])[pieces.owners] + pieces.steps
        left = (begun[rows[j], pieces.owners[i]] < pieces.over[i]) & (
            begun[rows[i], pieces.owners[j]] < pieces.over[j]
        )
        return i[left], j[left]

    def _met(
        self, proximity: Proximity, i: Indices, j: Indices
    ) -> Iterator[tuple[tuple[str, str], tuple[Indices, Indices], Conflict]]:
        """Yield, for each two robots that meet, the pieces on which they do and the earliest conflict."""
        times, owners = np.maximum(proximity.soonest(i, j), 0.0), proximity.pieces.owners
        begins, at_home = np.searchsorted(owners, np.arange(len(self._names))), proximity.at_home(i, j)
        pairs = owners[i] * len(self._names) + owners[j]
        order = np.argsort(times, kind="stable")
        order = order[np.argsort(pairs[order], kind="stable")]
        cuts = np.nonzero(np.diff(pairs[order], prepend=-1))[0]
        for chosen in np.split(order, cuts)[1:]:
            first = chosen[0]
            one, two = int(owners[i[first]]), int(owners[j[first]])
            meeting = i[chosen] - begins[one], j[chosen] - begins[two]
            names, pieces = (self._names[one], self._names[two]), (int(meeting[0][0]), int(meeting[1][0]))
            yield names, meeting, Conflict(*names, float(times[first]), bool(at_home[first]), pieces)

    def earliest(self) -> Conflict:
        """Return the earliest conflict."""
        return min(self.conflicts.values(), key=lambda each: each.time)

    def measured(self, conflict: Conflict) -> Conflict:
        """Return a conflict with its distance."""
        pieces = [self._pieces[name] for name in (conflict.first, conflict.second)]
        i, j = (np.array([each]) for each in (conflict.pieces[0], len(pieces[0]) + conflict.pieces[1]))
        return replace(conflict, distance=float(self._proximity(pieces).nearest(i, j, _SPARE)[0]))

    @property
    def cost(self) -> tuple[float, float, int]:
        """Return (makespan, seconds until each robot is back, conflicts); less is better."""
        backs = [each.steps[-1].end for each in self.plan.robots if each.steps]
        return round(self.plan.makespan, 3), round(sum(backs), 3), len(self.conflicts)

    def steps(self, name: str) -> tuple[Step, ...]:
        """Return what a robot does."""
        return next(each.steps for each in self.plan.robots if each.robot == name)

    def timeline(self, name: str) -> Timeline:
        """Return where a robot may be, and when."""
        return self._timelines[name]

    def overdrawn_in(self, plan: Plan) -> set[str]:
        """Return the robots that may wait longer in another plan and then take more than a charge allows."""
        return set() if self._charges is None else self._charges.short(plan, self._changed_in(plan))

    def left_of_charges(self) -> dict[str, list[float]]:
        """Return, by robot, the seconds left of a charge after each flight; empty where none count."""
        return {} if self._charges is None else self._charges.left(self.plan)

    def _changed_in(self, plan: Plan) -> frozenset[str]:
        """Return the robots that may do something at other times than before, if only at the latest."""
        before = {each.robot: each.steps for each in self.plan.robots}
        return _with_receivers(plan, {each.robot for each in plan.robots if each.steps != before[each.robot]})

    def later_starts(self) -> dict[str, float]:
        """Return when robots must leave home at the earliest to keep apart; empty if that does not help.

        One after the other is settled, those that are away longest first, and starts no later than those
        settled before ask for. The robot that is then back last is settled first in the next try, as
        bottlenecks are shifted (Adams, Balas and Zawack, 1988); the try counts after which all are back
        earliest.
        """
        backs = {each.robot: each.steps[-1].end for each in self.plan.robots if each.steps}
        order = sorted(backs, key=lambda name: (-backs[name], name))
        tries: list[dict[str, float]] = []
        for _ in range(_ORDERS):
            shifts = self._settled(order)
            last = max(shifts, key=lambda name: (backs[name] + shifts[name], name))
            tries.append(shifts)
            if last == order[0]:
                break
            order.remove(last)
            order.insert(0, last)
        best = min(tries, key=lambda shifts: max(backs[name] + shift for name, shift in shifts.items()))
        if inf in best.values():
            return {}
        return {name: _leaves(self.steps(name)) + shift for name, shift in best.items() if shift}

    def _settled(self, order: Iterable[str]) -> dict[str, float]:
        """Return by how many seconds robots start later, up to the first that never can: by inf."""
        shifts: dict[str, float] = {}
        for name in order:
            shifts[name] = self._shift(name, shifts) if shifts else 0.0
            if shifts[name] == inf:
                break
        return shifts

    def _shift(self, late: str, fixed: Mapping[str, float]) -> float:
        """Return by how many seconds a robot must start later for others, late too; inf: never."""
        self._find_delays(late, [name for name in fixed if (name, late) not in self._apart])
        spans = [self._apart[name, late] + shift for name, shift in fixed.items()]
        return _least_beyond(*np.concatenate(spans, axis=1))

    def least_shift(self, one: str, other: str, mine: Collection[int], others: Collection[int]) -> float:
        """Return by how many seconds one of two robots must be later or sooner to keep apart on some steps.

        Args:
            one, other: the robots.
            mine, others: indices of their steps.
        """
        parts = [
            some_of(self._pieces[name], np.isin(self._pieces[name].steps, [*steps]))
            for name, steps in ((one, mine), (other, others))
        ]
        proximity = self._proximity(parts)
        cut, count = len(parts[0]), len(proximity.pieces)
        i, j = self._unordered(proximity.pieces, *proximity.paths(np.arange(cut), np.arange(cut, count)))
        begins, ends = proximity.delays(i, j, _SPARE)
        return min(_least_beyond(begins, ends), _least_beyond(-ends, -begins))

    def _find_delays(self, late: str, names: Sequence[str]) -> None:
        """Find between which delays a robot may come too near to some others, none of which is late."""
        if not names:
            return
        parts = [self._pieces[name] for name in names]
        proximity = self._proximity([*parts, self._pieces[late]])
        cuts = np.cumsum([len(part) for part in parts])
        i, j = proximity.paths(np.arange(cuts[-1]), np.arange(cuts[-1], len(proximity.pieces)))
        i, j = self._unordered(proximity.pieces, i, j)
        spans = np.split(np.stack(proximity.delays(i, j, _SPARE)), np.searchsorted(i, cuts[:-1]), axis=1)
        self._apart |= {(name, late): each for name, each in zip(names, spans, strict=True)}

    def met(self, one: str, other: str) -> list[tuple[int, int, int]]:
        """Return where two robots may come too near: a step of the other, one of the one, and its end.

        All are indices of steps; the end is that with whose begin the one's step is over.
        """
        mine, others = self._pieces[one], self._pieces[other]
        if (one, other) in self._meetings:
            i, j = self._meetings[one, other]
        elif (other, one) in self._meetings:
            j, i = self._meetings[other, one]
        else:
            return []
        found = others.steps[j], mine.steps[i], mine.over[i]
        return list(zip(*(each.tolist() for each in found), strict=True))

    def knows(self, name: str, step: int) -> Mapping[str, int]:
        """Return, by other robot, the step that it has begun at least when a robot begins a step."""
        return self._timelines[name].known[step]

    def waits(self, name: str, *, at_home: bool, last: int | None = None) -> dict[int, float] | None:
        """Return how long a robot must wait before its steps to keep apart from others; None: in no case.

        Args:
            name: of the robot.
            at_home: whether it can wait at home only.
            last: the step up to which it must keep apart; None: to the end.
        """
        if (name, last) not in self._delays:
            self._delays[name, last] = list(self._delayed_steps(name, last))
        delays = [
            replace(step, may_wait=step.may_wait and (is_home or not at_home))
            for step, is_home in self._delays[name, last]
        ]
        return waits_before(delays)

    def _delayed_steps(self, name: str, last: int | None) -> Iterator[tuple[DelayedStep, bool]]:
        """Yield what limits the delay of each step of a robot, and whether it begins at its home.

        Args:
            name: of the robot.
            last: the step after which none are yielded; None: all are.
        """
        number, timeline = self._names.index(name), self._timelines[name]
        mine, places = self._pieces[name], timeline.stops
        if last is not None:
            mine, places = some_of(mine, mine.steps <= last), places[: last + 1]
        stops = pieces_of(places, number)
        parts = [self._pieces[other] for other in self._names if other != name]
        proximity = self._proximity([*parts, mine, stops])
        count, own = len(proximity.pieces), len(mine) + len(stops)
        i, j = proximity.paths(np.arange(count - own), np.arange(count - own, count))
        i, j = self._unordered(proximity.pieces, i, j)
        begins, ends = proximity.delays(i, j, _SPARE)
        standing = j >= count - len(stops)
        steps = proximity.pieces.steps[j]
        plan = self.steps(name)
        for index, stop in enumerate(places):
            step = plan[index] if index < len(plan) else None
            here = steps == index
            delayed_step = DelayedStep(
                _united(begins, ends, here & ~standing),
                _united(begins, ends, here & standing),
                may_wait(step),
                step.end - step.begin if isinstance(step, Await) and step.signals else 0.0,
            )
            yield delayed_step, stop.relation is HomeRelation.HOME


def _with_receivers(plan: Plan, names: Collection[str]) -> frozenset[str]:
    """Return robots and those that wait for their signals, or for signals of these, and so on."""
    receivers = {
        each.robot: {name for step in each.steps if isinstance(step, Signal) for name in step.receivers}
        for each in plan.robots
    }
    found, pending = set(names), [*names]
    while pending:
        more = receivers[pending.pop()] - found
        found |= more
        pending += more
    return frozenset(found)


def _least_beyond(begins: Floats, ends: Floats) -> float:
    """Return the least whole number of seconds that is in none of some open intervals."""
    least = 0.0
    for begin, end in _united(begins, ends, ends > np.maximum(begins, 0.0)):
        if begin < least < end:
            least = float(np.ceil(end))
    return least


def _leaves(steps: Sequence[Step]) -> float:
    """Return when a robot begins anything but to wait."""
    return next((step.begin for step in steps if not isinstance(step, Await)), 0.0)


def may_wait(step: Step | None) -> bool:
    """Return whether a robot can wait before a step."""
    return isinstance(step, Launch | Transit | Serve | Recover)


def _united(begins: Floats, ends: Floats, chosen: Flags) -> list[Span]:
    """Return the union of some open intervals, ordered and apart."""
    found: list[Span] = []
    for begin, end in sorted(zip(begins[chosen].tolist(), ends[chosen].tolist(), strict=True)):
        if end <= max(begin, 0.0):
            continue
        if found and begin < found[-1][1]:
            found[-1] = (found[-1][0], max(end, found[-1][1]))
        else:
            found.append((begin, end))
    return found


def first_conflict(scene: Scene, plan: Plan, least: float) -> Conflict | None:
    """Return the earliest conflict nearer than `least` metres; None if there is none."""
    traffic = Traffic(scene, plan, least)
    return traffic.measured(traffic.earliest()) if traffic.conflicts else None


def levels_above(least: float) -> Iterator[float]:
    """Yield by how many metres a robot may fly higher on a leg so as to keep a distance."""
    yield from (number * (least + _ABOVE) for number in range(1, _LEVELS + 1))


def stacked_altitudes(scene: Scene) -> dict[str, float]:
    """Return transit altitudes for robots that launch, one above the other by the minimum separation.

    The lowest is the scene's own, or the height of the highest stroke. Empty where robots need not keep
    apart, or the lowest ceiling leaves no room for a second.
    """
    least = distance_to_keep(scene) or 0.0
    robots = [robot for robot in scene.robots if robot.kinematics is not None and robot.kinematics.launches]
    heights = [
        point[2] for work in distinct_works(scene.works) for stroke in work.strokes for point in stroke.points
    ]
    if least <= 0.0 or len(robots) < 2 or not heights:
        return {}
    lowest = max(heights) if scene.transit_altitude is None else scene.transit_altitude
    ceiling = min(robot.kinematics.ceiling for robot in robots if robot.kinematics is not None)
    levels = max(1, int((ceiling - lowest) / (least + _ABOVE)) + 1) if ceiling < 1e6 else len(robots)
    if levels < 2:
        return {}
    return {robot.name: lowest + (i % levels) * (least + _ABOVE) for i, robot in enumerate(robots)}
