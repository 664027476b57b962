"""Why a mission's times cannot be kept, and what would do."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil

from mmrs_core.planning.jobs import Job
from mmrs_core.planning.schedule import Decisions, Schedule, schedule
from mmrs_core.planning.search import broken_times
from mmrs_core.planning.team import Team
from mmrs_core.scene import Await, RobotPlan, Serve

_EARLY = 0.5
"""Seconds from which a wait that is longer since its robot may be early counts."""


def for_times(
    team: Team,
    jobs: Sequence[Job],
    spans: Mapping[str, tuple[float, float]],
    robots: Iterable[RobotPlan] = (),
) -> Iterator[str]:
    """Yield each deadline and longest duration that the best schedule found breaks, and what would do.

    Args:
        team: of the scene.
        jobs: which show when each would end as the only task.
        spans: by task: when it begins and ends.
        robots: of that schedule.
    """
    single = {job.name: replace(job, after=()) for job in jobs if job.choice is None}
    waits = dict(wait for each in robots for wait in _waits_of(team, each))
    for name, words, _ in broken_times(team, spans):
        begin, end = spans[name]
        if "deadline" not in words:
            yield f"task '{name}' {words}; {ceil(end - begin)} s would do"
            continue
        alone = schedule(team, [single[name]], Decisions((name,))) if name in single else None
        soonest = alone.spans[name][1] if isinstance(alone, Schedule) else 0.0
        sooner = (
            "; no robot can end it sooner"
            if round(end - soonest) == 0
            else f"; as the only task it would end after {ceil(soonest)} s"
            if soonest
            else ""
        )
        yield f"task '{name}' {words}{waits.get(name, '')}{sooner}; a deadline of {ceil(end)} s would do"


def later_times(team: Team, spans: Mapping[str, tuple[float, float]]) -> Iterator[str]:
    """Yield the deadline or longest duration that each task would need to begin and end as it does."""
    for name, words, _ in broken_times(team, spans):
        begin, end = spans[name]
        limit = f"deadline of {ceil(end)}" if "deadline" in words else f"maxDuration of {ceil(end - begin)}"
        yield f"a {limit} s for '{name}'"


def _waits_of(team: Team, plan: RobotPlan) -> Iterator[tuple[str, str]]:
    """Yield the tasks of a robot before which it has waited longer since it may be early, and that in words.

    By the clock it waits for a certain time, and not until one.
    """
    waits = ""
    for step, following in pairwise(plan.steps):
        if not isinstance(following, Serve) or following.task not in team.tasks:
            continue
        earliest = team.tasks[following.task].earliest
        if isinstance(step, Await) and step.until is not None and earliest is not None:
            early = step.until - earliest
            if early > _EARLY:
                waits = (
                    f"; '{plan.robot}' may come to '{following.task}' up to {ceil(early)} s earlier than"
                    f" planned, and waits until {ceil(step.until)} s for its earliestStart, {earliest:g} s"
                )
        if waits:
            yield following.task, waits
