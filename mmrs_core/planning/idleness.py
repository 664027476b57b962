"""Why a robot has nothing to do in a plan."""

from __future__ import annotations

from mmrs_core.planning.crew import Crew
from mmrs_core.planning.jobs import is_control


def why_idle(crew: Crew, robot: str) -> str:
    """Return why no task of the plan is a robot's, task by task; what has one reason is said once."""
    reasons: dict[str, list[str]] = {}
    for task in crew.scene.tasks:
        if not is_control(task):
            reasons.setdefault(_reason(crew, task.name, robot), []).append(f"'{task.name}'")
    return "; ".join(f"{', '.join(tasks)}: {reason}" for reason, tasks in reasons.items())


def _reason(crew: Crew, task: str, robot: str) -> str:
    """Return why a task is not the robot's."""
    if robot not in crew.able(task):
        return crew.refusals.get((task, robot), "it cannot do the task")
    if crew.sharers(task) == 1 and len(crew.able(task)) > 1 and crew.whole(task):
        return "one robot must do all of it, and the mission ends no later with another one"
    wanted = crew.scene.task(task).wanted
    others = [name for name in crew.able(task) if name not in crew.sharing_with(task, robot)]
    apart = (
        f"; it cannot share it with {', '.join(others)}, whose work is laid out otherwise" if others else ""
    )
    if wanted is not None:
        return f"the task wants {wanted}, and other robots have it{apart}"
    return f"no plan was found in which it makes the mission end sooner{apart}"
