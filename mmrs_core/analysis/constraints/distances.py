"""Places so far away that they are hardly meant."""

from __future__ import annotations

from collections.abc import Iterator
from math import asin, cos, dist, inf, radians, sin, sqrt

from mmrs_core.analysis.constraints.findings import CONTEXT, MISSION, finding
from mmrs_core.analysis.constraints.sketch import Sketch, sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.languages.element import Element, container_of
from mmrs_core.languages.grounding.frame import coordinates_of, is_geographic, on_earth, origin_of
from mmrs_core.languages.grounding.values import children, number
from mmrs_core.languages.modelset import ModelSet

FAR = 50_000.0
"""Metres: beyond what robots of these languages travel, and where the flat frame begins to be inexact."""
EARTH_RADIUS = 6_371_000.0
"""Metres, mean."""


def _far_task(task: Element, models: ModelSet) -> Iterator[Finding]:
    away = _nearest_home(sketch_of(models), task)
    if away > FAR:
        yield finding(task, f"is {away / 1000:.0f} km from the nearest home")


def _far_context(context: Element, models: ModelSet) -> Iterator[Finding]:
    sketch = sketch_of(models)
    features = ("forbiddenAreas", "obstacles", "emergencyAreas")
    areas = [area for feature in features for area in children(context, feature)]
    away = min((_nearest_home(sketch, area) for area in areas), default=0.0)
    if away > FAR:
        yield finding(context, f"its nearest area is {away / 1000:.0f} km from the nearest home")


def _nearest_home(sketch: Sketch, element: Element) -> float:
    """Return the smallest distance from a home to a coordinate inside the element; 0 if one is not known."""
    positions = sketch.ground.positions
    homes = [robot.home for robot in sketch.robots if robot.home is not None]
    points = [positions[each] for each in coordinates_of(element) if each in positions]
    pairs = (dist(home[:2], point[:2]) for home in homes for point in points)
    nearest = min(pairs, default=0.0)
    return nearest if nearest < inf else 0.0


def _swapped(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield each element with a coordinate that would be near the origin if its two numbers were swapped."""
    origin = origin_of(mission)
    if origin is None or not is_geographic(origin) or not on_earth(origin):
        return
    latitude, longitude = _degrees(origin)
    seen: set[Element | None] = set()
    for coordinate in [*coordinates_of(mission), *coordinates_of(models.context)]:
        if not is_geographic(coordinate) or number(coordinate, "latitude") is None:
            continue
        north, east = _degrees(coordinate)
        far = great_circle(latitude, longitude, north, east) > FAR
        near = abs(east) <= 90 and great_circle(latitude, longitude, east, north) <= FAR
        if far and near and container_of(coordinate) not in seen:
            seen.add(container_of(coordinate))
            yield finding(
                coordinate, f"latitude {north:g} and longitude {east:g} look as if they were swapped"
            )


def _degrees(coordinate: Element) -> tuple[float, float]:
    return number(coordinate, "latitude") or 0.0, number(coordinate, "longitude") or 0.0


def great_circle(latitude: float, longitude: float, north: float, east: float) -> float:
    """Return the distance in metres between two positions in degrees on a sphere; good to half a per cent."""
    rise, run = radians(north - latitude) / 2, radians(east - longitude) / 2
    chord = sin(rise) ** 2 + cos(radians(latitude)) * cos(radians(north)) * sin(run) ** 2
    return 2 * EARTH_RADIUS * asin(sqrt(min(max(chord, 0.0), 1.0)))


CONSTRAINTS = (
    Constraint(
        "MML027",
        "Latitude and longitude are not swapped.",
        (MISSION, "Mission"),
        _swapped,
        "latitude is the one that grows to the north",
        Severity.WARNING,
    ),
    Constraint(
        "MML028",
        "Tasks are within 50 km of a home.",
        (MISSION, "Task"),
        _far_task,
        "check latitude and longitude of the task and of the homes",
        Severity.WARNING,
    ),
    Constraint(
        "CTX008",
        "The context describes the place of the mission.",
        (CONTEXT, "Context"),
        _far_context,
        "check that this is the context of this mission",
        Severity.WARNING,
    ),
)
