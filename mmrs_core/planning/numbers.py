"""How many robots tasks may be asked to want that do not say so themselves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from math import prod

from mmrs_core.planning.crew import Crew
from mmrs_core.planning.jobs import Job
from mmrs_core.planning.search import first_cost

_EFFORT = 192
"""Searches times jobs times robots, at most, but always some: what is most promising comes first."""

_SOME = 3


def askings(crew: Crew, jobs: Sequence[Job]) -> list[Mapping[str, int]]:
    """Return what tasks that leave the number of their robots open may want; each is worth a search.

    In a small mission that is every choice of numbers. In one so large that all these searches would
    take too long, it is what has the best first schedules of one number for one task, or for all.
    """
    most = {name: largest for name in _open_tasks(crew, jobs) if (largest := crew.sharers(name)) > 1}
    room = max(_SOME, _EFFORT // max(1, len(jobs) * len(crew.pilots)))
    if prod(largest + 1 for largest in most.values()) <= room + 1:
        choices = product(*([(name, count) for count in range(most[name] + 1)] for name in most))
        asked = [{name: count for name, count in choice if count} for choice in choices]
        return [each for each in asked if each]
    ranked = sorted(_of_one_number(most), key=lambda each: first_cost(crew.asking(each), jobs))
    return ranked[:room]


def _of_one_number(most: Mapping[str, int]) -> list[Mapping[str, int]]:
    """Return one number for one task, and for all, as far as they allow."""
    single = [{name: count} for name, largest in most.items() for count in range(1, largest + 1)]
    alike = [
        {name: min(count, largest) for name, largest in most.items()}
        for count in range(1, max(most.values()) + 1)
    ]
    return [*single, *(alike if len(most) > 1 else ())]


def _open_tasks(crew: Crew, jobs: Sequence[Job]) -> list[str]:
    """Return the names of the tasks whose number of robots is for the planner to choose."""
    return [
        job.name
        for job in jobs
        if job.choice is None and job.tasks() and crew.scene.task(job.name).wanted is None
    ]
