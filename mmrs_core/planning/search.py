"""A seeded local search for decisions with which the last robot is back early.

It begins with the best of some constructed decisions, changes some at random, and keeps what is better (Aarts
and Lenstra, 1997).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice, pairwise, permutations, product
from math import ceil, factorial, inf, prod
from operator import itemgetter
from random import Random
from typing import TypeAlias

from mmrs_core.planning.allocation import allocated
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.jobs import Job
from mmrs_core.planning.mixing import MIXES
from mmrs_core.planning.schedule import Decisions, Schedule, Shortfall, schedule
from mmrs_core.planning.team import Team

Cost: TypeAlias = tuple[float, float, float]

_WORST: Cost = (inf, inf, inf)

_ALIKE = 1e-3
"""Seconds by which makespans differ at most that count as alike."""

_STEPS = 40
"""Schedules that are tried; a count, not a time, so that the same seed gives the same plan."""

_EFFORT = 3000
"""Schedules tried times their size, see `_size`, at most, where that is less."""

_MOST_PAIRS = 10_000
"""Jobs times robots up to which decisions that leave robots open are tried beside those of tours."""

_STEPS_TO_BEGIN = 200
"""Schedules that are tried as long as none does all jobs."""

_PATIENCE = 15
"""Steps without a gain after which the search ends."""


def find_decisions(
    team: Team, jobs: Sequence[Job], seed: int, effort: Effort, *, long: bool = False, in_turns: bool = False
) -> tuple[Decisions, Schedule | Shortfall]:
    """Return the best decisions found, with their schedule; a shortfall if none led to a schedule.

    Args:
        team: of the scene.
        jobs: in an order in which none comes before one that it waits for.
        seed: of the search.
        effort: that it may make.
        long: whether it takes all of its time.
        in_turns: whether a robot leaves home only when all others are back there.
    """
    order = _first_order(team, jobs)
    starts = [
        Decisions(order),
        Decisions(order, {job.name: 1 for job in jobs}),
        *(Decisions(order, {job.name: (name,) for job in jobs}) for name in _only_ones(team, jobs)),
    ]
    starts = [replace(each, in_turns=in_turns) for each in starts]
    tried = list(allocated(team, jobs, seed, effort, long=long, in_turns=in_turns))
    if len(jobs) * len(team.pilots) <= _MOST_PAIRS or not any(
        isinstance(each, Schedule) for _, each in tried
    ):
        for each in starts:
            least = min((cost_of(team, found) for _, found in tried), default=_WORST)
            tried.append((each, schedule(team, jobs, each, limit=_limit(least))))
    best, found = min(tried, key=lambda pair: cost_of(team, pair[1]))
    effort.found(cost_of(team, found)[1] if isinstance(found, Schedule) else inf)
    random, idle = Random(seed), 0
    steps = min(_STEPS, max(4, _EFFORT // _size(team, jobs)))
    for step in range(_STEPS_TO_BEGIN if len(jobs) > 1 else 0):
        if isinstance(found, Schedule) and (idle >= _PATIENCE or step >= steps or effort.over):
            break
        other = _varied(team, jobs, best, random)
        least = cost_of(team, found)
        result = schedule(team, jobs, other, limit=_limit(least))
        cost = cost_of(team, result)
        if cost < _slightly_less(least):
            best, found, idle = other, result, 0
            continue
        idle += 1
        if isinstance(found, Shortfall) and cost == least:
            best, found = other, result
    return _with_better_order(team, jobs, *_with_better_numbers(team, jobs, best, found))


def _with_better_order(
    team: Team, jobs: Sequence[Job], best: Decisions, found: Schedule | Shortfall
) -> tuple[Decisions, Schedule | Shortfall]:
    """Return decisions with the best order of few jobs, by which sorties may become fuller."""
    if factorial(len(jobs)) * _size(team, jobs) > _EFFORT:
        return best, found
    limit = _limit(cost_of(team, found))
    tried = ((each, schedule(team, jobs, each, limit=limit)) for each in _orders(team, jobs, best))
    return min(((best, found), *tried), key=lambda pair: _slightly_rounded(cost_of(team, pair[1])))


def _with_better_numbers(
    team: Team, jobs: Sequence[Job], best: Decisions, found: Schedule | Shortfall
) -> tuple[Decisions, Schedule | Shortfall]:
    """Return decisions in which each task in turn has the number of robots that helps most."""
    sizes = {job.name: team.sharers(job.name) for job in jobs if job.tasks() and job.choice is None}
    tries = [(name, size) for name, most in sizes.items() for size in range(1, most + 1) if most > 1]
    for name, size in tries if len(tries) * _size(team, jobs) <= _EFFORT else ():
        other = replace(best, groups={**best.groups, name: size})
        least = cost_of(team, found)
        result = schedule(team, jobs, other, limit=_limit(least))
        if cost_of(team, result) < _slightly_less(least):
            best, found = other, result
    return best, found


def _limit(cost: Cost) -> float:
    """Return a makespan beyond which nothing costs less."""
    return cost[1] + _ALIKE if cost[0] <= 0.0 else inf


def _only_ones(team: Team, jobs: Sequence[Job]) -> list[str]:
    """Return robots that could do all jobs, for the plan in which one robot does everything."""
    tasks = [task for job in jobs for task in job.tasks()]
    wanted = {task.name: task.wanted for task in team.scene.tasks}
    if any((wanted[task] or 1) > 1 for task in tasks):
        return []
    crews = {team.able(task) for task in tasks}
    return list(islice((name for name in team.pilots if all(name in crew for crew in crews)), 1))


def cost_of(team: Team, found: Schedule | Shortfall) -> Cost:
    """Return (seconds by which times are broken, makespan, sum of all robots' times); less is better.

    A shortfall costs (inf, jobs left, 0).
    """
    if isinstance(found, Shortfall):
        return (inf, float(found.left), 0.0)
    broken = sum(late for _, _, late in broken_times(team, found.spans))
    return (broken, found.makespan, sum(found.backs.values()))


def broken_times(team: Team, spans: Mapping[str, tuple[float, float]]) -> list[tuple[str, str, float]]:
    """Return (task, what is broken, by how many seconds) for deadlines and longest durations of tasks."""
    broken = []
    for task in team.scene.tasks:
        begin, end = spans.get(task.name, (0.0, 0.0))
        if task.deadline is not None and end > task.deadline + 1e-6:
            late = end - task.deadline
            ended = f"ends {ceil(end)} s after the start"
            words = f"{ended}, its deadline is {task.deadline:g} s: {ceil(late)} s late"
            broken.append((task.name, words, late))
        if task.longest is not None and end - begin > task.longest + 1e-6:
            over, taken = end - begin - task.longest, ceil(end - begin)
            words = f"takes {taken} s, {task.longest:g} s are allowed: {ceil(over)} s too long"
            broken.append((task.name, words, over))
    return broken


def _slightly_rounded(cost: Cost) -> Cost:
    return (round(cost[0], 6), round(cost[1], 4), round(cost[2], 4))


def _slightly_less(cost: Cost) -> Cost:
    return (cost[0] - 1e-9, cost[1], cost[2]) if 0 < cost[0] < inf else (cost[0], cost[1] - 1e-6, cost[2])


def _first_order(team: Team, jobs: Sequence[Job]) -> tuple[str, ...]:
    tails = _tails(team, jobs)
    ranks = _ranks(team, jobs)
    return tuple(sorted(ranks, key=lambda name: (-ranks[name], -tails[name])))


def _ranks(team: Team, jobs: Sequence[Job]) -> dict[str, int]:
    """Return the priority of each job."""
    priority = {task.name: task.priority for task in team.scene.tasks}
    return {job.name: max((priority[name] for name in job.tasks()), default=0) for job in jobs}


def _orders(team: Team, jobs: Sequence[Job], decisions: Decisions) -> Iterator[Decisions]:
    """Yield decisions with all other orders in which what has priority comes first."""
    ranks = _ranks(team, jobs)
    for order in islice(permutations(decisions.order), 1, None):
        if all(ranks[one] >= ranks[two] for one, two in pairwise(order)):
            yield replace(decisions, order=order)


def _tails(team: Team, jobs: Sequence[Job]) -> Mapping[str, float]:
    """Return, by job, the seconds of work of the longest chain that begins with it."""
    tails = {job.name: _seconds(team, job) for job in jobs}
    own = dict(tails)
    for job in reversed(jobs):
        for before in job.after:
            tails[before] = max(tails[before], own[before] + tails[job.name])
    return tails


def _seconds(team: Team, job: Job) -> float:
    """Return the seconds of work of a job for the robots that are slowest at it."""
    total = 0.0
    for task in job.tasks():
        materials = [team.forwards(task, robot) for robot in team.able(task)[:3]]
        total += max((each.seconds(0, len(each) - 1) for each in materials if each is not None), default=0.0)
    return total


def _varied(team: Team, jobs: Sequence[Job], decisions: Decisions, random: Random) -> Decisions:
    """Return decisions that differ in one place: who does a job, how many do, or when it comes."""
    job = random.choice(list(jobs))
    if random.random() < 0.35 and len(jobs) > 2:
        return replace(decisions, order=_swapped(team, decisions.order, random))
    tasks = job.tasks()
    able = [name for name in team.pilots if all(name in team.able(task) for task in tasks)] if tasks else []
    if not able:
        return decisions
    groups = dict(decisions.groups)
    if random.random() < 0.3 and job.name in groups:
        del groups[job.name]
    else:
        wanted = None if job.choice is not None else team.tasks[job.name].wanted
        size = wanted or min(len(able), random.choice((1, 1, 2, 2, 3, random.randint(1, len(able)))))
        groups[job.name] = tuple(sorted(random.sample(able, min(size, len(able)))))
    return replace(decisions, groups=groups)


def _swapped(team: Team, order: tuple[str, ...], random: Random) -> tuple[str, ...]:
    """Return the order with two jobs swapped, if neither has priority over the other."""
    priority = {task.name: task.priority for task in team.scene.tasks}
    one, two = sorted(random.sample(range(len(order)), 2))
    if priority.get(order[one], 0) != priority.get(order[two], 0):
        return order
    swapped = list(order)
    swapped[one], swapped[two] = swapped[two], swapped[one]
    return tuple(swapped)


_MOST_SEARCHES = 192
"""Searches times the size of a schedule, at most, but always some: what is most promising comes first."""

_FEWEST_SEARCHES = 3


def robot_counts(team: Team, jobs: Sequence[Job]) -> list[Mapping[str, int]]:
    """Return what tasks that leave the number of their robots open may want; each is worth a search.

    In a small mission that is every choice of numbers. In one so large that all these searches would
    take too long, it is what has the best first schedules of one number for one task, or for all.
    """
    most = {name: largest for name in _open_tasks(team, jobs) if (largest := team.sharers(name)) > 1}
    size = _size(team, jobs)
    room = max(_FEWEST_SEARCHES, _MOST_SEARCHES // size)
    if prod(largest + 1 for largest in most.values()) <= room + 1:
        choices = product(*([(name, count) for count in range(most[name] + 1)] for name in most))
        asked = [{name: count for name, count in choice if count} for choice in choices]
        return [each for each in asked if each]
    tries = _uniform_counts(most)[: max(room, _EFFORT // size)]
    costs: list[Cost] = []
    for each in reversed(tries):  # many robots, which are mostly better, come first
        limit = _limit(sorted(costs)[room - 1]) if len(costs) >= room else inf
        asking = team.wanting(each)
        first = schedule(asking, jobs, Decisions(_first_order(asking, jobs)), limit=limit)
        costs.append(cost_of(asking, first))
    ranked = sorted(zip(reversed(costs), tries, strict=True), key=itemgetter(0))
    return [each for _, each in ranked[:room]]


def _size(team: Team, jobs: Sequence[Job]) -> int:
    """Return how large a schedule is: jobs, with the mixes of robots that may share them, times robots."""
    names = [job.name for job in jobs if job.tasks() and job.choice is None]
    mixed = sum(MIXES * len(each.sorts) for name in names for each in team.mixtures[name])
    return max(1, (len(jobs) + mixed) * len(team.pilots))


def _uniform_counts(most: Mapping[str, int]) -> list[Mapping[str, int]]:
    single = [{name: count} for name, largest in most.items() for count in range(1, largest + 1)]
    alike = [
        {name: min(count, largest) for name, largest in most.items()}
        for count in range(1, max(most.values()) + 1)
    ]
    return [*(alike if len(most) > 1 else ()), *single]


def _open_tasks(team: Team, jobs: Sequence[Job]) -> list[str]:
    return [
        job.name for job in jobs if job.choice is None and job.tasks() and team.tasks[job.name].wanted is None
    ]
