"""The best plan of one search: with some number of robots for each task, who are kept apart."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from math import floor
from typing import Protocol

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.assembly import assemble, idle_apart
from mmrs_core.planning.bounds import least_makespan
from mmrs_core.planning.conflicts import TooNearError
from mmrs_core.planning.deconfliction import (
    alternatives,
    best_signalled,
    better,
    kept_apart,
    taking_turns,
    unasked_returns,
)
from mmrs_core.planning.effort import Effort, SearchLimit
from mmrs_core.planning.jobs import Job, jobs_of
from mmrs_core.planning.limits import is_small
from mmrs_core.planning.refusals import in_words, reasons_for, shared_choices, with_remedies
from mmrs_core.planning.remedies import or_else, too_long
from mmrs_core.planning.schedule import Decisions, Schedule, Shortfall, schedule
from mmrs_core.planning.search import broken_times, find_decisions, robot_counts
from mmrs_core.planning.team import Team, teams_to_try
from mmrs_core.planning.time_remedies import for_times, later_times
from mmrs_core.scene import Plan, RobotPlan, Scene

_FAIR = 1.2
"""Times the mission time without separation up to which no other team is planned to keep apart for less."""

_SPARING = 3
"""Times that robots keep more of their charges, where those do not suffice for what was found."""


class _Find(Protocol):
    """Returns the best decisions found for a team, with their schedule."""

    def __call__(self, team: Team, *, in_turns: bool) -> tuple[Decisions, Schedule | Shortfall]: ...


@dataclass(frozen=True, slots=True)
class _Search:
    """How decisions are found, and what was found so far.

    Attributes:
        find: decisions.
        effort: that it may make.
        dear: plans whose robots are kept apart at a cost, if at all.
        tried: makespans by what robots do, before they are kept apart.
        unlimited: a plan without deadlines and longest durations, where some are not kept in it.
    """

    find: _Find
    effort: Effort
    dear: list[tuple[Team, Plan]]
    tried: dict[tuple[RobotPlan, ...], float]
    unlimited: Plan | None


def planned(scene: Scene, seed: int, effort: Effort) -> Plan:
    """Return a plan of a scene without relays, as it is.

    Args:
        scene: expanded.
        seed: of the local search.
        effort: that it may make.

    Raises:
        InfeasibleError: no plan was found; its reasons may be an `UnexplainedError`'s, not sought yet.
    """
    jobs = jobs_of(scene)
    team = Team(scene)
    if short := [*with_remedies(team, jobs), *shared_choices(scene, jobs)]:
        able = [*_alone([job for job in jobs if all(map(team.able, job.tasks()))])]
        _refuse([*short, *min((too_long(each, able) for each in teams_to_try(team)), key=len)], "no plan")
    unlimited: Plan | None = None
    if (free := _without_limits(scene)) != scene:
        trial = effort.trial()
        unlimited = planned(free, seed, trial)
        effort.stopped = effort.stopped or trial.stopped
        if not broken_times(team, _spans(unlimited)):
            return unlimited
    teams = _Remembered(teams_to_try(team))
    effort.least = least_makespan(team, jobs)
    find = partial(find_decisions, jobs=jobs, effort=effort)
    best: Mapping[str, int] = {}
    found, refusal = None, InfeasibleError("no plan")
    dear, tried = list[tuple[Team, Plan]](), dict[tuple[RobotPlan, ...], float]()
    tries = ((wanted, partial(find, seed=seed)) for wanted in ({}, *robot_counts(team, jobs)))
    longer = ((best, partial(find, seed=seed + 1, long=True)) for _ in range(effort.timed))
    for wanted, each in chain(tries, longer):
        if found is not None and effort.over:
            break
        try:
            made = _plan_asking(teams, wanted, jobs, _Search(each, effort, dear, tried, unlimited), found)
        except _NotBetterError:
            continue
        except InfeasibleError as error:
            refusal = refusal if wanted else error
            continue
        found, best = made, best if made is found else wanted
    found = best_signalled(scene, dear, found, effort)
    if found is None:
        raise refusal
    soonest = min(tried.values())
    return replace(idle_apart(scene, found, tried), lower_bound=effort.least, unseparated=soonest)


def _without_limits(scene: Scene) -> Scene:
    tasks = (replace(task, deadline=None, longest=None) for task in scene.tasks)
    return replace(scene, tasks=tuple(tasks))


def _spans(made: Plan) -> dict[str, tuple[float, float]]:
    return {name: (begin, made.ends[name]) for name, begin in made.begins.items()}


def _alone(jobs: Sequence[Job]) -> Iterator[Job]:
    """Yield jobs that wait for none but each other."""
    names = {job.name for job in jobs}
    yield from (replace(job, after=tuple(each for each in job.after if each in names)) for job in jobs)


def _plan_asking(
    teams: Iterable[Team], wanted: Mapping[str, int], jobs: Sequence[Job], search: _Search, best: Plan | None
) -> Plan:
    shortage = InfeasibleError("no plan")
    for each in teams:
        try:
            return _plan_with(each.wanting(wanted) if wanted else each, jobs, search, best)
        except _ShortError as error:
            shortage = error
    raise shortage


class _Remembered:
    """Crews that are made when they are first asked for, and kept."""

    def __init__(self, teams: Iterator[Team]) -> None:
        self._coming, self._made = teams, list[Team]()

    def __iter__(self) -> Iterator[Team]:
        yield from self._made
        for each in self._coming:
            self._made.append(each)
            yield each


class _NotBetterError(InfeasibleError):
    """A plan is not better than one before, or the same, even before its robots are kept apart."""


class UnexplainedError(InfeasibleError):
    """There is no plan of some sort; the reasons are found only if there is none of any sort."""

    def __init__(self, what: str, find_reasons: Callable[[], Sequence[str]]) -> None:
        super().__init__(what)
        self._find_reasons = find_reasons

    def in_full(self) -> InfeasibleError:
        """Return the same with its reasons."""
        reasons = self._find_reasons()
        return InfeasibleError(in_words(str(self), reasons), reasons)


class _ShortError(UnexplainedError):
    """No robot is left to do some job, perhaps only because of constraints put on the team."""


def _plan_with(team: Team, jobs: Sequence[Job], search: _Search, best: Plan | None) -> Plan:
    """Return a plan of a team, or of one like it where robots that come too near are kept apart for less.

    It is the best so far if that is better.

    Args:
        team: as it is.
        jobs: of the scene.
        search: finds decisions.
        best: the best so far.

    Raises:
        InfeasibleError: no plan was found, or no better one is to be expected.
    """
    refusal: TooNearError | None = None
    found: Plan | None = None
    try:
        found, made = _plan_of(team, jobs, search, best)
        best = better(made, best)
        if made.makespan <= _FAIR * found.makespan:
            return best
    except TooNearError as error:
        refusal = error
    tries = ((other, False) for other in alternatives(team, found, refusal))
    turns = ((other, True) for other in taking_turns(team, refusal))
    while not (limit := SearchLimit(best, search.effort)).over:
        # Turns lead to a plan soonest, but mostly to a long one.
        other, in_turns = next(chain(turns, tries) if limit.late else chain(tries, turns), (None, False))
        if other is None:
            break
        try:
            _, made = _plan_of(other, jobs, search, best, in_turns=in_turns)
        except InfeasibleError:
            continue
        best = better(replace(made, notes=(*unasked_returns(team, other, made), *made.notes)), best)
        if found is None or best.makespan <= _FAIR * found.makespan:
            break
    if best is None:
        if refusal is None:
            raise InfeasibleError("no plan")
        raise UnexplainedError(
            "no plan was found that keeps robots apart", partial(_too_near, team, refusal, search.unlimited)
        )
    return best


def _too_near(team: Team, refusal: TooNearError, unlimited: Plan | None) -> list[str]:
    """Return why robots cannot be kept apart, with a smaller distance or deadlines with which they can."""
    scene, remedies = team.scene, list[str]()
    asked = scene.minimum_separation or 0.0
    for least in (asked - refusal.short, asked / 2.0, asked / 4.0):
        rounded = floor(10.0 * least) / 10.0
        if remedies or rounded <= 0.0 or not is_small(scene):
            break
        with suppress(InfeasibleError):
            planned(replace(scene, minimum_separation=rounded), 0, Effort())
            remedies.append(f"a minimumSeparation of {rounded:g} m")
    if unlimited is not None:
        remedies.append(" with ".join(later_times(team, _spans(unlimited))))
    return [f"{refusal}{or_else(remedies)}"]


def _plan_of(
    team: Team, jobs: Sequence[Job], search: _Search, best: Plan | None, *, in_turns: bool = False
) -> tuple[Plan, Plan]:
    """Return a plan as it was found, and as its robots keep apart; refuse one that is not better."""
    decisions, first = _first_of(team, jobs, search, in_turns=in_turns)
    # Legs of missions that are uploaded may take longer than each of them was counted for in the search.
    for _ in range(_SPARING):
        if not (missing := team.charges.missing(first)):
            break
        spared = team.sparing(missing)
        try:
            decisions, first = _first_of(spared, jobs, search, in_turns=in_turns)
        except InfeasibleError:
            break
        team = spared
    known = first.robots in search.tried
    search.tried[first.robots] = first.makespan
    if known or better(first, best) is best:
        raise _NotBetterError("no better plan")
    made = kept_apart(team, jobs, decisions, first, SearchLimit(best, search.effort), search.dear)
    _refuse_late(team, jobs, _spans(made), lambda: made.robots)
    return first, made


def _first_of(team: Team, jobs: Sequence[Job], search: _Search, *, in_turns: bool) -> tuple[Decisions, Plan]:
    """Return decisions and their plan before its robots are kept apart."""
    decisions, found = search.find(team, in_turns=in_turns)
    if isinstance(found, Shortfall):
        raise _ShortError("no plan", partial(reasons_for, team, jobs, found))
    _refuse_late(team, jobs, found.spans, lambda: _robots(team, jobs, decisions))
    recorded = schedule(team, jobs, decisions, record=True)
    if isinstance(recorded, Shortfall):
        raise InfeasibleError("no plan: the decisions found cannot be carried out")
    return decisions, assemble(team, jobs, recorded)


def _robots(team: Team, jobs: Sequence[Job], decisions: Decisions) -> Sequence[RobotPlan]:
    found = schedule(team, jobs, decisions, record=True)
    return assemble(team, jobs, found).robots if isinstance(found, Schedule) else ()


def _refuse(reasons: Sequence[str], what: str) -> None:
    if reasons:
        raise InfeasibleError(in_words(what, reasons), reasons)


def _refuse_late(
    team: Team,
    jobs: Sequence[Job],
    spans: Mapping[str, tuple[float, float]],
    robots: Callable[[], Sequence[RobotPlan]],
) -> None:
    if broken_times(team, spans):
        raise UnexplainedError("no plan keeps all times", lambda: [*for_times(team, jobs, spans, robots())])
