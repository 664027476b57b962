"""A plan as lines for operators, and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from mmrs_core.cli.output import counted, table
from mmrs_core.pictures.explanations import sections_of
from mmrs_core.pictures.figures import clock, energy, length, within
from mmrs_core.scene import Plan, RobotPlan, Scene, Serve, all_steps

if TYPE_CHECKING:
    from mmrs_core.planning.explaining import Alternative, PlanExplanation

_MOST_NOTES = 4
_WIDEST = 44


def plan_lines(scene: Scene, plan: Plan) -> Iterator[str]:
    """Yield the tasks, distance, time and energy of each robot, and notes."""
    at_work = sum(bool(robot.steps) for robot in plan.robots)
    yield (
        f"{scene.name or 'mission'}: {counted(len(scene.tasks), 'task')}, "
        f"{counted(at_work, 'active robot')}, mission time {clock(plan.makespan)}{_within(plan)}"
    )
    head = ("robot", "type", "tasks", "distance", "time", "energy", "sorties")
    yield from table(head, [_row(scene, robot) for robot in plan.robots], widest=_WIDEST)
    for robot in plan.robots:
        if robot.idle:
            yield f"  idle: {robot.robot} ({robot.idle})"
    for left in plan.left_out:
        yield f"  {left}"
    for note in plan.notes[:_MOST_NOTES]:
        yield f"  note: {note}"
    more = len(plan.notes) - _MOST_NOTES
    if more > 0:
        yield f"  and {counted(more, 'more note')}"


def _within(plan: Plan) -> str:
    """Return by how much a plan is longer than any at most, and by which times where they differ."""
    if not plan.lower_bound:
        return ""
    planned = f"planned as {clock(plan.planned)}, which is " if plan.planned else ""
    return f" ({planned}{within(plan.planned or plan.makespan, plan.lower_bound)})"


def plan_summary(scene: Scene, plan: Plan) -> Mapping[str, object]:
    """Return the plan as JSON has it."""
    return {
        "mission": scene.name,
        "makespan": plan.makespan,
        "plannedMakespan": plan.planned or plan.makespan,
        "lowerBound": plan.lower_bound or None,
        "robots": [
            {
                "name": robot.robot,
                "tasks": tasks_of(robot),
                "length": robot.length,
                "busy": robot.busy,
                "energy": robot.energy,
                "sorties": robot.sorties,
                "idle": robot.idle or None,
            }
            for robot in plan.robots
        ],
        "tasks": [
            {"name": task.name, "begin": plan.begins.get(task.name), "end": plan.ends.get(task.name)}
            for task in scene.tasks
        ],
        "leftOut": [
            {"task": each.task, "amount": each.amount, "unit": each.unit, "where": each.where, "at": each.at}
            for each in plan.left_out
        ],
        "notes": plan.notes,
    }


def explanation_lines(explanation: PlanExplanation) -> Iterator[str]:
    """Yield why a plan is as it is, part by part."""
    for part in sections_of(explanation):
        yield ""
        yield part.title
        yield from (f"  {sentence}" for sentence in part.sentences)
        if part.rows:
            yield from table(part.head, part.rows)


def explanation_summary(explanation: PlanExplanation) -> Mapping[str, object]:
    """Return why a plan is as it is, as JSON has it; times are seconds."""
    return {
        "lastRobot": explanation.backs[0][0] if explanation.backs else None,
        "backs": dict(explanation.backs),
        "criticalPath": [
            {
                "robot": link.robot,
                "task": link.task or None,
                "begin": link.begin,
                "end": link.end,
                "spent": dict(link.spent),
            }
            for link in explanation.chain
        ],
        "limits": [
            {"name": each.name, "cost": each.cost, "margin": each.margin or None}
            for each in explanation.limits
        ],
        "alternativesBeforeSeparation": explanation.apart,
        "tasks": [
            {
                "name": task.task,
                "robots": task.robots,
                "alternatives": [_alternative(each) for each in task.alternatives],
                "unable": task.unable,
                "tried": task.tried,
            }
            for task in explanation.tasks
        ],
        "idle": [
            {"robot": robot} if best is None else {"robot": robot, "task": best[0], **_alternative(best[1])}
            for robot, best in explanation.idle.items()
        ],
    }


def _alternative(each: Alternative) -> Mapping[str, object]:
    changes = {"later": each.later, "taskLater": each.task_later, "busyLonger": each.longer}
    return {"robots": each.robots, **({"fault": each.fault} if each.fault else changes)}


def tasks_of(robot: RobotPlan) -> tuple[str, ...]:
    """Return the names of the tasks that a robot serves, in the order in which it begins them."""
    return tuple(dict.fromkeys(step.task for step in all_steps(robot.steps) if isinstance(step, Serve)))


def _row(scene: Scene, robot: RobotPlan) -> tuple[str, ...]:
    kind = scene.robot(robot.robot).type.name
    if not robot.steps:
        return robot.robot, kind, "none", "", "", "", ""
    tasks = ", ".join(tasks_of(robot)) or "none"
    figures = length(robot.length), clock(robot.busy), energy(robot.energy), str(robot.sorties)
    return robot.robot, kind, tasks, *figures
