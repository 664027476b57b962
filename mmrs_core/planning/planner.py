"""The plan of an expanded scene: which robot does what, when and along which route."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from math import ceil, floor, inf
from typing import Protocol

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.assembly import assemble, idle_apart, planned
from mmrs_core.planning.bounds import least_makespan
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.exchanging import levelled
from mmrs_core.planning.jobs import Job, jobs_of
from mmrs_core.planning.materials import allowed_by_charge, kept_of_charge
from mmrs_core.planning.relaying import plan_with_relays, relay_tasks
from mmrs_core.planning.remedies import counted, for_all_charges, for_diversions, or_else, too_long
from mmrs_core.planning.schedule import Decisions, Schedule, Shortfall, schedule
from mmrs_core.planning.search import broken_times, find_decisions, robot_counts
from mmrs_core.planning.separation import (
    TooNearError,
    Traffic,
    distance_to_keep,
    recharges,
    separated,
    stacked_altitudes,
    starting_later,
)
from mmrs_core.planning.signalling import DEAR, signalled
from mmrs_core.planning.team import Team, teams_to_try
from mmrs_core.planning.time_remedies import for_times
from mmrs_core.scene import Plan, RobotPlan, Scene


class _Find(Protocol):
    """Returns the best decisions found for a team, with their schedule."""

    def __call__(self, team: Team, *, in_turns: bool) -> tuple[Decisions, Schedule | Shortfall]: ...


@dataclass(frozen=True, slots=True)
class _Search:
    """How decisions are found, and what was found so far.

    Attributes:
        find: decisions.
        dear: plans whose robots are kept apart at a cost, if at all.
        tried: makespans by what robots do, before they are kept apart.
    """

    find: _Find
    dear: list[tuple[Team, Plan]]
    tried: dict[tuple[RobotPlan, ...], float]


def plan(scene: Scene, *, seed: int = 0, effort: Effort | None = None) -> Plan:
    """Return a plan in which the last robot is back as early as could be found.

    Every task is done exactly once, by robots that can do it, in the order of the dependencies; no
    sortie takes more than a charge less the reserve allows, waits included; every leg keeps its
    clearance. The same scene and seed give the same plan, unless a time or a stop ends the search. Where
    a task leaves open how many robots it wants, numbers are tried too (see `robot_counts`): in a small
    mission no other number ends it sooner. Deadlines and longest durations that the plan without them keeps
    change nothing. Tasks in which robots stay as relays are planned around the others
    (see `plan_with_relays`).

    Args:
        scene: expanded: kinematics and works are known.
        seed: of the local search.
        effort: that it may make; None: the steps that the mission's size asks for.

    Raises:
        InfeasibleError: no plan was found; its reasons give what is short, and by how much.
    """
    if relay_tasks(scene):
        return plan_with_relays(scene, lambda part, its: plan(part, seed=seed, effort=its), effort)
    jobs = jobs_of(scene)
    team = Team(scene)
    if short := [*_with_remedies(team, jobs), *_shared_choices(scene, jobs)]:
        able = [*_alone([job for job in jobs if all(map(team.able, job.tasks()))])]
        _refuse([*short, *min((too_long(each, able) for each in teams_to_try(team)), key=len)], "no plan")
    effort = effort or Effort()
    if (free := _without_limits(scene)) != scene:
        made = plan(free, seed=seed, effort=effort.trial())
        if not broken_times(team, _spans(made)):
            return made
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
            made = _plan_asking(teams, wanted, jobs, _Search(each, dear, tried), found)
        except _NotBetterError:
            continue
        except InfeasibleError as error:
            refusal = refusal if wanted else error
            continue
        found, best = made, best if made is found else wanted
    found = _signalled(scene, dear, found)
    if found is None:
        raise refusal.in_full() if isinstance(refusal, _UnexplainedError) else refusal
    return replace(idle_apart(scene, found, tried), lower_bound=effort.least)


def _without_limits(scene: Scene) -> Scene:
    tasks = (replace(task, deadline=None, longest=None) for task in scene.tasks)
    return replace(scene, tasks=tuple(tasks))


def _spans(made: Plan) -> dict[str, tuple[float, float]]:
    return {name: (begin, made.ends[name]) for name, begin in made.begins.items()}


def _signalled(scene: Scene, dear: Iterable[tuple[Team, Plan]], found: Plan | None) -> Plan | None:
    """Return the best plan, or a better one in which robots wait for signals of each other to keep apart."""
    plans = {
        round(each.makespan, 1): (team, each) for team, each in dear if team.scene.robots == scene.robots
    }
    ordered = [plans[makespan] for makespan in sorted(plans)]
    last = reversed(ordered[_MOST_SIGNALLED:])
    for tried, (team, each) in enumerate([*ordered[:_MOST_SIGNALLED], *last]):
        if found is not None and tried >= _MOST_SIGNALLED:
            break
        told = signalled(team, each, inf if found is None else found.makespan)
        found = found if told is None else _better(told, found)
    return found


def _alone(jobs: Sequence[Job]) -> Iterator[Job]:
    """Yield jobs that wait for none but each other."""
    names = {job.name for job in jobs}
    yield from (replace(job, after=tuple(each for each in job.after if each in names)) for job in jobs)


def _cost(made: Plan) -> tuple[float, float]:
    """Return (makespan, seconds of all robots), rounded so that only a real gain counts."""
    return (round(made.makespan, 3), round(sum(each.busy for each in made.robots), 3))


def _better(plan: Plan, best: Plan | None) -> Plan:
    return plan if best is None or _cost(plan) < _cost(best) else best


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


class _UnexplainedError(InfeasibleError):
    """There is no plan of some sort; the reasons are found only if there is none of any sort."""

    def __init__(self, what: str, find_reasons: Callable[[], Sequence[str]]) -> None:
        super().__init__(what)
        self._find_reasons = find_reasons

    def in_full(self) -> InfeasibleError:
        """Return the same with its reasons."""
        reasons = self._find_reasons()
        return InfeasibleError(_words(str(self), reasons), reasons)


class _ShortError(_UnexplainedError):
    """No robot is left to do some job, perhaps only because of constraints put on the team."""


_FAIR = 1.2
"""Times the mission time without separation up to which no other team is planned to keep apart for less."""

_PARTS = (0.75, 0.5, 0.25)
"""Parts of a team that are tried where all of it together can only be kept apart at a cost."""

_SPARE = (0.15, 0.08)
"""Parts of each charge that are then kept for flying higher, where robots recharge."""

_FEW_PAIRS = 100
"""Jobs times robots up to which a refusal is worth another whole plan."""

_WORTH_SIGNALS = 1.1
"""Times the mission time without separation from which on signals are sought beside levels."""

_MOST_SIGNALLED = 2
"""Plans, the shortest first, whose robots are then kept apart by signals; others only if there is no plan."""


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
        best = _better(made, best)
        if made.makespan <= _FAIR * found.makespan:
            return best
    except TooNearError as error:
        refusal = error
    for other, in_turns in _alternatives(team, found, refusal):
        try:
            _, made = _plan_of(other, jobs, search, best, in_turns=in_turns)
        except InfeasibleError:
            continue
        best = _better(replace(made, notes=(*_unasked_returns(team, other, made), *made.notes)), best)
        if found is None or best.makespan <= _FAIR * found.makespan:
            break
    if best is None:
        if refusal is None:
            raise InfeasibleError("no plan")
        raise _UnexplainedError(
            "no plan was found that keeps robots apart", partial(_too_near, team, jobs, refusal)
        )
    return best


def _too_near(team: Team, jobs: Sequence[Job], refusal: TooNearError) -> list[str]:
    """Return why robots cannot be kept apart, with a smaller distance at which they can."""
    scene = team.scene
    least = floor(10.0 * ((scene.minimum_separation or 0.0) - refusal.short)) / 10.0
    if least > 0.0 and len(jobs) * len(scene.robots) <= _FEW_PAIRS:
        with suppress(InfeasibleError):
            plan(replace(scene, minimum_separation=least))
            return [f"{refusal}; a minimumSeparation of {least:g} m would do"]
    return [str(refusal)]


def _unasked_returns(team: Team, other: Team, made: Plan) -> Iterator[str]:
    before = {robot.name: robot.return_home for robot in team.scene.robots}
    returning = {robot.name for robot in other.scene.robots if robot.return_home and not before[robot.name]}
    names = [each.robot for each in made.robots if each.robot in returning and each.steps]
    if names:
        ends = "returns home unasked" if len(names) == 1 else "return home unasked"
        yield f"{', '.join(names)} {ends}, so that robots on the ground keep apart"


def _alternatives(team: Team, found: Plan | None, error: TooNearError | None) -> Iterator[tuple[Team, bool]]:
    """Yield (team, whether its robots fly one after the other) that may help where robots come too near.

    Robots may keep some of each charge for levels, transit one above the other, stay at home in part, keep
    away from where others stand at home, end at home where they need not, or take turns.
    """
    altitudes, least = stacked_altitudes(team.scene), distance_to_keep(team.scene)
    charging = any(
        each.kinematics.recharge is not None and each.charge < inf for each in team.pilots.values()
    )
    if charging if found is None else recharges(found):
        yield from ((team.changed(team.homebound, spare=each), False) for each in _SPARE)
    if altitudes:
        yield team.changed(team.homebound, altitudes=altitudes), False
    for smaller in _smaller(team, found) if found is not None else ():
        yield smaller, False
        if altitudes:
            yield smaller.changed(team.homebound, altitudes=altitudes), False
    if error is None:
        return
    if error.at_home:
        yield team.changed(team.homebound, from_homes=least), False
    before = team.scene.robots
    for names in dict.fromkeys((error.robots, frozenset(team.pilots))):
        robots = tuple(replace(robot, return_home=True) if robot.name in names else robot for robot in before)
        if robots != before:
            yield team.changed(None, robots=robots, from_homes=least), False
    everyone = frozenset(team.pilots)
    yield team.changed(everyone), True
    yield team.changed(everyone, from_homes=least), True


def _smaller(team: Team, found: Plan) -> Iterator[Team]:
    """Yield teams of which only those robots leave home that have most to do in a plan."""
    busiest = sorted((each for each in found.robots if each.steps), key=lambda each: -each.busy)
    for part in _PARTS:
        names = {each.robot for each in busiest[: ceil(part * len(busiest))]}
        smaller = team.at_home(frozenset(team.pilots) - names)
        if not any(smaller.shortfalls()):
            yield smaller


def _plan_of(
    team: Team, jobs: Sequence[Job], search: _Search, best: Plan | None, *, in_turns: bool = False
) -> tuple[Plan, Plan]:
    """Return a plan as it was found, and as its robots keep apart; refuse one that is not better."""
    decisions, found = search.find(team, in_turns=in_turns)
    if isinstance(found, Shortfall):
        raise _ShortError("no plan", partial(_reasons, team, jobs, found))
    _refuse_late(team, jobs, found.spans, lambda: _robots(team, jobs, decisions))
    recorded = schedule(team, jobs, decisions, record=True)
    if isinstance(recorded, Shortfall):
        raise InfeasibleError("no plan: the decisions found cannot be carried out")
    first = assemble(team, jobs, recorded)
    known = first.robots in search.tried
    search.tried[first.robots] = first.makespan
    if known or _better(first, best) is best:
        raise _NotBetterError("no better plan")
    made = _kept_apart(team, jobs, search, decisions, first, best)
    _refuse_late(team, jobs, _spans(made), lambda: made.robots)
    return first, made


def _robots(team: Team, jobs: Sequence[Job], decisions: Decisions) -> Sequence[RobotPlan]:
    found = schedule(team, jobs, decisions, record=True)
    return assemble(team, jobs, found).robots if isinstance(found, Schedule) else ()


def _with_remedies(team: Team, jobs: Sequence[Job]) -> Iterator[str]:
    """Yield what makes tasks impossible, with what would do where robots cannot reach an emergency area."""
    short = [*team.shortfalls()]
    stuck = any(pilot.stuck for pilot in team.pilots.values())
    remedies = or_else([*for_diversions(team, jobs)]) if short and stuck else ""
    yield from (f"{each}{remedies}" for each in short)


def _shared_choices(scene: Scene, jobs: Sequence[Job]) -> list[str]:
    wanted = {task.name: task.wanted or 1 for task in scene.tasks}
    return [
        f"task '{task}' wants {wanted[task]} robots, but fork '{job.name}' is one robot's work"
        for job in jobs
        if job.choice is not None
        for task in job.tasks()
        if wanted[task] > 1
    ]


def _kept_apart(
    team: Team, jobs: Sequence[Job], search: _Search, decisions: Decisions, found: Plan, best: Plan | None
) -> Plan:
    """Return a plan as its robots keep apart: by waits, flight levels and signals, or by later starts.

    What is not better than the best so far is not sought any further.
    """
    made, refusal = None, None
    try:
        made = separated(team, found)
        if made.makespan <= DEAR * found.makespan:
            return made
    except TooNearError as error:
        refusal = error
    least = best if made is None else _better(made, best)
    levels = levelled(team, jobs, decisions, found, inf if least is None else least.makespan)
    apart = None if levels is None else _waiting(team, levels, least)
    if made is None and (levels is None or levels.conflicts):
        search.dear.append((team, found))
    if apart is not None:
        made = apart if made is None else _better(apart, made)
    if made is not None and made.makespan > _WORTH_SIGNALS * found.makespan:
        made = signalled(team, found, _better(made, best).makespan) or made
    least = best if made is None else _better(made, best)
    made = starting_later(team, decisions, partial(_planned_better, team, jobs, least)) or made
    if made is None:
        raise refusal or InfeasibleError("no plan")
    return made


def _waiting(team: Team, levels: Traffic, best: Plan | None) -> Plan | None:
    """Return a plan in which robots wait where levels do not keep them apart; None if none is better."""
    if not levels.conflicts:
        return levels.plan
    made: Plan | None = None
    with suppress(TooNearError):
        made = separated(team, levels.plan)
        if made.makespan <= DEAR * levels.plan.makespan:
            return made
    least = best if made is None else _better(made, best)
    return signalled(team, levels.plan, inf if least is None else least.makespan) or made


def _planned_better(team: Team, jobs: Sequence[Job], best: Plan | None, decisions: Decisions) -> Plan | None:
    made = planned(team, jobs, decisions)
    return None if made is None or _better(made, best) is best else made


def _refuse(reasons: Sequence[str], what: str) -> None:
    if reasons:
        raise InfeasibleError(_words(what, reasons), reasons)


def _refuse_late(
    team: Team,
    jobs: Sequence[Job],
    spans: Mapping[str, tuple[float, float]],
    robots: Callable[[], Sequence[RobotPlan]],
) -> None:
    if broken_times(team, spans):
        raise _UnexplainedError("no plan keeps all times", lambda: [*for_times(team, jobs, spans, robots())])


def _words(what: str, reasons: Sequence[str]) -> str:
    more = f" ({len(reasons)} reasons)" if len(reasons) > 1 else ""
    return f"{what}: {reasons[0]}{more}"


def _reasons(team: Team, jobs: Sequence[Job], found: Shortfall) -> list[str]:
    """Return what is short for the job that could not be done, and for all others that are alike."""
    reasons = too_long(team, jobs)
    if reasons:
        return reasons
    job = next(job for job in jobs if job.name == found.job)
    return [_general(team, jobs, job) + or_else([*for_all_charges(team, jobs, job)])]


def _general(team: Team, jobs: Sequence[Job], job: Job) -> str:
    if job.choice is not None:
        why = _unable(team, job)
        return f"fork '{job.name}' is one robot's work, and no robot can do all of its branches ({why})"
    task = team.tasks[job.name]
    materials = [team.forwards(task.name, robot) for robot in team.able(task.name)]
    laid_out = [each for each in materials if each is not None]
    whole = min(each.seconds(0, len(each) - 1) for each in laid_out)
    charges = "; ".join(
        f"{name}: {allowed_by_charge(team.pilots[name]):.0f} s a charge{kept_of_charge(team.pilots[name])}"
        + (", cannot recharge" if team.pilots[name].kinematics.recharge is None else "")
        for name in team.able(task.name)
    )
    wanted = f" by exactly {counted(task.wanted)}" if task.wanted is not None else ""
    short = "; ".join(team.short_of_charge(task.name))
    alone = f"; too long for some: {short}" if short else ""
    apart = team.sorts(task.name) if task.wanted is not None else ""
    alone += f"; {apart}" if apart else ""
    begin = f"task '{task.name}' takes {whole:.0f} s and cannot be done{wanted}:"
    pieces = max(map(len, laid_out))
    if (task.wanted or 1) > pieces:
        return f"{begin} it has no cuts for more than {counted(pieces)}"
    before = " after the tasks before it" if len(jobs) > 1 else ""
    missing = _short_of_charges(team, task.name, whole)
    return f"{begin} charges do not suffice{before} ({charges}{alone}){missing}"


def _unable(team: Team, job: Job) -> str:
    """Return which robots cannot do some task of a choice, and why; the others lack the charge."""
    why = []
    for name in team.pilots:
        reasons = {task: team.refusal(task, name) for task in job.tasks()}
        refused = [(task, reason) for task, reason in reasons.items() if reason]
        task, reason = refused[0] if refused else ("", "its charge does not suffice")
        why.append(f"{name}: '{task}' {reason}" if task else f"{name}: {reason}")
    return "; ".join(why)


def _short_of_charges(team: Team, task: str, whole: float) -> str:
    """Return by how much the charges of all robots are too small for a task, where none can recharge."""
    pilots = [team.pilots[name] for name in team.able(task)]
    if any(pilot.kinematics.recharge is not None for pilot in pilots):
        return ""
    short = whole - sum(map(allowed_by_charge, pilots))
    return f": at least {short:.0f} s short" if short > 0.5 else ""
