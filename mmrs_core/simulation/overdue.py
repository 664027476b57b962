"""Plans whose behaviours keep deadlines and longest durations also as they are simulated.

The planner's times leave out what a behaviour adds to them, such as how runs without stops are flown.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import ceil

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Plan, Scene, Task

_TRIES = 4

_SPARE = 0.1
"""Seconds by which limits are tightened further than a task was late."""


def plan_in_time(
    scene: Scene, plan: Callable[[Scene], Plan], timed: Callable[[Plan], Sequence[Plan | str]]
) -> Plan:
    """Return a plan, sought with earlier deadlines where tasks of its simulated behaviour end too late.

    Where it is not known whether they do, a note of the plan gives the reason.

    Args:
        scene: expanded.
        plan: finds the plan of a scene.
        timed: returns a plan with the times of its simulated behaviour, or why these are not known, for each
            outcome of its choices.

    Raises:
        InfeasibleError: there is no plan, or none was found that keeps all times.
    """
    if all(task.deadline is None and task.longest is None for task in scene.tasks):
        return plan(scene)
    tried, reasons = scene, list[str]()
    for _ in range(_TRIES):
        try:
            made = plan(tried)
        except InfeasibleError as error:
            if reasons:
                break
            return _kept_in_simulation(scene, plan, timed, error)
        times, unknown = _apart(timed(made))
        found = [*dict.fromkeys(reason for each in times for reason in _overdue(scene, each))]
        if not found:
            return replace(made, notes=(*unknown, *made.notes))
        reasons = reasons or found
        tried = replace(
            tried, tasks=tuple(_tightened(each, scene.task(each.name), times) for each in tried.tasks)
        )
    raise InfeasibleError(f"no plan keeps all times as it is simulated: {reasons[0]}", reasons)


def _kept_in_simulation(
    scene: Scene,
    plan: Callable[[Scene], Plan],
    timed: Callable[[Plan], Sequence[Plan | str]],
    refusal: InfeasibleError,
) -> Plan:
    """Return the plan without limits, if it keeps them as it is simulated though by the planner's times not.

    Raises:
        InfeasibleError: the refusal; the plan does not keep them, or there is none.
    """
    tasks = tuple(replace(task, deadline=None, longest=None) for task in scene.tasks)
    try:
        made = plan(replace(scene, tasks=tasks))
    except InfeasibleError:
        raise refusal from None
    times, unknown = _apart(timed(made))
    if unknown or any(_overdue(scene, each) for each in times):
        raise refusal
    return made


def _apart(runs: Sequence[Plan | str]) -> tuple[list[Plan], list[str]]:
    """Return the plans with simulated times, and notes on the runs of which they are not known."""
    unknown = dict.fromkeys(each for each in runs if isinstance(each, str))
    notes = [f"whether all times are kept as simulated is not known: {each}" for each in unknown]
    return [each for each in runs if not isinstance(each, str)], notes


def _overdue(scene: Scene, times: Plan) -> list[str]:
    """Return which tasks are late or take too long, and what would do."""
    found = []
    for task in scene.tasks:
        late, over = _excess(task, times)
        name, end = task.name, times.ends.get(task.name, 0.0)
        taken = end - times.begins.get(name, end)
        if late > 0.0:
            limit = f"its deadline is {task.deadline:g} s: {ceil(late)} s late"
            remedy = f"a deadline of {ceil(end)} s would do"
            found.append(f"task '{name}' ends {ceil(end)} s after the start, {limit}; {remedy}")
        if over > 0.0:
            limit = f"takes {ceil(taken)} s, {task.longest:g} s are allowed: {ceil(over)} s too long"
            found.append(f"task '{name}' {limit}; {ceil(taken)} s would do")
    return found


def _excess(task: Task, times: Plan) -> tuple[float, float]:
    """Return the seconds by which a task is late, and those by which it takes too long; 0: it keeps that."""
    if task.name not in times.ends:
        return 0.0, 0.0
    begin, end = times.begins[task.name], times.ends[task.name]
    late = 0.0 if task.deadline is None else end - task.deadline
    over = 0.0 if task.longest is None else end - begin - task.longest
    return max(0.0, late), max(0.0, over)


def _tightened(tried: Task, asked: Task, times: Sequence[Plan]) -> Task:
    """Return a task with limits that are earlier by what it exceeded the mission's."""
    late, over = map(max, zip(*(_excess(asked, each) for each in times), strict=True))
    if late > 0.0 and tried.deadline is not None:
        tried = replace(tried, deadline=tried.deadline - late - _SPARE)
    if over > 0.0 and tried.longest is not None:
        tried = replace(tried, longest=tried.longest - over - _SPARE)
    return tried
