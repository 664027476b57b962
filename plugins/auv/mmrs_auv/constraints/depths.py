"""Whether tasks lie deeper than any robot of a team bears."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from mmrs_auv.kinds import ATMOSPHERE, GRAVITY, SEA_WATER
from mmrs_auv.names import AUV_MOVEMENT, FOLLOW_PIPELINE_TASK, YO_YO_TASK
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.coordinates import Ground, heights_of_task
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet


def too_deep(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks deeper than every robot bears; none where the limit of one is not known.

    Robots that are no underwater vehicles reach no depth at all, so a team without any is silent:
    other constraints and the planner tell it what it lacks.
    """
    team = children(child(mission, "team"), "robots") if child(mission, "team") is not None else ()
    limits = [_limit(models.robots.get(text(member, "type")), models) for member in team]
    deepest = max((limit for limit in limits if limit is not None), default=inf)
    ground = sketch_of(models).ground
    for task in children(mission, "tasks"):
        depth = _deepest(task, ground)
        if depth > deepest + 1e-6:
            yield Finding(
                task,
                f"task '{label_of(task)}' is {depth:g} m deep, the team's vehicles bear {deepest:.1f} m",
            )


def _deepest(task: Element, ground: Ground) -> float:
    """Return how deep a task leads, metres below the surface; -inf where that is not known."""
    lowest = number(task, "maxDepth") if is_kind(task, *YO_YO_TASK) else None
    if lowest is not None:
        return lowest
    heights = heights_of_task(task, ground)
    if is_kind(task, *FOLLOW_PIPELINE_TASK):
        pipeline, above = child(task, "pipeline"), number(task, "height") or 0.0
        points = children(pipeline, "points")
        heights = tuple(ground.positions[each][2] + above for each in points if each in ground.positions)
    return ground.frame.surface - min(heights, default=inf)


def _limit(robot_type: Element | None, models: ModelSet) -> float | None:
    """Return the depth that a type bears: None for no underwater vehicle, inf where not known."""
    if robot_type is None:
        return inf
    movements = [
        each for each in children(robot_type, "movementCapabilities") if is_kind(each, *AUV_MOVEMENT)
    ]
    if not movements:
        return None
    rated = [
        min((number(each, "maxDepth") or inf for each in children(movement, "thrusters")), default=inf)
        for movement in movements
    ]
    return min(max(rated), _pressure_depth(robot_type, models))


def _pressure_depth(robot_type: Element, models: ModelSet) -> float:
    pressure = number(robot_type, "maxOperatingPressure")
    if pressure is None:
        return inf
    environment = child(models.context, "environment") if models.context is not None else None
    density = number(environment, "waterDensity") if environment is not None else None
    return (pressure - ATMOSPHERE) / ((density or SEA_WATER) * GRAVITY)
