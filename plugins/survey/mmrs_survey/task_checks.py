"""Constraints on the figures of survey tasks, and on where they are done."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import child, children, number, text, texts
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_survey import names

ABOVE_ZERO = {
    names.PHOTO_TASK: ("footprintWidth", "footprintLength", "groundResolution", "speed", "blur"),
    names.PHOTO_GRID_TASK: ("gridResolution",),
    names.PATH_PHOTO_TASK: ("photoDistance",),
    names.PERIMETER_TASK: ("layers",),
    names.ORBIT_TASK: ("radius", "turns"),
    names.OBSERVE_TASK: ("duration",),
    names.MEASURE_TASK: ("spacing",),
}
NOT_NEGATIVE = {
    names.ROAD_TASK: ("width", "turnaroundDistance"),
    names.OBSERVE_TASK: ("distance",),
    names.MEASURE_TASK: ("depth",),
    names.APPROACH_TASK: ("distance", "tolerance"),
}


def not_positive(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield figures that must be above zero, or not negative, and are not."""
    for name in _of(task, ABOVE_ZERO):
        figure = number(task, name)
        if figure is not None and not figure > 0.0:
            yield Finding(task, f"{name} of task '{label_of(task)}' is {figure:g}, it must be above 0")
    for name in _of(task, NOT_NEGATIVE):
        figure = number(task, name)
        if figure is not None and not figure >= 0.0:
            yield Finding(task, f"{name} of task '{label_of(task)}' is {figure:g}, it must not be negative")


def _of(task: Element, figures: dict[tuple[str, str], tuple[str, ...]]) -> Iterator[str]:
    for metaclass, features in figures.items():
        if is_kind(task, *metaclass):
            yield from features


def relay_bound(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield what a mission asks of the tasks of relays that these, which last as others need, cannot keep."""
    relays = [task for task in children(mission, "tasks") if is_kind(task, *names.RELAY_TASK)]
    for dependency in children(mission, "taskDependencies") if relays else ():
        for task in relays:
            if task in (child(dependency, "from"), child(dependency, "to")):
                yield Finding(dependency, f"task '{label_of(task)}' is a relay, it cannot have dependencies")
    for task in relays:
        if (number(task, "robotsWanted") or 1) > 1:
            yield Finding(task, f"task '{label_of(task)}' is a relay, but wants several robots")
        if number(task, "earliestStart"):
            yield Finding(task, f"task '{label_of(task)}' is a relay, but has an earliest start")


def twice_high(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield measurements with an altitude and a depth."""
    if number(task, "altitude") is not None and number(task, "depth") is not None:
        yield Finding(task, f"task '{label_of(task)}' has both an altitude and a depth")


def nowhere_to_measure(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield measurements without points or an area with a spacing."""
    points, shell = children(task, "points"), children(task, "shell")
    if not points and not shell:
        yield Finding(task, f"task '{label_of(task)}' has neither points nor a shell")
    elif shell and len(shell) < 3:
        yield Finding(task, f"shell of task '{label_of(task)}' has {len(shell)} points, 3 are needed")
    elif shell and number(task, "spacing") is None:
        yield Finding(task, f"spacing of task '{label_of(task)}' is missing, its shell needs one")


def where_to_measure_twice(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield measurements with points and an area."""
    if children(task, "points") and children(task, "shell"):
        yield Finding(task, f"task '{label_of(task)}' has both points and a shell")


def object_anywhere(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield approaches without a tolerance, unless the mission accepts what follows from that."""
    accepted = texts(models.mission, "acceptedUnknowns") if models.mission is not None else ()
    if number(task, "tolerance") is None and "clearance" not in accepted:
        where = text(task, "object")
        yield Finding(task, f"tolerance of task '{label_of(task)}' is missing: '{where}' may be anywhere")


def looks_at_itself(task: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield observations from the very point that is looked at."""
    if number(task, "altitude") is None and not number(task, "distance"):
        yield Finding(task, f"task '{label_of(task)}' is observed from the point itself")
