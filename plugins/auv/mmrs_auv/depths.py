"""Whether tasks lie deeper than any robot of a team bears."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf

from mmrs_auv.kinds import ATMOSPHERE, GRAVITY, SEA_WATER
from mmrs_auv.names import AUV_MOVEMENT
from mmrs_core.contributions.constraints import Finding
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.grounding.coordinates import ground_of
from mmrs_core.languages.grounding.values import child, children, number, text
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Position

PLACES = ("points", "shell")


def too_deep(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks deeper than every robot bears; none where the limit of one is not known.

    Robots that are no underwater vehicles reach no depth at all, so a team without any is silent:
    other constraints and the planner tell it what it lacks.
    """
    team = children(child(mission, "team"), "robots") if child(mission, "team") is not None else ()
    limits = [_limit(models.robots.get(text(member, "type")), models) for member in team]
    deepest = max((limit for limit in limits if limit is not None), default=inf)
    ground = ground_of(mission, models.context)
    for task in children(mission, "tasks"):
        depth = _depth(task, ground.positions, ground.frame.surface)
        if depth > deepest + 1e-6:
            yield Finding(
                task,
                f"task '{label_of(task)}' is {depth:g} m deep, the team's vehicles bear {deepest:.1f} m",
            )


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


def _depth(task: Element, positions: Mapping[Element, Position], surface: float) -> float:
    depth, altitude = number(task, "depth"), number(task, "altitude")
    if depth is not None:
        return depth
    if altitude is not None:
        return surface - altitude
    return max((surface - positions[each][2] for each in _places(task) if each in positions), default=-inf)


def _places(task: Element) -> Iterator[Element]:
    point = child(task, "point")
    yield from (point,) if point is not None else ()
    yield from (each for name in PLACES for each in children(task, name))
