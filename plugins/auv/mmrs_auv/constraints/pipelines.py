"""Whether pipelines can be followed from one end to the other."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_auv.names import FOLLOW_PIPELINE_TASK
from mmrs_auv.tasks.pipelines import way_along
from mmrs_core.analysis.constraints.blocked import blocked_line
from mmrs_core.analysis.constraints.capabilities import able
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.errors import InfeasibleError
from mmrs_core.grounding.features import child, children, number
from mmrs_core.languages.element import Element, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Position


def _interrupted(task: Element, models: ModelSet) -> Iterator[Finding]:
    sketch, way = sketch_of(models), _way(task, models)
    clearances = [robot.clearance for robot in able(task, models)]
    smallest = min((each for each in clearances if each is not None), default=None)
    if not way or smallest is None or None in clearances:
        return
    line = blocked_line(sketch, way, smallest)
    for (begin, end), names in line.blocked:
        yield Finding(
            task,
            f"task '{label_of(task)}': {end - begin:.1f} of the {line.length:.1f} m of its pipeline are too "
            f"near to {names} for every robot, from {begin:.1f} m on",
        )


def _way(task: Element, models: ModelSet) -> tuple[Position, ...]:
    """Return the way along a task's pipeline; empty where there is none, or its place is not known."""
    pipeline, known = child(task, "pipeline"), sketch_of(models).ground.positions
    points = [known.get(each) for each in children(pipeline, "points")]
    placed = tuple(point for point in points if point is not None)
    height, offset = number(task, "height") or 0.0, number(task, "offset") or 0.0
    try:
        return way_along(placed, height, offset) if len(placed) == len(points) else ()
    except InfeasibleError:
        return ()


PIPELINE_CONSTRAINTS = (
    Constraint(
        "AUV035",
        "All of a pipeline can be followed",
        FOLLOW_PIPELINE_TASK,
        _interrupted,
        "follow it on the other side, or make the area or its safetyDistance smaller",
        Severity.WARNING,
    ),
)
"""What must hold for tasks along pipelines."""
