"""A plan as lines for operators, and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import ceil

from mmrs_core.cli.output import counted, table
from mmrs_core.pictures.figures import clock, energy, length
from mmrs_core.scene import Branch, Plan, RobotPlan, Scene, Serve, Step

_MOST_NOTES = 4
_WIDEST = 44
_TELLING = 1.5
"""Times the lower bound up to which a mission time is compared with it."""


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
    """Return by how much a plan is longer than any at most, where what is known says something."""
    if plan.makespan > _TELLING * plan.lower_bound:
        return ""
    return f" (within {ceil(100.0 * (plan.makespan / plan.lower_bound - 1.0) - 1e-6)} % of the best possible)"


def plan_summary(scene: Scene, plan: Plan) -> Mapping[str, object]:
    """Return the plan as JSON has it."""
    return {
        "mission": scene.name,
        "makespan": plan.makespan,
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


def tasks_of(robot: RobotPlan) -> tuple[str, ...]:
    """Return the names of the tasks that a robot serves, in the order in which it begins them."""
    return tuple(dict.fromkeys(step.task for step in _flat(robot.steps) if isinstance(step, Serve)))


def _flat(steps: tuple[Step, ...]) -> Iterator[Step]:
    for step in steps:
        yield step
        if isinstance(step, Branch):
            for _, arm in step.arms:
                yield from _flat(arm)


def _row(scene: Scene, robot: RobotPlan) -> tuple[str, ...]:
    kind = scene.robot(robot.robot).type.name
    if not robot.steps:
        return robot.robot, kind, "none", "", "", "", ""
    tasks = ", ".join(tasks_of(robot)) or "none"
    figures = length(robot.length), clock(robot.busy), energy(robot.energy), str(robot.sorties)
    return robot.robot, kind, tasks, *figures
