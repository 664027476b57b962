"""Constraints on the figures of survey tasks, and on where they are done."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.constraints.ranges import at_least_zero, every, of_kind, positive
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.features import child, children, number, text, texts
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_survey import names

IN_RANGES = every(
    of_kind(
        names.PHOTO_TASK, positive("footprintWidth", "footprintLength", "groundResolution", "speed", "blur")
    ),
    of_kind(names.PHOTO_GRID_TASK, positive("gridResolution")),
    of_kind(names.PATH_PHOTO_TASK, positive("photoDistance")),
    of_kind(names.PERIMETER_TASK, positive("layers")),
    of_kind(names.ORBIT_TASK, positive("radius", "turns")),
    of_kind(names.OBSERVE_TASK, positive("duration")),
    of_kind(names.MEASURE_TASK, positive("spacing")),
    of_kind(names.ROAD_TASK, at_least_zero("width", "turnaroundDistance")),
    of_kind(names.OBSERVE_TASK, at_least_zero("distance")),
    of_kind(names.MEASURE_TASK, at_least_zero("depth")),
    of_kind(names.APPROACH_TASK, at_least_zero("distance", "tolerance")),
)


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
