"""Who does which jobs in which order, found among tours with the seconds that robots take between jobs.

What comes of it goes through `schedule`, which judges it as any other decisions: tours count a job as one
stop, or as several where several robots do it, each with its part of the work; they wait for the clock, but
for other robots only from the second round on, as long as they did in the schedule of the round before.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, dist, inf
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.jobs import Job
from mmrs_core.planning.materials import Material
from mmrs_core.planning.orders import OrderSearch
from mmrs_core.planning.ruin import Search
from mmrs_core.planning.ruin_loops import Field
from mmrs_core.planning.schedule import Decisions, Schedule, Shortfall, schedule
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.team import Team
from mmrs_core.scene import Position
from mmrs_core.scene.timing import LEVEL, MoveSeconds, Rates

_NEAREST = 10
"""Other stops next to which a stop may be inserted."""

_NEAREST_ROBOTS = 8

_ROUTED = 12
"""Nearest stops to and from which routes are found; to and from others, straight ones are estimated."""

_ROWS = 16
"""Stops whose seconds to all others are found at once: as many as a processor keeps near itself."""

_LENGTHS = 400
"""Lengths of legs whose seconds are known; those of legs between are interpolated."""

_FEWEST = 6
"""Jobs below which the search among schedules tries most of what there is."""

_STEPS_PER_STOP = 40
_MOST_STEPS = 10_000
_ROUNDS = 2

_ORDERS_PER_STOP = 75
_MOST_LOOKS = 16_000_000
"""Orders that are tried at most where jobs wait for others, and pairs of stop and robot in all of them."""

_PIECES_PER_TOUR = 3
"""Pieces of a mean tour into which work that robots may share is cut."""

if TYPE_CHECKING:
    from mmrs_core.planning.ruin_loops import Reals, Wholes

Matrix = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class _Stop:
    """A job, or a part of one that one of several robots does: which of how many alike."""

    job: str
    part: int = 0
    parts: int = 1


def allocated(
    team: Team, jobs: Sequence[Job], seed: int, effort: Effort, *, long: bool = False, in_turns: bool = False
) -> Iterator[tuple[Decisions, Schedule | Shortfall]]:
    """Yield decisions that came of searches for tours, with their schedules; none for few jobs.

    Args:
        team: of the scene.
        jobs: in an order in which none comes before one that it waits for.
        seed: of the searches.
        effort: that they may make.
        long: whether they take all of its time.
        in_turns: see `Decisions`; then only the sum of the tours counts.
    """
    stops = list(_stops(team, jobs))
    if len(jobs) < _FEWEST or not stops:
        return
    field = _Fields(team, stops).field()
    earliest = field.earliest
    waits = any(job.after for job in jobs)
    rounds = _ROUNDS if waits else 1
    for turn in range(rounds):
        search = Search(field, seed + turn, (0.0, 1.0) if in_turns else (1.0, 0.1))
        steps = min(_MOST_STEPS, _STEPS_PER_STOP * len(stops))
        for makespan in search.run(effort.shares(steps, of_the_rest=long / (rounds - turn))):
            effort.found(makespan)
        best = search.best
        decisions = replace(_decisions(team, jobs, stops, best.begins, best.robot), in_turns=in_turns)
        found = schedule(team, jobs, decisions)
        yield decisions, found
        if isinstance(found, Shortfall):
            return
        ends = {name: end for name, (_, end) in found.spans.items()}
        ready = {job.name: max((ends.get(name, 0.0) for name in job.after), default=0.0) for job in jobs}
        later = [max(own, ready[stop.job]) for own, stop in zip(earliest, stops, strict=True)]
        field = field._replace(earliest=np.array(later))
    steps = min(_ORDERS_PER_STOP * len(stops), _MOST_LOOKS // len(field.out))
    if waits and not in_turns and steps:
        orders = OrderSearch(field._replace(earliest=earliest), _before(jobs, stops), seed)
        for makespan in orders.run(effort.shares(steps)):
            effort.found(makespan)
        decisions = _decisions(team, jobs, stops, orders.best.starts, orders.best.robots)
        yield decisions, schedule(team, jobs, decisions)


def _before(jobs: Sequence[Job], stops: Sequence[_Stop]) -> list[list[int]]:
    """Return, by stop, those that it waits for; for a choice, those that the choice waits for."""
    mine: dict[str, list[int]] = {}
    for i, stop in enumerate(stops):
        mine.setdefault(stop.job, []).append(i)
    known: dict[str, list[int]] = {}
    for job in jobs:
        known[job.name] = sorted({i for name in job.after for i in mine.get(name, known[name])})
    return [known[stop.job] for stop in stops]


def _stops(team: Team, jobs: Sequence[Job]) -> Iterator[_Stop]:
    """Yield the stops of all jobs but choices, which the schedule gives to the robot that is back first."""
    single = [job.name for job in jobs if job.choice is None and job.tasks()]
    seconds = {name: _seconds(team, name) for name in single}
    piece = sum(seconds.values()) / (_PIECES_PER_TOUR * len(team.pilots))
    for name in single:
        most = team.sharers(name)
        wanted = team.tasks[name].wanted
        parts = wanted or max(1, min(most, ceil(seconds[name] / piece - 0.5) if piece > 0.0 else 1))
        kinds = team.able_kinds(name).values()
        laid_out = [each for robot in kinds if (each := team.forwards(name, robot)) is not None]
        parts = min(parts, max(map(len, laid_out), default=0))
        yield from (_Stop(name, i, parts) for i in range(parts))


def _seconds(team: Team, task: str) -> float:
    materials = (team.forwards(task, robot) for robot in team.able_kinds(task).values())
    return max((each.seconds(0, len(each) - 1) for each in materials if each is not None), default=0.0)


def _decisions(
    team: Team, jobs: Sequence[Job], stops: Sequence[_Stop], starts: Reals, whose: Wholes
) -> Decisions:
    """Return decisions: jobs as early as their stops begin, those with priority first."""
    priority = {task.name: task.priority for task in team.scene.tasks}
    ranks = {job.name: max((priority[name] for name in job.tasks()), default=0) for job in jobs}
    begins, robots = dict[str, float](), dict[str, set[int]]()
    for i, stop in enumerate(stops):
        begins[stop.job] = min(begins.get(stop.job, inf), starts[i])
        robots.setdefault(stop.job, set()).add(whose[i])
    order = sorted((job.name for job in jobs), key=lambda name: (-ranks[name], begins.get(name, 0.0)))
    names = list(team.pilots)
    groups = {job: tuple(names[i] for i in sorted(mine)) for job, mine in robots.items()}
    return Decisions(tuple(order), groups)


class _Fields:
    """The seconds between stops: routed where robots will go, estimated where they hardly will."""

    def __init__(self, team: Team, stops: Sequence[_Stop]) -> None:
        self._team, self._stops = team, stops
        self._pilots = list(team.pilots.values())
        self._kinds = list(dict.fromkeys(team.kinds.values()))

    def field(self) -> Field:
        """Return the field of all stops."""
        tasks = [self._team.tasks[stop.job] for stop in self._stops]
        kinds = [self._kinds.index(self._team.kinds[name]) for name in self._team.pilots]
        limits = np.array([pilot.charge for pilot in self._pilots])
        bounds = (0, 1) if limits.min() < inf else (0,)
        out, back = np.full((2, len(bounds), len(self._pilots), len(self._stops)), inf)
        go = np.full((len(bounds), len(self._kinds), len(self._stops), len(self._stops)), inf, np.float32)
        work = np.zeros((len(bounds), len(self._kinds), len(self._stops)))
        able_kinds = [self._team.able_kinds(stop.job) for stop in self._stops]
        for k, kind in enumerate(self._kinds):
            materials = [
                self._part(stop, each.get(kind)) for stop, each in zip(self._stops, able_kinds, strict=True)
            ]
            able = np.array([i for i, each in enumerate(materials) if each is not None], np.int64)
            if not able.size:
                continue
            robots = np.array([r for r, each in enumerate(kinds) if each == k], np.int64)
            mine = [self._pilots[r] for r in robots.tolist()]
            legs = _Legs(mine, [each for each in materials if each is not None], bounds)
            work[:, k, able] = legs.work
            for i, rows in zip(able.tolist(), legs.between(), strict=True):
                go[:, k, i, able] = rows
            some = np.ix_(np.array(bounds), robots, able)
            out[some], back[some] = legs.home()
        places = {name: r for r, name in enumerate(self._team.pilots)}
        for i, stop in enumerate(self._stops):
            if len(self._team.able(stop.job)) < len(kinds):
                unable = np.ones(len(kinds), np.bool_)
                unable[[places[name] for name in self._team.able(stop.job)]] = False
                out[:, unable, i] = inf
        near, near_robots = _nearest(go[0]), _nearest_robots(out[0])
        others = [self._others(i) if task.wanted is not None else [] for i, task in enumerate(tasks)]
        most = max(map(len, others))
        apart = np.array([[*each, *([-1] * (most - len(each)))] for each in others], np.int64)
        return Field(
            sizes=np.array(
                [
                    *(len(self._stops), len(self._pilots), near.shape[1], near_robots.shape[1], most),
                    len(self._kinds) if len(bounds) > 1 else 0,
                ]
            ),
            kinds=np.array(kinds),
            out=out.ravel(),
            go=go.ravel(),
            back=back.ravel(),
            work=work.ravel(),
            near=near.ravel(),
            near_robots=near_robots.ravel(),
            apart=apart.ravel(),
            limits=limits,
            recharges=np.array([pilot.kinematics.recharge or 0.0 for pilot in self._pilots]),
            earliest=np.array([task.earliest or 0.0 for task in tasks]),
            deadlines=np.array([inf if task.deadline is None else task.deadline for task in tasks]),
            ranks=np.array([task.priority for task in tasks]),
        )

    def _others(self, index: int) -> list[int]:
        stop = self._stops[index]
        first = index - stop.part
        return [i for i in range(first, first + stop.parts) if i != index]

    def _part(self, stop: _Stop, robot: str | None) -> Material | None:
        """Return the material of a stop, part of a job's, for a robot; None if it cannot do the job."""
        whole = None if robot is None else self._team.forwards(stop.job, robot)
        if whole is None or len(whole) < stop.parts or stop.parts == 1:
            return whole
        begin, end = (len(whole) * i // stop.parts for i in (stop.part, stop.part + 1))
        return whole.only(begin, end - 1)


class _Legs:
    """What robots of one kind take from stop to stop, and from and to their homes.

    Attributes:
        work: (bounds, stops), seconds at each stop, from where a robot comes to first.
    """

    def __init__(self, pilots: Sequence[Pilot], materials: Sequence[Material], bounds: Sequence[int]) -> None:
        """Make it.

        Args:
            pilots: of the robots, of one kind.
            materials: of the stops.
            bounds: 0: as expected; 1: at most.
        """
        self._bounds = bounds
        self._pilots, approaches = pilots, [each.approach(0) for each in materials]
        self._begins = [each.via[0] for each in approaches]
        self._speeds = [each.speed for each in approaches]
        self._ends = [each.last(len(each) - 1) for each in materials]
        travel = pilots[0].travel
        places = _places([*self._homes(), *self._begins, *self._ends])
        self._longest = max(1.0, dist(places[:, :2].min(0), places[:, :2].max(0)))
        self._seconds = dict[float | None, _LegSeconds]()
        self.work: Matrix = np.zeros((len(bounds), len(materials)))
        for i, (material, approach) in enumerate(zip(materials, approaches, strict=True)):
            self.work[:, i] = self._of(material.bounds(0, len(material) - 1))
            for leg in pairwise(approach.via):
                self.work[:, i] += self._of(travel.at_speed(travel.hop(*leg), approach.speed).bounds)

    def _of(self, seconds: MoveSeconds) -> list[float]:
        return [seconds[1 + bound] for bound in self._bounds]

    def between(self) -> Iterator[Singles]:
        """Yield, by stop, (bounds, stops) the seconds from its end to the begin of each."""
        begins, travel = _places(self._begins), self._pilots[0].travel
        for first in range(0, len(begins), _ROWS):
            ends = self._ends[first : first + _ROWS]
            rows = self._straight(_places(ends), begins, self._speeds)
            for end, row in zip(ends, rows.transpose(1, 0, 2), strict=True):
                if not travel.straight:
                    for j in np.argsort(row[0], kind="stable")[:_ROUTED].tolist():
                        row[:, j] = self._routed(self._pilots[0], end, j)
                yield row

    def home(self) -> tuple[Matrix, Matrix]:
        """Return (bounds, robots, stops) the seconds from homes to stops, and from there back."""
        kinematics = self._pilots[0].kinematics
        homes, begins, ends = (_places(each) for each in (self._homes(), self._begins, self._ends))
        out = self._of(kinematics.setting_out())
        up, down = np.repeat(out, len(begins)).reshape(-1, len(begins)), np.zeros((len(out), len(ends)))
        if kinematics.launches:
            ground = float(homes[:, 2].mean())
            longer = np.array([[1.0 + bound * kinematics.timing.spread] for bound in self._bounds])
            up = longer * [kinematics.launching(height - ground) for height in begins[:, 2].tolist()]
            down = longer * [kinematics.landing(height - ground) for height in ends[:, 2].tolist()]
            homes, begins, ends = (each * (1.0, 1.0, 0.0) for each in (homes, begins, ends))
        out = self._straight(homes, begins, self._speeds) + up[:, None]
        back = self._straight(ends, homes, [None] * len(homes)).transpose(0, 2, 1) + down[:, None]
        self._through_gates(out, back)
        if len(self._bounds) > 1:
            back[1] += self._diversions()
        travel = self._pilots[0].travel
        if travel.straight and not travel.entries and not travel.exits:
            return out, back
        near = np.argsort(out[0], axis=0, kind="stable")[:_ROUTED].T
        for stop, robots in enumerate(near.tolist()):
            for robot in robots:
                pilot = self._pilots[robot]
                out[:, robot, stop] = self._routed(pilot, None, stop)
                end = self._ends[stop]
                back[:, robot, stop] = (pilot.exit_seconds(end), pilot.exit_longest(end))[: len(self._bounds)]
        return out, back

    def _through_gates(self, out: Matrix, back: Matrix) -> None:
        """Replace seconds of straight routes by those through corridors, straight before and after them."""
        begins, ends = _places(self._begins), _places(self._ends)
        for robot, (travel, home) in enumerate((each.travel, each.homebound) for each in self._pilots):
            for corridors, places, found in ((travel.entries, begins, out), (travel.exits, ends, back)):
                outwards = corridors is travel.entries
                if not corridors or not (outwards or home):
                    continue
                gates = travel.gates(corridors, np.unique(places[:, 2]).tolist())
                if not gates:
                    continue
                inner = _places([*gates])
                legs = (
                    self._straight(inner, places, self._speeds)
                    if outwards
                    else self._straight(places, inner, [None] * len(inner)).transpose(0, 2, 1)
                )
                first = np.array([self._of(each) for each in gates.values()]).T
                found[:, robot] = (legs + first[:, :, None]).min(axis=1)

    def _diversions(self) -> Matrix:
        """Return (robots, stops) how much longer than landing at home a diversion from above it takes."""
        more: Matrix = np.zeros((len(self._pilots), len(self._ends)))
        heights = np.array([end[2] for end in self._ends])
        for row, pilot in zip(more, self._pilots, strict=True):
            for height in np.unique(heights).tolist() if pilot.diversions is not None else ():
                first = next(iter(pilot.travel.above_home([height])), None)
                row[heights == height] = inf if first is None else pilot.diversion_more(first)
        return more

    def _homes(self) -> list[Position]:
        return [pilot.robot.home for pilot in self._pilots]

    def _routed(self, pilot: Pilot, start: Position | None, stop: int) -> list[float]:
        """Return the seconds of the route from a place to a stop, None: from home; inf if there is none."""
        goal, travel = self._begins[stop], pilot.travel
        try:
            route = travel.leave(goal) if start is None else travel.go(start, goal)
        except UnreachableError:
            return [inf for _ in self._bounds]
        seconds = travel.at_speed(route, self._speeds[stop]).bounds
        return self._of(MoveSeconds.exactly(0.0) if start == goal else seconds)

    def _straight(self, starts: Matrix, goals: Matrix, speeds: Sequence[float | None]) -> Singles:
        """Return (bounds, starts, goals) the seconds of straight legs, at the speeds of the goals."""
        found: Singles = np.empty((len(self._bounds), len(starts), len(goals)), np.float32)
        distinct = dict.fromkeys(speeds)
        for speed in distinct:
            if speed not in self._seconds:
                rates = self._pilots[0].travel.bounds(speed)
                self._seconds[speed] = _LegSeconds(
                    [rates[1 + bound] for bound in self._bounds], self._longest
                )
            alike = [j for j, each in enumerate(speeds) if each == speed] if len(distinct) > 1 else ()
            some = alike or slice(None)
            found[:, :, some] = self._seconds[speed].between(starts, goals[some])
        return found


def _places(positions: Sequence[Position]) -> Matrix:
    return np.array(positions, dtype=np.float64).reshape(-1, 3)


class _LegSeconds:
    """The seconds of legs at one speed, from a stop to a stop.

    Those of level legs are known for lengths whose roots are as far from each other as the next ones: a short
    leg, on which a robot never reaches its speed, takes as long as the root of its length says.
    """

    def __init__(self, bounds: Sequence[Rates], longest: float) -> None:
        roots = np.linspace(0.0, longest**0.5, _LENGTHS)
        lengths = [(root * root, 0.0, 0.0) for root in roots.tolist()]
        self._per_root = np.float32((_LENGTHS - 1) / roots[-1])
        self._known: Singles = np.array(
            [[rates.from_stop_to_stop((0.0, 0.0, 0.0), each) for each in lengths] for rates in bounds],
            np.float32,
        )
        self._more = np.diff(self._known, append=self._known[:, -1:])
        self._upright = [[each.share * each.upright(sign) for sign in (1.0, -1.0)] for each in bounds]

    def between(self, starts: Matrix, goals: Matrix) -> Singles:
        """Return (bounds, starts, goals) the seconds of legs."""
        (x, y, z), (to_x, to_y, to_z) = starts.T[:, :, None], goals.T[:, None]
        level = ((to_x - x) ** 2).astype(np.float32)
        level += ((to_y - y) ** 2).astype(np.float32)
        roots = np.sqrt(np.sqrt(level, out=level), out=level)
        roots *= self._per_root
        column = roots.astype(np.int32)
        roots -= column
        found: Singles = np.empty((len(self._known), *column.shape), np.float32)
        for each, known, more in zip(found, self._known, self._more, strict=True):
            more.take(column, out=each)
            each *= roots
            each += known.take(column)
        if z.size and to_z.size and max(z.max() - to_z.min(), to_z.max() - z.min()) > LEVEL:
            rise = to_z - z
            for each, (up, down) in zip(found, self._upright, strict=True):
                with np.errstate(invalid="ignore"):  # no height takes no time, even where none can be gained
                    upright = np.abs(rise) * np.where(rise > 0.0, up, down)
                np.maximum(each, np.where(np.abs(rise) <= LEVEL, 0.0, upright), out=each)
        return found


def _nearest(go: Singles) -> Indices:
    """Return, by stop, the others from which robots come there soonest, or to which they do."""
    stops = go.shape[1]
    count = min(_NEAREST, stops - 1)
    found: Indices = np.zeros((stops, count), np.int64)
    for first in range(0, stops if count else 0, _ROWS):
        some = np.arange(first, min(first + _ROWS, stops))
        both = np.minimum(go[:, some], go[:, :, some].transpose(0, 2, 1)).min(axis=0)
        both[np.arange(len(some)), some] = inf
        nearest = np.argpartition(both, count - 1)[:, :count]
        order = np.lexsort((nearest, np.take_along_axis(both, nearest, 1)))
        found[some] = np.take_along_axis(nearest, order, 1)
    return found


def _nearest_robots(out: Matrix) -> Indices:
    """Return, by stop, the robots that are there soonest; those at one place take turns."""
    robots, stops = out.shape
    turn = (np.arange(robots)[None, :] - np.arange(stops)[:, None]) % robots
    soonest = out.T.round(6) + turn * (5e-7 / robots)
    count = min(_NEAREST_ROBOTS, robots)
    nearest = np.argpartition(soonest, count - 1)[:, :count]
    order = np.argsort(np.take_along_axis(soonest, nearest, 1))
    return np.take_along_axis(nearest, order, 1)
