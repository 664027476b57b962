"""Constraints on where survey tasks are done: that robots may be at their points, lines and passes."""

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
from mmrs_core.grounding.features import children, number, value
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Position
from mmrs_survey.lines import lines_over, without_repeats
from mmrs_survey.names import MEASURE_TASK, ROAD_TASK


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
    line = without_repeats(points[::-1] if value(task, "inverted") is True else points)
    try:
        strip = (number(task, "footprintWidth") or inf) * (1.0 - (number(task, "sideOverlap") or 0.0))
        found = lines_over(line, number(task, "width"), strip)
    except InfeasibleError:
        return ()
    return found if len(found) > 1 else ()
