"""Robots wait at home rather than in the air: a sortie begins so late that its later tasks can begin at once.

Schedules are made task by task, and a robot sets out for the first task of a sortie as early as it can. Where
it then has to wait for a later one, for a time or another robot, the wait takes of its charge. It does not if
the sortie begins later by that wait: the first task is then given an earliest start.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from math import inf

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.limits import is_small
from mmrs_core.scene import Await, Kinematics, Launch, Plan, Recharge, Scene, Serve

_LONG = 1.0
"""Seconds from which a wait counts."""


def waiting_at_home(
    scene: Scene, found: Plan | None, plan: Callable[[Scene], Plan]
) -> Iterator[dict[str, float]]:
    """Yield before when some tasks should not begin, by which a scene may have a better plan.

    Args:
        scene: expanded.
        found: its plan; None: it was refused.
        plan: finds another scene's.
    """
    if not may_wait(scene):
        return
    if found is not None and (later := _later(scene, found)):
        yield later
    if any(_may_wait_too_long(each.kinematics) for each in scene.robots) and (
        found is None or any(each.sorties > 1 for each in found.robots)
    ):
        with suppress(InfeasibleError):
            if later := _later(scene, plan(near(without_charges(scene)))):
                yield later


def may_wait(scene: Scene) -> bool:
    """Return whether robots may have to wait, in a mission that is small enough to seek other departures."""
    return is_small(scene) and bool(scene.dependencies or any(task.earliest for task in scene.tasks))


def without_charges(scene: Scene) -> Scene:
    """Return the scene whose robots need no charging."""
    robots = (
        each
        if each.kinematics is None
        else replace(each, kinematics=replace(each.kinematics, endurance=inf, energy=inf))
        for each in scene.robots
    )
    return replace(scene, robots=tuple(robots))


def near(scene: Scene) -> Scene:
    """Return the scene whose robots may come near to each other; they stop at corners as before."""
    return replace(scene, minimum_separation=None)


def begun_no_earlier(scene: Scene, earliest: Mapping[str, float | None]) -> Scene:
    """Return the scene in which some tasks begin no earlier than at given seconds; None: at any time."""
    tasks = (replace(each, earliest=earliest.get(each.name, each.earliest)) for each in scene.tasks)
    return replace(scene, tasks=tuple(tasks))


def _later(scene: Scene, made: Plan) -> dict[str, float]:
    """Return when the first task of each sortie begins that is put off by the waits in the air after it."""
    later = dict[str, float]()
    for each in made.robots:
        first, kinematics = "", scene.robot(each.robot).kinematics
        for step in each.steps if kinematics is not None and kinematics.launches else ():
            if isinstance(step, Launch | Recharge):
                first = ""
            elif isinstance(step, Serve):
                first = first or step.task
            elif isinstance(step, Await) and first and step.end - step.begin > _LONG:
                later[first] = later.get(first, made.begins[first]) + step.end - step.begin
    for name in [*later]:
        deadline = scene.task(name).deadline
        if deadline is not None:
            later[name] = min(later[name], deadline - (made.ends[name] - made.begins[name]))
    return {name: begin for name, begin in later.items() if begin > made.begins[name] + _LONG}


def _may_wait_too_long(kinematics: Kinematics | None) -> bool:
    return (
        kinematics is not None and kinematics.launches and min(kinematics.endurance, kinematics.energy) < inf
    )
