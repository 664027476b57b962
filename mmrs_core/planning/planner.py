"""Who does what, when, and by which way: the plan of an expanded scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.assembly import assemble
from mmrs_core.planning.crew import Crew
from mmrs_core.planning.jobs import Job, jobs_of
from mmrs_core.planning.numbers import askings
from mmrs_core.planning.schedule import Decisions, Shortfall, schedule
from mmrs_core.planning.search import broken_times, find_decisions
from mmrs_core.planning.separation import TooNearError, distance_to_keep, separated, stacked_altitudes
from mmrs_core.scene import Plan, Scene


def plan(scene: Scene, *, seed: int = 0) -> Plan:
    """Return a plan in which the last robot is back as early as could be found.

    Every task is done exactly once, by robots that can do it, in the order of the dependencies; no
    sortie takes more than a charge less the reserve allows, waits included; every leg keeps its
    clearance. The same scene and seed give the same plan. Where a task does not say how many robots it
    wants, numbers are tried too (see `askings`): in a small mission none that is asked for ends it sooner.

    Args:
        scene: expanded: kinematics and works are known.
        seed: of the local search.

    Raises:
        InfeasibleError: no plan was found; its reasons say what is short, and by how much.
    """
    jobs = jobs_of(scene)
    crew = Crew(scene)
    _refuse([*crew.shortfalls(), *_shared_choices(scene, jobs)], "no plan")
    crews = _Remembered(_crews(crew))
    found, refusal = None, InfeasibleError("no plan")
    for wanted in ({}, *askings(crew, jobs)):
        try:
            made = _plan_asking(crews, wanted, jobs, seed)
        except InfeasibleError as error:
            refusal = refusal if wanted else error
            continue
        if found is None or _cost(made) < _cost(found):
            found = made
    if found is None:
        raise refusal
    return found


def _cost(made: Plan) -> tuple[float, float]:
    """Return (makespan, seconds of all robots), rounded so that only a real gain counts."""
    return (round(made.makespan, 3), round(sum(each.busy for each in made.robots), 3))


def _plan_asking(crews: Iterable[Crew], wanted: Mapping[str, int], jobs: Sequence[Job], seed: int) -> Plan:
    """Return the plan of the first crew that is not short where tasks want so many robots."""
    shortage = InfeasibleError("no plan")
    for each in crews:
        try:
            return _plan_with(each.asking(wanted) if wanted else each, jobs, seed)
        except _ShortError as error:
            shortage = InfeasibleError(str(error), error.reasons)
    raise shortage


class _Remembered:
    """Crews that are made when they are first asked for, and kept."""

    def __init__(self, crews: Iterator[Crew]) -> None:
        self._coming, self._made = crews, list[Crew]()

    def __iter__(self) -> Iterator[Crew]:
        yield from self._made
        for each in self._coming:
            self._made.append(each)
            yield each


class _ShortError(InfeasibleError):
    """Nobody is left to do some job, perhaps only because of how the crew was told to go about it."""


def _crews(crew: Crew) -> Iterator[Crew]:
    """Yield a crew, and what it may be replaced by where somebody is missing for some job.

    Robots that need not return may keep enough to go home, to recharge there; or they may not, and end
    further away.
    """
    yield crew
    everyone = frozenset(crew.pilots)
    returning = frozenset(name for name, pilot in crew.pilots.items() if pilot.robot.return_home)
    others = [each for each in dict.fromkeys((everyone, returning)) if each != crew.homebound]
    yield from (Crew(crew.scene, homebound=each) for each in others)
    yield from (Crew(crew.scene, homebound=each, fine=True) for each in (*others, crew.homebound))


def _plan_with(crew: Crew, jobs: Sequence[Job], seed: int) -> Plan:
    """Return a plan of a crew; where robots come too near to each other, of the crew told otherwise."""
    try:
        return _plan_of(crew, jobs, seed)
    except TooNearError as error:
        for told, in_turns in _told_otherwise(crew, error):
            try:
                made = _plan_of(told, jobs, seed, in_turns=in_turns)
            except InfeasibleError:
                continue
            return replace(made, notes=(*_of_homecoming(crew, told, made), *made.notes))
        raise InfeasibleError(str(error), error.reasons) from error


def _of_homecoming(crew: Crew, told: Crew, made: Plan) -> Iterator[str]:
    """Yield which robots at work return home though nobody asked for it, but to keep apart."""
    before = {robot.name: robot.return_home for robot in crew.scene.robots}
    returning = {robot.name for robot in told.scene.robots if robot.return_home and not before[robot.name]}
    names = [each.robot for each in made.robots if each.robot in returning and each.steps]
    if names:
        ends = "returns home unasked" if len(names) == 1 else "return home unasked"
        yield f"{', '.join(names)} {ends}, so that robots on the ground keep apart"


def _told_otherwise(crew: Crew, error: TooNearError) -> Iterator[tuple[Crew, bool]]:
    """Yield (crew, whether its robots fly one after the other) that may help where robots come too near.

    Robots may transit one above the other, keep away from where others stand at home, end at home where
    they need not, or take turns.
    """
    altitudes, least = stacked_altitudes(crew.scene), distance_to_keep(crew.scene)
    if altitudes:
        yield Crew(crew.scene, fine=crew.fine, homebound=crew.homebound, altitudes=altitudes), False
    if error.at_home:
        yield Crew(crew.scene, fine=crew.fine, homebound=crew.homebound, from_homes=least), False
    before = crew.scene.robots
    for names in dict.fromkeys((error.robots, frozenset(crew.pilots))):
        team = tuple(replace(robot, return_home=True) if robot.name in names else robot for robot in before)
        if team != before:
            yield Crew(replace(crew.scene, robots=team), fine=crew.fine, from_homes=least), False
    everyone = frozenset(crew.pilots)
    yield Crew(crew.scene, fine=crew.fine, homebound=everyone), True
    yield Crew(crew.scene, fine=crew.fine, homebound=everyone, from_homes=least), True


def _plan_of(crew: Crew, jobs: Sequence[Job], seed: int, *, in_turns: bool = False) -> Plan:
    decisions, found = find_decisions(crew, jobs, seed, in_turns=in_turns)
    if isinstance(found, Shortfall):
        reasons = _reasons(crew, jobs, found)
        raise _ShortError(_words("no plan", reasons), reasons)
    _refuse([reason for reason, _ in broken_times(crew, found.spans)], "no plan keeps all times")
    made = separated(crew.scene, decisions, lambda decided: _planned(crew, jobs, decided))
    spans = {name: (begin, made.ends[name]) for name, begin in made.begins.items()}
    _refuse([reason for reason, _ in broken_times(crew, spans)], "no plan keeps all times")
    return made


def _shared_choices(scene: Scene, jobs: Sequence[Job]) -> list[str]:
    """Return why tasks between a Fork with conditions and its Join cannot be shared as wanted."""
    wanted = {task.name: task.wanted or 1 for task in scene.tasks}
    return [
        f"task '{task}' wants {wanted[task]} robots, but fork '{job.name}' is one robot's work"
        for job in jobs
        if job.choice is not None
        for task in job.tasks()
        if wanted[task] > 1
    ]


def _planned(crew: Crew, jobs: Sequence[Job], decisions: Decisions) -> Plan | None:
    """Return the plan of decisions; None if they lead to none, or times are broken."""
    found = schedule(crew, jobs, decisions, record=True)
    if isinstance(found, Shortfall) or broken_times(crew, found.spans):
        return None
    return assemble(crew, jobs, found)


def _refuse(reasons: Sequence[str], what: str) -> None:
    """Raise an InfeasibleError with all reasons, if there are any."""
    if reasons:
        raise InfeasibleError(_words(what, reasons), reasons)


def _words(what: str, reasons: Sequence[str]) -> str:
    more = f" ({len(reasons)} reasons)" if len(reasons) > 1 else ""
    return f"{what}: {reasons[0]}{more}"


def _reasons(crew: Crew, jobs: Sequence[Job], found: Shortfall) -> list[str]:
    """Return what is short for the job that could not be done, and for all others that are alike."""
    reasons = []
    for job in jobs:
        for task in job.tasks():
            if crew.too_long(task):
                short = "; ".join(crew.short_of_charge(task))
                reasons.append(f"task '{task}' is too long for every robot ({short})")
    job = next(job for job in jobs if job.name == found.job)
    return reasons or [_general(crew, job)]


def _general(crew: Crew, job: Job) -> str:
    if job.choice is not None:
        return f"fork '{job.name}': no robot can do all of its ways (all are one robot's work)"
    task = crew.scene.task(job.name)
    whole = min(
        each.seconds(0, len(each) - 1)
        for robot in crew.able(task.name)
        if (each := crew.forwards(task.name, robot)) is not None
    )
    charges = "; ".join(
        f"{name}: {crew.pilots[name].limit:.0f} s a charge"
        + (", cannot recharge" if crew.pilots[name].kinematics.recharge is None else "")
        for name in crew.able(task.name)
    )
    robots = "robot" if task.wanted == 1 else "robots"
    wanted = f" by exactly {task.wanted} {robots}" if task.wanted is not None else ""
    short = "; ".join(crew.short_of_charge(task.name))
    alone = f"; too long for some: {short}" if short else ""
    apart = crew.sorts(task.name) if task.wanted is not None else ""
    alone += f"; {apart}" if apart else ""
    return (
        f"task '{task.name}' takes {whole:.0f} s and cannot be done{wanted}, after what comes before,"
        f" by the robots that can do it ({charges}{alone}){_short_of_charges(crew, task.name, whole)}"
    )


def _short_of_charges(crew: Crew, task: str, whole: float) -> str:
    """Return by how much the charges of all robots are too small for a task, where none can recharge."""
    pilots = [crew.pilots[name] for name in crew.able(task)]
    if any(pilot.kinematics.recharge is not None for pilot in pilots):
        return ""
    short = whole - sum(pilot.limit for pilot in pilots)
    return f": at least {short:.0f} s short" if short > 0.5 else ""
