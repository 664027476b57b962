"""Why a plan is as it is: what its mission time is spent on, what alternatives would cost, which limit binds.

Nothing here is estimated. The plan's own decisions (who does which task, in which order) go once more through
`schedule` with one of them changed, or with one limit lifted; what is reported is the difference.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from graphlib import TopologicalSorter
from itertools import pairwise
from math import dist, inf

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.charges import Charges
from mmrs_core.planning.corridors import gone_through
from mmrs_core.planning.critical_path import Link, critical_path
from mmrs_core.planning.departures import begun_no_earlier, near, without_charges
from mmrs_core.planning.jobs import Job, is_control, jobs_of
from mmrs_core.planning.materials import allowed_by_charge, kept_of_charge
from mmrs_core.planning.planner import plan
from mmrs_core.planning.relaying import without_relays
from mmrs_core.planning.schedule import Decisions, Schedule, schedule
from mmrs_core.planning.search import broken_times
from mmrs_core.planning.separation import distance_to_keep
from mmrs_core.planning.team import Team, teams_to_try
from mmrs_core.scene import Branch, Plan, Position, Scene, Serve, Step

_MOST = 400_000
"""Schedules that are tried, times their jobs, at most."""

_NEAREST = 5
"""Other robots that are tried for a task: those whose homes or tasks are nearest to it."""

_FEW_PAIRS = 40
"""Jobs times robots up to which the mission is planned once more without each limit."""

_FEW_APART = 12
"""Jobs times robots up to which robots are kept apart in those missions, too."""

_SAME = 0.05
"""Seconds below which schedules are the same."""


@dataclass(frozen=True, slots=True)
class Alternative:
    """Other robots for a task, at its best place in their order, all else as in the plan.

    Attributes:
        robots: that would do it.
        later: seconds by which the mission would end later; negative: sooner; inf: see `fault`.
        task_later: likewise, by which the task would.
        longer: seconds by which all robots together would be busy longer.
        fault: why there can be no such plan; empty: there can.
    """

    robots: tuple[str, ...]
    later: float = inf
    task_later: float = inf
    longer: float = inf
    fault: str = ""


@dataclass(frozen=True, slots=True)
class TaskExplanation:
    """Why some robots do a task, or the branches of a fork.

    Attributes:
        task: its name.
        robots: that do it.
        alternatives: best first.
        unable: by robot: why it cannot do it.
        tried: whether alternatives were tried: of very many tasks, those on the critical path come first.
    """

    task: str
    robots: tuple[str, ...]
    begin: float
    end: float
    alternatives: tuple[Alternative, ...]
    unable: Mapping[str, str]
    tried: bool = True


@dataclass(frozen=True, slots=True)
class Limit:
    """Something that the plan has to keep to.

    Attributes:
        name: what.
        cost: seconds by which the mission would end sooner without it, all else as in the plan.
        margin: how close the plan comes to it, in words; empty: nothing is known.
    """

    name: str
    cost: float
    margin: str = ""


@dataclass(frozen=True, slots=True)
class PlanExplanation:
    """Why a plan is as it is.

    Attributes:
        makespan: of the plan.
        lower_bound, planned: of the plan.
        backs: by robot: seconds after the start at which it is back, last one first.
        chain: what the mission time is spent on.
        limits: those that cost most first.
        tasks: in the order in which they begin.
        idle: by robot without work: the task that it would do best, and at what cost; None: none was tried.
        apart: whether robots keep apart, so that alternatives are compared before they wait for that.
        lifted_near: whether missions without a limit are so compared, too.
    """

    makespan: float
    lower_bound: float
    backs: tuple[tuple[str, float], ...]
    chain: tuple[Link, ...]
    limits: tuple[Limit, ...]
    tasks: tuple[TaskExplanation, ...]
    idle: Mapping[str, tuple[str, Alternative] | None]
    apart: bool = False
    lifted_near: bool = False
    planned: float = 0.0


def explain(scene: Scene, plan: Plan, timed: Plan | None = None) -> PlanExplanation:
    """Return why the plan of an expanded scene is as it is.

    Args:
        scene: expanded.
        plan: of that scene.
        timed: the plan with the times to tell; None: the planner's.
    """
    return _Explaining(scene, plan, timed or plan).all()


class _Explaining:
    def __init__(self, scene: Scene, plan: Plan, timed: Plan) -> None:
        self._whole_scene, self._whole = scene, plan
        scene = replace(scene, timed=scene.timed or plan.timed)
        scene, plan = without_relays(begun_no_earlier(scene, plan.earliest), plan)
        self._scene, self._plan, self._timed, self._jobs = scene, plan, timed, jobs_of(scene)
        self._groups = _groups(plan)
        self._decisions = Decisions(_order(plan, self._jobs), self._groups)
        for self._team in teams_to_try(Team(scene)):
            self._found = schedule(self._team, self._jobs, self._decisions)
            if isinstance(self._found, Schedule):
                self._ends = _ends_of(self._team, self._found)
                break
        self._left = _MOST // max(1, len(self._jobs))
        self._stops = dict[str, list[Position]]()
        self._apart = distance_to_keep(self._scene) is not None
        few = len(self._jobs) * len(scene.robots) <= _FEW_APART
        self._lifted_near = self._apart and (bool(scene.stations) or not few)

    def all(self) -> PlanExplanation:
        chain = critical_path(self._timed)
        critical = [link.task for link in chain]
        jobs = [job for job in self._jobs if job.name in self._groups]
        jobs.sort(key=lambda job: job.name not in critical)
        tasks = sorted((self._task(job) for job in jobs), key=lambda each: (each.begin, each.task))
        ends = [(each.robot, each.steps[-1].end) for each in self._timed.robots if each.steps]
        return PlanExplanation(
            self._timed.makespan,
            self._timed.lower_bound,
            tuple(sorted(ends, key=lambda each: -each[1])),
            chain,
            tuple(sorted(self._limits(), key=lambda each: -each.cost)),
            tuple(tasks),
            {each.robot: _best_for(each.robot, tasks) for each in self._plan.robots if not each.steps},
            self._apart,
            self._lifted_near,
            self._timed.planned,
        )

    def _task(self, job: Job) -> TaskExplanation:
        mine, begin, end = self._groups[job.name], self._timed.begins[job.name], self._end_of(job)
        if self._left <= 0 or not isinstance(self._found, Schedule):
            return TaskExplanation(job.name, mine, begin, end, (), {}, tried=False)
        able = [name for name in self._team.pilots if self._able(job, name)]
        others = self._team.pilots.keys() - set(able)
        unable = {name: self._why_not(job, name) for name in self._team.pilots if name in others}
        tried = list[Alternative]()
        for robots in self._others(job, mine, able):
            other = self._tried(job, robots, list(self._orders(job, set(robots) - set(mine))), self._found)
            if any(abs(each) > _SAME for each in (other.later, other.task_later, other.longer)):
                tried.append(other)  # else a robot that could join has got no share
        tried.sort(key=lambda each: (round(each.later, 1), round(each.longer, 1)))
        return TaskExplanation(job.name, mine, begin, end, tuple(tried), unable)

    def _end_of(self, job: Job) -> float:
        return max(self._timed.ends.get(name, 0.0) for name in (job.name, *job.tasks()))

    def _able(self, job: Job, robot: str) -> bool:
        return all(self._team.forwards(task, robot) is not None for task in job.tasks())

    def _why_not(self, job: Job, robot: str) -> str:
        reasons = (self._team.refusal(task, robot) for task in job.tasks())
        return next(filter(None, reasons), "it cannot do the task")

    def _others(self, job: Job, mine: tuple[str, ...], able: Sequence[str]) -> Iterator[tuple[str, ...]]:
        """Yield other robots for a job: one instead of another, one more, or one less."""
        wanted = 1 if job.choice is not None else self._team.tasks[job.name].wanted
        outside = [name for name in able if name not in mine]
        near = sorted(outside, key=lambda name: self._distance(job, name))[:_NEAREST]
        for name in near:
            if wanted is not None or len(mine) == 1:
                yield from ((*(each for each in mine if each != one), name) for one in mine)
            if wanted is None and self._team.sharers(job.name) > len(mine):
                yield (*mine, name)
        if wanted is None and len(mine) > 1:
            yield from (tuple(each for each in mine if each != one) for one in mine)

    def _distance(self, job: Job, robot: str) -> float:
        """Return the metres from a job to the nearest of what a robot does, and of its home."""
        here = self._place(job.tasks()[0], robot)
        if robot not in self._stops:
            jobs = (each for each in self._jobs if robot in self._groups.get(each.name, ()))
            stops = [self._place(task, robot) for each in jobs for task in each.tasks()]
            self._stops[robot] = [self._team.pilots[robot].robot.home, *stops]
        return min(dist(here[:2], there[:2]) for there in self._stops[robot])

    def _place(self, task: str, robot: str) -> Position:
        return self._scene.works[task, robot].strokes[0].points[0]

    def _orders(self, job: Job, joining: set[str]) -> Iterator[tuple[str, ...]]:
        """Yield orders of jobs in which one comes before, between and after those of robots that join it.

        What has priority stays ahead of what has not.
        """
        order = self._decisions.order
        yield order
        rest = [name for name in order if name != job.name]
        rank = {
            each.name: max((self._team.tasks[t].priority for t in each.tasks()), default=0)
            for each in self._jobs
        }
        theirs = [i for i, name in enumerate(rest) if not joining.isdisjoint(self._groups.get(name, ()))]
        for place in dict.fromkeys((*theirs, *(i + 1 for i in theirs[-1:]))):
            made = (*rest[:place], job.name, *rest[place:])
            kept = all(rank[a] >= rank[job.name] for a in rest[:place])
            if made != order and kept and all(rank[b] <= rank[job.name] for b in rest[place:]):
                yield made

    def _tried(
        self, job: Job, robots: tuple[str, ...], orders: Sequence[tuple[str, ...]], found: Schedule
    ) -> Alternative:
        names = tuple(name for name in self._team.pilots if name in robots)
        best = Alternative(names, fault=self._short_of_charge(job, names))
        self._left -= len(orders)
        for order in orders:
            decisions = Decisions(order, {**self._groups, job.name: names})
            other = schedule(self._team, self._jobs, decisions)
            if not isinstance(other, Schedule):
                continue
            ends = _ends_of(self._team, other)
            broken = next(
                (f"'{task}' {words}" for task, words, _ in broken_times(self._team, other.spans)), ""
            )
            each = Alternative(
                names,
                max(ends) - max(self._ends),
                other.spans[job.name][1] - found.spans[job.name][1],
                sum(ends) - sum(self._ends),
                broken,
            )
            best = min(best, each, key=lambda one: (bool(one.fault), round(one.later, 1), one.longer))
        return best

    def _short_of_charge(self, job: Job, robots: Sequence[str]) -> str:
        short = (each for task in job.tasks() for each in self._team.short_of_charge(task))
        mine = [each for each in short if each.partition(":")[0] in robots]
        return "; ".join(mine) or "charges do not suffice"

    def _limits(self) -> Iterator[Limit]:
        """Yield what binds the plan, and by how much: each limit that the mission has."""
        scene, found = self._scene, self._found
        if not isinstance(found, Schedule):
            return
        apart = self._apart
        soonest = min(max(self._ends, default=0.0), self._whole.unseparated or inf)
        if scene.stations and self._ends:
            names = ", ".join(f"'{station.name}'" for station in scene.stations)
            relays = (
                f"relay {names}, which comes" if len(scene.stations) == 1 else f"relays {names}, which come"
            )
            words = f"robots wait for {relays} home last{', and keep apart' if apart else ''}"
            yield Limit("relays", self._whole.makespan - soonest, words)
        elif apart and self._ends:
            words = f"robots keep {scene.minimum_separation:g} m apart"
            yield Limit("separation", self._plan.makespan - soonest, words)
        if any(job.after for job in self._jobs):
            jobs = [replace(job, after=()) for job in self._jobs]
            forks = any(is_control(task) for task in scene.tasks)
            free = scene if forks else replace(scene, dependencies=())
            sooner = self._sooner(free, jobs, again=not forks)
            yield Limit("dependencies", sooner, _waits_in(critical_path(self._plan)))
        if any(task.earliest for task in self._whole_scene.tasks):
            tasks = tuple(replace(task, earliest=None) for task in scene.tasks)
            yield Limit("earliest times", self._sooner(replace(scene, tasks=tasks), self._jobs))
        if margin := self._deadline():
            yield Limit("deadlines", 0.0, margin)
        if any(task.wanted is not None and task.name in self._groups for task in scene.tasks):
            yield self._numbers()
        if used := self._corridors():
            yield Limit("corridors", self._sooner(replace(scene, corridors=()), self._jobs), used)
        if scene.transit_altitude is not None:
            sooner = self._sooner(replace(scene, transit_altitude=None), self._jobs)
            yield Limit("transitAltitude", sooner, f"robots transit at {scene.transit_altitude:g} m")
        if margin := self._charge():
            yield Limit("charge", self._without_charge(), margin)

    def _sooner(
        self, scene: Scene, jobs: Sequence[Job], decisions: Decisions | None = None, *, again: bool = True
    ) -> float:
        """Return by how many seconds the mission ends sooner in a scene like it.

        Args:
            scene: without a limit.
            jobs: of it.
            decisions: for it; None: the plan's.
            again: whether a small scene is planned once more, too.
        """
        team = Team(scene)
        found = schedule(team, jobs, decisions or self._decisions)
        sooner = max(self._ends) - max(_ends_of(team, found)) if isinstance(found, Schedule) else 0.0
        if again and len(jobs) * len(scene.robots) <= _FEW_PAIRS:
            asked = {task.name: task.earliest for task in self._whole_scene.tasks}
            held = {task.name for task in scene.tasks if task.earliest is not None} & set(self._plan.earliest)
            with suppress(InfeasibleError):
                lifted = near(scene) if self._lifted_near or not self._apart else scene
                other = plan(begun_no_earlier(lifted, {name: asked[name] for name in held}))
                mine = (
                    self._whole.unseparated or max(self._ends) if lifted is not scene else self._plan.makespan
                )
                sooner = max(sooner, mine - other.makespan)
        return max(0.0, sooner)

    def _numbers(self) -> Limit:
        tasks = tuple(replace(task, wanted=None) for task in self._scene.tasks)
        free = {task.name for task in self._scene.tasks if task.wanted is not None}
        groups = {name: group for name, group in self._groups.items() if name not in free}
        decisions = replace(self._decisions, groups=groups)
        return Limit("robotsWanted", self._sooner(replace(self._scene, tasks=tasks), self._jobs, decisions))

    def _without_charge(self) -> float:
        if all(each.sorties < 2 for each in self._plan.robots):
            return 0.0
        return self._sooner(without_charges(self._scene), self._jobs)

    def _charge(self) -> str:
        """Return which sortie is nearest to its limit, in words; empty where there is no limit."""
        pilots = Team(self._whole_scene).pilots if self._scene.stations else self._team.pilots
        most = Charges(pilots).most_used(self._whole)
        used = [
            (most[each.robot] / allowed, each.robot)
            for each in self._whole.robots
            if each.steps and (allowed := allowed_by_charge(pilots[each.robot])) < inf
        ]
        if not used:
            return ""
        share, robot = max(used)
        pilot = pilots[robot]
        part = f"{most[robot]:.0f} of the {allowed_by_charge(pilot):.0f} s of a charge{kept_of_charge(pilot)}"
        return f"'{robot}' uses up to {part} ({100.0 * share:.0f} %)"

    def _corridors(self) -> str:
        """Return which robots come in and go out through which corridors, in words; empty: through none."""
        users = dict[tuple[str, str], list[str]]()
        for each in self._whole.robots:
            through = gone_through(each.steps, self._scene.corridors)
            for direction, names in through.items():
                for name in names:
                    users.setdefault((name, direction), []).append(f"'{each.robot}'")
        verbs = {"in": ("comes", "come"), "out": ("goes", "go")}
        return "; ".join(
            f"{', '.join(robots)} {verbs[direction][len(robots) > 1]} {direction} through '{name}'"
            for (name, direction), robots in users.items()
        )

    def _deadline(self) -> str:
        spare = [
            (task.deadline - self._timed.ends[task.name], task.name)
            for task in self._whole_scene.tasks
            if task.deadline is not None and task.name in self._timed.ends
        ]
        return f"'{min(spare)[1]}' ends {min(spare)[0]:.0f} s before its deadline" if spare else ""


def _waits_in(chain: Sequence[Link]) -> str:
    """Return which robots wait for tasks of others, in words."""
    waits = [(one, two) for one, two in pairwise(chain) if one.robot != two.robot]
    whose = [f"'{one.task}' of '{one.robot}'" if one.task else f"'{one.robot}'" for one, _ in waits]
    return ", ".join(
        f"'{two.robot}' waits for {what}" for what, (_, two) in zip(whose[:_NEAREST], waits, strict=False)
    )


def _best_for(robot: str, tasks: Sequence[TaskExplanation]) -> tuple[str, Alternative] | None:
    """Return the task that a robot could do at the least cost; None if it was tried for none."""
    mine = [(task.task, each) for task in tasks for each in task.alternatives if robot in each.robots]
    return min(mine, key=lambda each: (bool(each[1].fault), each[1].later), default=None)


def _ends_of(team: Team, found: Schedule) -> list[float]:
    """Return when each robot with something to do has finished: where it is, if it need not return."""
    return [team.pilots[name].finish(found.states[name]).time for name in found.backs]


def _groups(plan: Plan) -> dict[str, tuple[str, ...]]:
    """Return, by job, the robots that do it, in the plan's order."""
    groups = dict[str, tuple[str, ...]]()
    for each in plan.robots:
        for name in _served(each.steps):
            groups[name] = (*groups.get(name, ()), each.robot)
    return groups


def _served(steps: Sequence[Step]) -> tuple[str, ...]:
    """Return the names of the jobs of a robot's steps, in order."""
    return tuple(dict.fromkeys(step.task for step in steps if isinstance(step, Serve | Branch)))


def _order(plan: Plan, jobs: Sequence[Job]) -> tuple[str, ...]:
    """Return all jobs in an order in which every robot does its own in the plan's order."""
    place = {job.name: i for i, job in enumerate(jobs)}
    sorter = TopologicalSorter[str]({job.name: job.after for job in jobs})
    for each in plan.robots:
        for before, after in pairwise(_served(each.steps)):
            sorter.add(after, before)
    sorter.prepare()
    order = list[str]()
    while sorter.is_active():
        ready = sorted(sorter.get_ready(), key=lambda name: (plan.begins.get(name, inf), place[name]))
        order += ready
        sorter.done(*ready)
    return tuple(order)
