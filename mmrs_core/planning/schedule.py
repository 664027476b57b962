"""From decisions to times: jobs one after the other, each shared out as well as can be by then.

That is the serial scheme that generates schedules (Kelley, 1963; Kolisch, 1996).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import inf
from typing import TypeVar

from mmrs_core.planning.choices import carry_out
from mmrs_core.planning.jobs import Job
from mmrs_core.planning.mixing import MixedFilling, mixes
from mmrs_core.planning.patches import in_fewer_patches
from mmrs_core.planning.sharing import Filling, ShareCandidate, Sharing, earliest, fillings
from mmrs_core.planning.states import Bounds, Ready, State
from mmrs_core.planning.team import Team
from mmrs_core.planning.turns import JobResult, TurnShare, in_turns, turn_of
from mmrs_core.scene import Task

_SOME_SIZES = (1, 2, 3, 5, 8, 13, 21)

_MOST_CANDIDATES = 3000
"""Candidates for shares, with what has been found out about them, that are kept for later schedules."""

_ROUNDING = 1e-6
"""Seconds by which sums of times may be wrong."""

_MOST_ALONE = 8
"""Robots that are tried for work that one is to do: one that begins later may need fewer sorties."""


@dataclass(frozen=True, slots=True)
class Decisions:
    """What a search may vary.

    Attributes:
        order: names of jobs; of those that may begin, the first in this order is scheduled next.
        groups: by job: how many robots share it, or which ones; missing: as many as help most.
        delays: by robot: seconds after the mission's start before which it does not leave home.
        in_turns: whether a robot leaves home only when all others are back there.
    """

    order: tuple[str, ...]
    groups: Mapping[str, int | tuple[str, ...]] = field(default_factory=dict)
    delays: Mapping[str, float] = field(default_factory=dict)
    in_turns: bool = False


@dataclass(frozen=True, slots=True)
class Schedule:
    """When what is done.

    Attributes:
        states: by robot, after its last share.
        spans: by job, (begin, end) in seconds.
        ends: by job and robot that has a share: when that share ends.
        backs: by robot that has something to do: when it is back.
    """

    states: Mapping[str, State]
    spans: Mapping[str, tuple[float, float]]
    ends: Mapping[str, Mapping[str, float]]
    backs: Mapping[str, float]

    @property
    def makespan(self) -> float:
        """Seconds until the last robot is back."""
        return max(self.backs.values(), default=0.0)


@dataclass(frozen=True, slots=True)
class Shortfall:
    """A job that no robots could be found for, by the time given if one was, and how many jobs are left."""

    job: str
    left: int


_Value = TypeVar("_Value")

_ENDED_BY = " ended by "


def signal_name(job: str, robot: str) -> str:
    """Return the name of the signal that a robot's share of a job has ended; no two are alike."""
    if _ENDED_BY in job or _ENDED_BY in robot:
        return f"{job!r}{_ENDED_BY}{robot!r}"
    return f"{job}{_ENDED_BY}{robot}"


def schedule(
    team: Team, jobs: Sequence[Job], decisions: Decisions, *, record: bool = False, limit: float = inf
) -> Schedule | Shortfall:
    """Return the schedule that follows from decisions.

    One whose makespan is beyond a limit is not of interest: as soon as that is known, it is a shortfall.

    Args:
        team: of the scene.
        jobs: of the scene.
        decisions: order, groups, delays.
        record: whether the states carry all steps.
        limit: seconds.
    """
    return _Scheduling(team, decisions, record, limit).run(jobs)


def _merged(known: Mapping[str, Mapping[str, _Value]], jobs: Iterable[str]) -> dict[str, _Value]:
    """Return what is known, by robot, of several jobs."""
    return {name: value for job in jobs for name, value in known[job].items()}


class _Scheduling:
    def __init__(self, team: Team, decisions: Decisions, record: bool, limit: float) -> None:
        self._team, self._decisions, self._record, self._limit = team, decisions, record, limit
        self._tasks = {task.name: task for task in team.scene.tasks}
        self._states: dict[str, State] = {
            name: team.starts.setdefault((name, delay), pilot.start(delay))
            for name, pilot in team.pilots.items()
            for delay in (decisions.delays.get(name, 0.0),)
        }
        self._ends: dict[str, Mapping[str, float]] = {}
        self._bounds: dict[str, Mapping[str, Bounds]] = {}
        self._spans: dict[str, tuple[float, float]] = {}
        self._busy: set[str] = set()
        self._left = sum(map(self._time_left, self._states.values()))
        self._latest = 0.0

    def run(self, jobs: Sequence[Job]) -> Schedule | Shortfall:
        place = {name: i for i, name in enumerate(self._decisions.order)}
        waiting = sorted(jobs, key=lambda job: place[job.name])
        work = sum(map(self._fewest_seconds, waiting))
        while waiting:
            job = next(job for job in waiting if all(name in self._ends for name in job.after))
            waiting.remove(job)
            work -= self._fewest_seconds(job)
            if not self._do(job) or work > self._left + _ROUNDING or self._latest > self._limit:
                return Shortfall(job.name, len(waiting) + 1)
        pilots = self._team.pilots
        backs = {
            name: state.time + (pilots[name].end_seconds(state.at) if state.away else 0.0)
            for name, state in self._states.items()
            if name in self._busy
        }
        return Schedule(self._states, self._spans, self._ends, backs)

    def _time_left(self, state: State) -> float:
        """Return the seconds that a robot has left by the limit; none are asked for without one."""
        return 0.0 if self._limit == inf else max(0.0, self._limit - state.time)

    def _fewest_seconds(self, job: Job) -> float:
        """Return seconds of work that a job takes at least, as far as a limit makes that of interest."""
        single = self._limit < inf and job.choice is None and job.tasks()
        return self._team.fewest_seconds(job.name) if single else 0.0

    def _do(self, job: Job) -> bool:
        if not job.tasks():
            before = [*job.after]
            self._ends[job.name] = _merged(self._ends, before)
            self._bounds[job.name] = _merged(self._bounds, before)
            return True
        done = self._chosen_or_shared(job, self._fillings(job)) if self._record else self._remembered(job)
        if done is None:
            return False
        for name, state in done.states.items():
            self._left += self._time_left(state) - self._time_left(self._states[name])
        self._states.update(done.states)
        self._ends[job.name], self._bounds[job.name] = done.ends, done.bounds
        self._spans[job.name] = (done.begin, max(done.ends.values()))
        self._latest = max(self._latest, self._spans[job.name][1])
        self._busy |= done.ends.keys()
        return True

    def _remembered(self, job: Job) -> JobResult | None:
        """Do a job, or return what became of it in an earlier schedule in which all that matters was alike.

        Where no robots can be back from it by the limit, it is not found out when they are.

        States stand for themselves in the key: a new one is another one.
        """
        turns = self._decisions.in_turns
        concerned: Iterable[str] = self._allowed(job)
        if turns or (job.choice is not None and concerned is self._team.pilots):
            concerned = self._team.pilots
        elif concerned is self._team.pilots:
            concerned = self._team.able(job.name)
        states = tuple(self._states[name] for name in concerned)
        before = tuple((*self._ends[name].items(), *self._bounds[name].items()) for name in job.after)
        wanted = tuple(self._tasks[name].wanted for name in job.tasks())
        key = (job.name, self._decisions.groups.get(job.name), turns, wanted, before, *map(id, states))
        _, done, limit = self._team.done.get(key, (states, None, -inf))
        if done is None and limit < self._limit:
            fillings = [] if job.choice is not None else list(self._fillings(job))
            late = self._is_late(fillings)
            done = None if late else self._chosen_or_shared(job, fillings)
            self._team.done[key] = (states, done, self._limit if late else inf)
        return done

    def _is_late(self, fillings: Sequence[Filling]) -> bool:
        """Return whether it is known that no robots can be back by the limit.

        It is not where robots end where they are: elsewhere they may be on the ground sooner.
        """
        if self._limit == inf or not fillings or self._decisions.in_turns:
            return False
        home = all(pilot.robot.return_home for pilot in self._team.pilots.values())
        return home and not any(each.shares(self._limit) for each in fillings)

    def _chosen_or_shared(self, job: Job, fillings: Iterable[Filling]) -> JobResult | None:
        return self._chosen(job) if job.choice is not None else self._shared(job, fillings)

    def _shared(self, job: Job, ways: Iterable[Filling]) -> JobResult | None:
        if self._decisions.in_turns:
            tried = [self._in_turns(found) for each in ways if (found := earliest(each))]
            return min((each for each in tried if each is not None), key=lambda each: each.back, default=None)
        best: Sharing | None = None
        for each in ways:
            best = earliest(each, inf if best is None else best.back - 1e-6) or best
        if best is None:
            return None
        return self._at_once(self._in_patches(job, best) if self._record else best)

    def _in_patches(self, job: Job, sharing: Sharing) -> Sharing:
        """Return the same robots' shares in as few patches as may be where that takes little longer."""
        task, names = self._tasks[job.name], {each.candidate.pilot.robot.name for each in sharing.shares}
        group = next((each for each in self._team.groups[job.name] if names <= set(each)), ())
        work = self._team.scene.works[job.name, group[0]] if group else None
        timed = any(each.deadline is not None or each.longest is not None for each in self._tasks.values())
        if timed or work is None or work.coverage is None or work.ordered or len(names) == 1:
            return sharing
        allowed, everyone = [*filter(names.__contains__, group)], task.wanted is not None
        laid = (self._candidates(job, task, allowed, by_rows=by_rows) for by_rows in (False, True))
        ways = (each for some in laid if some for each in fillings(some, everyone=everyone))
        return in_fewer_patches(sharing, ways, work.coverage.width)

    def _at_once(self, sharing: Sharing) -> JobResult:
        after = {share.candidate.pilot.robot.name: share.run.state(share.end) for share in sharing.shares}
        ends = {name: state.time for name, state in after.items()}
        bounds = {name: state.bounds for name, state in after.items()}
        begin = min(share.run.started() for share in sharing.shares)
        return JobResult(after, begin, ends, bounds, sharing.back)

    def _in_turns(self, sharing: Sharing) -> JobResult | None:
        parts = [
            TurnShare(each.candidate.pilot, each.run.material, each.run.begin, each.end, each.candidate.ready)
            for each in sharing.shares
        ]
        return in_turns(parts, self._states, self._team.pilots, record=self._record)

    def _ready(self, job: Job, robot: str, earliest: float | None) -> Ready:
        """Return what a robot's share of a job waits for: every other robot's share of those before."""
        others = {
            signal_name(before, name): (end, self._bounds[before][name])
            for before in job.after
            for name, end in self._ends[before].items()
            if name != robot
        }
        time = max((end for end, _ in others.values()), default=0.0)
        bounds = [each for _, each in others.values()]
        return Ready(time, tuple(others), earliest, Bounds(*map(max, zip(Bounds(), *bounds, strict=True))))

    def _chosen(self, job: Job) -> JobResult | None:
        """Give a choice to the robot that is back first after its longest arm."""
        best: JobResult | None = None
        for name in self._allowed(job):
            done = self._chosen_by(job, name)
            if done is not None and done.back < (inf if best is None else best.back - 1e-9):
                best = done
        return best

    def _chosen_by(self, job: Job, name: str) -> JobResult | None:
        pilot = self._team.pilots[name]
        turns = self._decisions.in_turns
        states = turn_of(name, self._states, self._team.pilots, job.name) if turns else self._states
        if job.choice is None or states is None:
            return None
        ready = self._ready(job, name, self._earliest(job))
        materials = partial(self._team.forwards, robot=name)
        end = carry_out(pilot, job.choice, materials, states[name], ready, record=self._record)
        if end is None:
            return None
        begin = end.trail[1].begin if end.trail is not None else end.time
        back = end.time + pilot.end_seconds(end.at)
        return JobResult({**states, name: end}, begin, {name: end.time}, {name: end.bounds}, back)

    def _earliest(self, job: Job) -> float | None:
        times = [self._tasks[name].earliest for name in job.tasks()]
        return max((time for time in times if time is not None), default=None)

    def _allowed(self, job: Job) -> Collection[str]:
        """Return the robots that may do a job: those that were decided on, or all."""
        group = self._decisions.groups.get(job.name)
        return group if isinstance(group, tuple) else self._team.pilots

    def _fillings(self, job: Job) -> Iterator[Filling]:
        """Yield the ways worth a try to share a job out."""
        task = self._tasks[job.name]
        for group in self._team.groups[job.name]:
            for some, everyone in self._choices_of(task, self._candidates(job, task, group)):
                yield from fillings(some, everyone=everyone)
        everyone = task.wanted is not None
        for mixture in self._team.mixtures[job.name]:
            groups = [self._candidates(job, task, each.robots) for each in mixture.sorts]
            for mixed in self._mixes_of(task, groups):
                some_sorts = [(sort, group) for sort, group in enumerate(mixed) if group]
                for ahead in (True, False):
                    yield MixedFilling(mixture, some_sorts, ahead=ahead, everyone=everyone)

    def _candidates(
        self, job: Job, task: Task, group: Sequence[str], *, by_rows: bool = False
    ) -> list[ShareCandidate]:
        """Return the allowed robots of a group, those first that are first back from the first portion."""
        allowed = self._allowed(job)
        if allowed is not self._team.pilots:
            group = sorted((name for name in allowed if name in group), key=group.index)
        found = []
        for name in group:
            forwards = self._team.forwards(job.name, name, by_rows=by_rows)
            if forwards is None:
                continue
            pilot, state = self._team.pilots[name], self._states[name]
            ready = self._ready(job, name, task.earliest)
            known = self._team.candidates.get(
                key := (job.name, name, id(state), ready, self._record, by_rows)
            )
            if known is None:
                backwards = partial(self._team.backwards, job.name, name, by_rows=by_rows)
                known = ShareCandidate(pilot, state, ready, forwards, backwards, self._record)
                if len(self._team.candidates) >= _MOST_CANDIDATES:
                    self._team.candidates.clear()
                self._team.candidates[key] = known
            found.append((known.run(0).back(0), known))
        return [each for _, each in sorted(found, key=lambda pair: pair[0])]

    def _choices_of(
        self, task: Task, candidates: Sequence[ShareCandidate]
    ) -> Iterator[tuple[Sequence[ShareCandidate], bool]]:
        """Yield the groups to be tried, and whether each robot in them must have a share."""
        decided = self._decisions.groups.get(task.name)
        if isinstance(decided, tuple):
            if candidates and (task.wanted is None or len(candidates) == task.wanted):
                yield candidates, task.wanted is not None
            return
        if task.wanted is not None:
            if task.wanted == 1:
                yield from (([each], True) for each in candidates[:_MOST_ALONE])
            elif task.wanted <= len(candidates):
                yield candidates[: task.wanted], True
            return
        if candidates and candidates[0].forwards.whole:
            yield from (([each], False) for each in candidates)
            return
        if decided is not None and decided < len(candidates):
            yield candidates[:decided], False
            return
        sizes = {size for size in _SOME_SIZES if size < len(candidates)} | {len(candidates)}
        yield from ((candidates[:size], False) for size in sorted(sizes) if size)

    def _mixes_of(
        self, task: Task, groups: Sequence[Sequence[ShareCandidate]]
    ) -> Iterator[Sequence[Sequence[ShareCandidate]]]:
        """Yield, by sort, the robots to be tried together, of two sorts at least."""
        decided = self._decisions.groups.get(task.name)
        if isinstance(decided, tuple):
            if sum(map(bool, groups)) > 1 and task.wanted in (None, sum(map(len, groups))):
                yield groups
            return
        robots = sum(map(len, groups))
        size = task.wanted or min(decided or robots, robots)
        for counts in mixes(tuple(map(len, groups)), size):
            yield [group[:count] for group, count in zip(groups, counts, strict=True)]
