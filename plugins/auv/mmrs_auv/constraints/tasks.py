"""Constraints on tasks under water, and on pipelines."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TypeAlias

from mmrs_auv import names
from mmrs_auv.tasks.pipelines import way_along
from mmrs_auv.tasks.surveys import height_of, swath_at
from mmrs_core.analysis.constraints.blocked import blocked_line
from mmrs_core.analysis.constraints.capabilities import able
from mmrs_core.analysis.constraints.ranges import Range, at_least_zero, every, of_kind, positive, share
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.analysis.fixes.figures import as_part, exchanged
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.contributions.fixes import Fix
from mmrs_core.diagnostics import Severity
from mmrs_core.errors import InfeasibleError
from mmrs_core.grounding.features import child, children, number, text, value
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Position

TASK = ("urn:mmrs:mission:1.0", "Task")
CONTEXT = ("urn:mmrs:context:1.0", "Context")

_Findings: TypeAlias = Iterator[Finding]

IN_RANGES = every(
    of_kind(names.DEPTH_HOLD_SURVEY_TASK, positive("swath")),
    of_kind(names.INSPECT_OBJECT_TASK, positive("distance", "views")),
    of_kind(names.ALIGN_TASK, positive("distance")),
    of_kind(names.RECORDING, positive("speed")),
    of_kind(names.INSPECT_OBJECT_TASK, at_least_zero("duration")),
    of_kind(names.ALIGN_TASK, at_least_zero("duration", "tolerance")),
    of_kind(names.SURFACE_TASK, at_least_zero("duration")),
    of_kind(names.FOLLOW_PIPELINE_TASK, at_least_zero("height")),
)
IN_WATER = at_least_zero("depth", "minDepth")
UNDER_WATER = every(of_kind(names.DEPTH_HOLD_SURVEY_TASK, IN_WATER), of_kind(names.YO_YO_TASK, IN_WATER))


def _swath_missing(task: Element, models: ModelSet) -> _Findings:
    if number(task, "swath") is not None or not models.robots:
        return
    height = height_of(number(task, "depth"), number(task, "bottomDepth"))
    asked = text(task, "deviceId")
    known = (
        swath_at(_properties(device), height)
        for robot_type in models.robots.values()
        for device in children(robot_type, "devices")
        if asked in ("", text(device, "id"))
    )
    if all(swath is None for swath in known):
        yield Finding(task, f"swath of task '{label_of(task)}' is missing, and no device defines one")


def _properties(device: Element) -> dict[str, str]:
    return {text(each, "name"): text(each, "value") for each in children(device, "properties")}


def _below_bottom(task: Element, models: ModelSet) -> _Findings:
    depth, bottom = number(task, "depth"), number(task, "bottomDepth")
    if depth is not None and bottom is not None and depth >= bottom:
        yield Finding(task, f"depth of task '{label_of(task)}' is {depth:g} m, the bottom is at {bottom:g} m")


def _depths_upside_down(task: Element, models: ModelSet) -> _Findings:
    upper, lower = number(task, "minDepth"), number(task, "maxDepth")
    if upper is not None and lower is not None and lower <= upper:
        yield Finding(
            task, f"maxDepth of task '{label_of(task)}' is {lower:g} m, not below its minDepth of {upper:g} m"
        )


def _never_begun(task: Element, models: ModelSet) -> _Findings:
    stop = text(task, "stopAction")
    if stop and not text(task, "startAction"):
        yield Finding(task, f"task '{label_of(task)}' ends what it records by '{stop}', and never begins it")


def _name_shared(context: Element, models: ModelSet) -> _Findings:
    pipelines = [each for each in children(context, "elements") if is_kind(each, *names.PIPELINE)]
    counted = Counter(label_of(each) for each in pipelines)
    for pipeline in pipelines:
        name = label_of(pipeline)
        if not name:
            yield Finding(pipeline, "pipeline has no name for tasks to refer to")
        elif counted[name] > 1:
            yield Finding(pipeline, f"pipeline '{name}' is one of {counted[name]} of that name")


def _no_satellites(task: Element, models: ModelSet) -> _Findings:
    mission = models.mission
    team = child(mission, "team")
    types = [models.robots.get(text(member, "type")) for member in children(team, "robots")]
    if types and all(each is not None and value(each, "gps") is not True for each in types):
        yield Finding(task, f"task '{label_of(task)}' comes up for a fix, no robot of the team has gps")


TASK_CONSTRAINTS = (
    Constraint(
        "AUV022",
        "How wide a strip a sonar survey covers is known",
        names.DEPTH_HOLD_SURVEY_TASK,
        _swath_missing,
        "give a swath, or state sonar.swath, sonar.aperture or sonar.range of the device",
    ),
    Constraint(
        "AUV023",
        "Swaths overlap by a part of their width",
        names.DEPTH_HOLD_SURVEY_TASK,
        share("overlap"),
        "write a part of one: 0.2 is a fifth of the swath",
    ),
    Constraint(
        "AUV024",
        "A sonar survey is above the bottom",
        names.DEPTH_HOLD_SURVEY_TASK,
        _below_bottom,
        "both depths count down from the surface",
    ),
    Constraint(
        "AUV025",
        "A yo-yo goes down from its minDepth to its maxDepth",
        names.YO_YO_TASK,
        _depths_upside_down,
        "exchange the two figures",
    ),
    Constraint(
        "AUV026",
        "A yo-yo goes neither level nor upright",
        names.YO_YO_TASK,
        Range(("pitch",), low=0.0, high=90.0, without_low=True, without_high=True),
        "pitch is in degrees, such as 15",
    ),
    Constraint(
        "AUV027",
        "Distances, speeds, numbers and durations of tasks under water are positive",
        TASK,
        IN_RANGES,
        "correct the figure, or leave it out where it is optional",
    ),
    Constraint(
        "AUV028",
        "Depths of tasks count down from the surface",
        TASK,
        UNDER_WATER,
        "write depths as positive numbers",
    ),
    Constraint(
        "AUV029",
        "What is recorded is begun before it is ended",
        names.RECORDING,
        _never_begun,
        "add a startAction",
        Severity.WARNING,
    ),
    Constraint(
        "AUV030",
        "Every pipeline has a name of its own",
        CONTEXT,
        _name_shared,
        "tasks refer to pipelines by name",
    ),
    Constraint(
        "AUV031",
        "Some robot of the team finds its position by satellites where a task comes up for that",
        names.SURFACE_TASK,
        _no_satellites,
        'write gps="true" if a robot type has a receiver',
        Severity.WARNING,
    ),
)
"""What must hold for tasks under water."""


def _interrupted(task: Element, models: ModelSet) -> Iterator[Finding]:
    sketch, way = sketch_of(models), _way(task, models)
    clearances = [robot.clearance for robot in able(task, models)]
    smallest = min((each for each in clearances if each is not None), default=None)
    if not way or smallest is None or None in clearances:
        return
    line = blocked_line(sketch, way, smallest)
    for (begin, end), areas in line.blocked:
        yield Finding(
            task,
            f"task '{label_of(task)}': {end - begin:.1f} of the {line.length:.1f} m of its pipeline are too "
            f"near to {areas} for every robot, from {begin:.1f} m on",
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
        names.FOLLOW_PIPELINE_TASK,
        _interrupted,
        "follow it on the other side, or make the area or its safetyDistance smaller",
        Severity.WARNING,
    ),
)
"""What must hold for tasks along pipelines."""


FIXES = (
    Fix("AUV005", "exchange operatingThrust and maxThrust", exchanged("operatingThrust", "maxThrust")),
    Fix("AUV006", "exchange operatingPower and maxPower", exchanged("operatingPower", "maxPower")),
    Fix("AUV023", "write the overlap as a part of one", as_part("overlap")),
    Fix("AUV025", "exchange minDepth and maxDepth", exchanged("minDepth", "maxDepth")),
)
