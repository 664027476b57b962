"""How many photos or samples survey tasks take, to find figures whose unit slipped."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from math import ceil, dist, inf

from shapely.geometry import Polygon

from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import children, number, text
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.planning.devices import figure
from mmrs_core.planning.limits import MOST
from mmrs_core.scene import Position
from mmrs_survey import names
from mmrs_survey.camera import IMAGE_KEYS, Footprint
from mmrs_survey.task_checks import devices_for

MANY = 20_000
"""Photos that take a drone most of a day."""

_Positions = Mapping[Element, Position]
_Check = Callable[[Element, ModelSet], Iterator[Finding]]


def amount_over(least: float, most: float = inf) -> _Check:
    """Return the check that yields tasks with more photos or samples than `least`, up to `most`."""

    def check(mission: Element, models: ModelSet) -> Iterator[Finding]:
        positions = sketch_of(models).ground.positions
        for task in children(mission, "tasks"):
            count = _amount(task, models, positions)
            if least < count <= most:
                what = "samples" if is_kind(task, *names.MEASURE_TASK) else "photos"
                yield Finding(task, f"task '{label_of(task)}' takes about {count:,.0f} {what}")

    return check


def _amount(task: Element, models: ModelSet, positions: _Positions) -> float:
    if is_kind(task, *names.PHOTO_GRID_TASK):
        seen = _spacing(task, models)
        return _area(task, positions) / seen.width / seen.length if seen is not None else 0.0
    if is_kind(task, *names.MEASURE_TASK):
        spacing = number(task, "spacing") or 0.0
        if spacing <= 0.0:
            return 0.0
        return _area(task, positions) / spacing / spacing + _length(task, positions) / spacing
    if is_kind(task, *names.ROAD_TASK):
        distance, strip = number(task, "photoDistance") or 0.0, number(task, "footprintWidth") or 0.0
        asked = (number(task, "width") or 0.0) / strip if strip > 0.0 else 1.0
        sides = max(1, ceil(asked)) if asked < MOST else asked
        return sides * _length(task, positions) / distance if distance > 0.0 else 0.0
    return 0.0


def _spacing(task: Element, models: ModelSet) -> Footprint | None:
    """Return how far apart photos are as far as the task itself says so, on some camera of the project."""
    grid, resolution = number(task, "gridResolution"), number(task, "groundResolution")
    if grid is not None:
        return Footprint(grid, grid) if grid > 0.0 else None
    width, length = number(task, "footprintWidth"), number(task, "footprintLength")
    if resolution is not None:
        width, length = _largest_image(task, models)
        width, length = width * resolution, length * resolution
    across = (width or 0.0) * (1.0 - (number(task, "sideOverlap") or 0.0))
    along = (length or 0.0) * (1.0 - (number(task, "frontOverlap") or 0.0))
    return Footprint(across, along) if across > 0.0 and along > 0.0 else None


def _largest_image(task: Element, models: ModelSet) -> tuple[float, float]:
    """Return across and along in pixels; of several cameras that of most, so that nothing is overstated."""
    sizes = []
    for device in devices_for(models, text(task, "actionName"), text(task, "deviceId")):
        properties = {text(each, "name"): text(each, "value") for each in children(device, "properties")}
        across, along = (figure(properties, key) or 0.0 for key in IMAGE_KEYS)
        sizes.append((across, along))
    return max(sizes, key=lambda size: size[0] * size[1], default=(0.0, 0.0))


def _area(task: Element, positions: _Positions) -> float:
    """Return the area of a task without its holes, square metres; 0 where it cannot be drawn."""
    rings = [children(task, "shell"), *(children(hole, "points") for hole in children(task, "holes"))]
    shell, *holes = [_drawn(ring, positions) for ring in rings]
    return max(shell - sum(holes), 0.0)


def _drawn(ring: tuple[Element, ...], positions: _Positions) -> float:
    corners = [positions[each][:2] for each in ring if each in positions]
    whole = len(corners) == len(ring) >= 3
    return float(Polygon(corners).area) if whole else 0.0


def _length(task: Element, positions: _Positions) -> float:
    points = [positions[each] for each in children(task, "points") if each in positions]
    return sum(dist(one, other) for one, other in pairwise(points))
