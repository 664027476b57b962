"""Why there is no plan: what is short, for which task, by how much, and what would do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mmrs_core.planning.jobs import Job
from mmrs_core.planning.materials import allowed_by_charge, kept_of_charge
from mmrs_core.planning.remedies import counted, for_all_charges, for_diversions, or_else, too_long
from mmrs_core.planning.schedule import Shortfall
from mmrs_core.planning.team import Team
from mmrs_core.scene import Scene


def in_words(what: str, reasons: Sequence[str]) -> str:
    """Return what there is not, the first reason, and how many there are."""
    more = f" ({len(reasons)} reasons)" if len(reasons) > 1 else ""
    return f"{what}: {reasons[0]}{more}"


def with_remedies(team: Team, jobs: Sequence[Job]) -> Iterator[str]:
    """Yield what makes tasks impossible, with what would do where robots cannot reach an emergency area."""
    short = [*team.shortfalls()]
    stuck = any(pilot.stuck for pilot in team.pilots.values())
    remedies = or_else([*for_diversions(team, jobs)]) if short and stuck else ""
    yield from (f"{each}{remedies}" for each in short)


def shared_choices(scene: Scene, jobs: Sequence[Job]) -> list[str]:
    """Return which branches of forks want several robots, though a fork is one robot's work."""
    wanted = {task.name: task.wanted or 1 for task in scene.tasks}
    return [
        f"task '{task}' wants {wanted[task]} robots, but fork '{job.name}' is one robot's work"
        for job in jobs
        if job.choice is not None
        for task in job.tasks()
        if wanted[task] > 1
    ]


def reasons_for(team: Team, jobs: Sequence[Job], found: Shortfall) -> list[str]:
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
