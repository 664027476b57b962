"""Constraints on photo grids, and on where survey tasks are done: that robots may be there."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import inf

from mmrs_core.analysis.constraints.blocked import BlockedLine, blocked_line
from mmrs_core.analysis.constraints.clearances import (
    covered,
    partly_covered,
    positions_of,
    smallest_clearance,
    unreachable,
)
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Finding
from mmrs_core.errors import InfeasibleError
from mmrs_core.grounding.features import children, number, text, value
from mmrs_core.languages.element import Element, is_kind, is_set, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Position
from mmrs_survey.camera import FOCAL_KEY, IMAGE_KEYS, SENSOR_KEYS
from mmrs_survey.lines import lines_over, without_dense
from mmrs_survey.names import MEASURE_TASK, ROAD_TASK
from mmrs_survey.task_checks import devices_for

FOOTPRINT = ("footprintWidth", "footprintLength")
SEEN = (*FOOTPRINT, "groundResolution")
OVERLAPS = ("frontOverlap", "sideOverlap")
COARSE = 0.5
"""Metres per pixel, as photos of satellites have; from it on the unit is suspect."""


def seen_twice(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield photo grids with both a grid resolution and what one photo covers."""
    given = _given(task, SEEN)
    if number(task, "gridResolution") is not None and given:
        yield Finding(task, f"task '{label_of(task)}' has both gridResolution and {' and '.join(given)}")


def nothing_seen(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield photo grids for which neither the task nor any camera defines the distance between photos."""
    if _given(task, ("gridResolution", *SEEN)):
        return
    devices = devices_for(models, text(task, "actionName"), text(task, "deviceId"))
    if not any(_keys(device) >= {*SENSOR_KEYS, FOCAL_KEY} for device in devices):
        yield Finding(task, f"task '{label_of(task)}' does not define the distance between photos")


def half_footprint(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield footprints with a width only or a length only."""
    given = _given(task, FOOTPRINT)
    if len(given) == 1:
        (missing,) = set(FOOTPRINT) - set(given)
        yield Finding(task, f"{missing} of task '{label_of(task)}' is missing, {given[0]} is given")


def footprint_twice(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield photo grids with both a footprint and a ground resolution."""
    given = _given(task, FOOTPRINT)
    if given and number(task, "groundResolution") is not None:
        yield Finding(task, f"task '{label_of(task)}' has both groundResolution and {' and '.join(given)}")


def overlap_unused(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield overlaps beside a grid resolution."""
    given = [name for name in OVERLAPS if is_set(task, name)]
    if number(task, "gridResolution") is not None and given:
        yield Finding(
            task, f"{' and '.join(given)} of task '{label_of(task)}' has no use with a gridResolution"
        )


def resolution_unfounded(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield ground resolutions that no camera's image size turns into a footprint."""
    if number(task, "groundResolution") is None:
        return
    devices = devices_for(models, text(task, "actionName"), text(task, "deviceId"))
    if devices and not any(_keys(device) >= set(IMAGE_KEYS) for device in devices):
        yield Finding(
            task, f"groundResolution of task '{label_of(task)}' goes with no camera of known image size"
        )


def resolution_coarse(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield ground resolutions as coarse as those of satellites."""
    resolution = number(task, "groundResolution")
    if resolution is not None and resolution >= COARSE:
        yield Finding(
            task, f"groundResolution of task '{label_of(task)}' is {resolution:g} m per pixel, as from space"
        )


def _given(task: Element, names: tuple[str, ...]) -> list[str]:
    return [name for name in names if number(task, name) is not None]


def _keys(device: Element) -> set[str]:
    return {text(each, "name") for each in children(device, "properties")}


def nothing_reached(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield points of a measurement where no robot may be; its line or area if none may be anywhere there."""
    return _found(task, _unreached(task, models))


def partly_reached(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield parts of a measurement's line or area, or of a road's passes, where no robot may be."""
    area = is_kind(task, *MEASURE_TASK) and not children(task, "points")
    return _found(task, partly_covered(task, models) if area else _interrupted(task, models))


def _found(task: Element, messages: Iterable[str]) -> Iterator[Finding]:
    return (Finding(task, f"task '{label_of(task)}': {message}") for message in messages)


def _unreached(task: Element, models: ModelSet) -> Iterator[str]:
    points = children(task, "points")
    if not points:
        yield from covered(task, models)
    elif _is_line(task):
        lines = [line for _, line in _lines(task, models)]
        if lines and not any(line.left for line in lines):
            names = ", ".join(dict.fromkeys(name for line in lines for _, name in line.blocked))
            yield f"every part of its line is too near to {names} for every robot"
    else:
        for index, point in enumerate(points, 1):
            yield from unreachable(task, point, f"point {index}", models)


def _interrupted(task: Element, models: ModelSet) -> Iterator[str]:
    lines = list(_lines(task, models)) if is_kind(task, *ROAD_TASK) or _is_line(task) else []
    if not any(line.left for _, line in lines):
        return
    for what, line in lines:
        for (begin, end), names in line.blocked:
            yield (
                f"{end - begin:.1f} of the {line.length:.1f} m of {what} are too near to {names} for every"
                f" robot, from {begin:.1f} m along it"
            )


def _is_line(task: Element) -> bool:
    return number(task, "spacing") is not None and len(children(task, "points")) > 1


def _lines(task: Element, models: ModelSet) -> Iterator[tuple[str, BlockedLine]]:
    """Yield the line of a measurement, or the passes of a road that has several, and what is open of them."""
    sketch, smallest = sketch_of(models), smallest_clearance(task, models)
    points = positions_of(task, "points", sketch)
    if smallest is None or len(points) < max(2, len(children(task, "points"))):
        return
    if not is_kind(task, *ROAD_TASK):
        yield "its line", blocked_line(sketch, points, smallest)
        return
    for index, line in enumerate(_passes(task, points), 1):
        yield f"pass {index}", blocked_line(sketch, line, smallest)


def _passes(task: Element, points: Sequence[Position]) -> tuple[tuple[Position, ...], ...]:
    """Return the passes of a road; none where it has but one, which is its line, or cannot be divided."""
    line = tuple(without_dense(points[::-1] if value(task, "inverted") is True else points))
    try:
        strip = (number(task, "footprintWidth") or inf) * (1.0 - (number(task, "sideOverlap") or 0.0))
        found = lines_over(line, number(task, "width"), strip)
    except InfeasibleError:
        return ()
    return found if len(found) > 1 else ()
