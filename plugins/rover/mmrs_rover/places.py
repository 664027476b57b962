"""Whether homes and tasks lie where rovers can be: on their level, and on ground that they can pass."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from shapely import Point

from mmrs_core.analysis.constraints.sketch import DrawnRobot, Sketch, polygon_of, sketch_of
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.coordinates import heights_of_task
from mmrs_core.grounding.features import children, number
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_rover.names import ROVER, TERRAIN
from mmrs_rover.terrain import hindrances

EXACT = 1e-6
"""Metres."""


def off_level(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks on whose level no rover of the team is; none where some robot is not a rover."""
    sketch = sketch_of(models)
    levels = {_level(robot) for robot in sketch.robots}
    if None in levels or not levels:
        return
    known = sorted(level for level in levels if level is not None)
    for task in children(mission, "tasks"):
        heights = heights_of_task(task, sketch.ground)
        if heights and not any(all(abs(up - level) <= EXACT for up in heights) for level in known):
            yield Finding(task, _words(task, heights, known))


def _words(task: Element, heights: tuple[float, ...], levels: list[float]) -> str:
    low, high = min(heights), max(heights)
    where = f"{low:g} m" if low == high else f"{low:g} to {high:g} m"
    stay = " or ".join(f"{level:g} m" for level in levels)
    return f"task '{label_of(task)}' is at {where}, the team's rovers stay on the ground at {stay}"


def _level(robot: DrawnRobot) -> float | None:
    """Return the height of a rover's home; None for other robots, or without a position."""
    if robot.type is None or robot.home is None or not is_kind(robot.type, *ROVER):
        return None
    return robot.home[2]


def on_impassable_ground(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the rovers whose homes are in, or too near to, terrain that they cannot pass."""
    sketch = sketch_of(models)
    for robot in sketch.robots:
        if robot.type is None or robot.home is None or not is_kind(robot.type, *ROVER):
            continue
        for terrain, why in _hindering(robot.type, models):
            short = _short(robot, terrain, sketch)
            if short > EXACT:
                yield Finding(
                    robot.element,
                    f"home of '{label_of(robot.element)}' is {short:.2f} m too near to"
                    f" '{label_of(terrain)}': {why}",
                )


def _hindering(rover: Element, models: ModelSet) -> Iterator[tuple[Element, str]]:
    for terrain in children(models.context, "elements"):
        if is_kind(terrain, *TERRAIN):
            why = " and ".join(hindrances(partial(number, rover), partial(number, terrain)))
            yield from ((terrain, why),) if why else ()


def _short(robot: DrawnRobot, terrain: Element, sketch: Sketch) -> float:
    """Return by how much a home is too near to terrain, metres; negative where it is not."""
    ring = sketch.ring(terrain, "shell")
    shape = polygon_of(ring) if ring is not None else None
    if shape is None or robot.home is None or robot.type is None:
        return 0.0
    room = (robot.clearance or 0.0) + (number(robot.type, "turningRadius") or 0.0)
    kept = float(shape.distance(Point(robot.home[:2])))
    return room + (number(terrain, "safetyDistance") or 0.0) - kept
