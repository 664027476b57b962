"""What must hold for survey tasks and the devices that do them."""

from __future__ import annotations

from mmrs_core.analysis.constraints.ranges import share
from mmrs_core.analysis.fixes.figures import as_part
from mmrs_core.contributions.constraints import Constraint
from mmrs_core.contributions.fixes import Fix
from mmrs_core.diagnostics import Severity
from mmrs_core.planning.limits import MOST
from mmrs_survey import names
from mmrs_survey.amounts import MANY, amount_over
from mmrs_survey.place_checks import (
    OVERLAPS,
    footprint_twice,
    half_footprint,
    nothing_reached,
    nothing_seen,
    overlap_unused,
    partly_reached,
    resolution_coarse,
    resolution_unfounded,
    seen_twice,
)
from mmrs_survey.task_checks import (
    IN_RANGES,
    action_undone,
    camera_unreadable,
    device_unclear,
    looks_at_itself,
    nowhere_to_measure,
    object_anywhere,
    parameter_unknown,
    relay_bound,
    twice_high,
    where_to_measure_twice,
)

DEVICE = ("urn:mmrs:robot:1.0", "Device")
MISSION = ("urn:mmrs:mission:1.0", "Mission")
TASK = ("urn:mmrs:mission:1.0", "Task")

CONSTRAINTS = (
    Constraint(
        "SUR001",
        "A photo grid has either a grid resolution or what one photo covers",
        names.PHOTO_GRID_TASK,
        seen_twice,
        "keep gridResolution, or keep the footprint or ground resolution with their overlaps",
    ),
    Constraint(
        "SUR002",
        "The distance between photos of a photo grid is defined",
        names.PHOTO_GRID_TASK,
        nothing_seen,
        "give gridResolution, a footprint, groundResolution, or the optics among the camera's properties",
    ),
    Constraint(
        "SUR003",
        "Overlaps are from 0 to below 1",
        names.PHOTO_TASK,
        share(*OVERLAPS),
        "write 0.8 for an overlap of 80 per cent",
    ),
    Constraint(
        "SUR004",
        "Lengths, distances, durations and speeds of survey tasks are not negative, most of them above zero",
        TASK,
        IN_RANGES,
        "correct the figure, or leave it out where it is optional",
    ),
    Constraint(
        "SUR005",
        "A footprint has a width and a length",
        names.PHOTO_GRID_TASK,
        half_footprint,
        "give both footprintWidth and footprintLength",
    ),
    Constraint(
        "SUR006",
        "What one photo covers is said once",
        names.PHOTO_TASK,
        footprint_twice,
        "keep the footprint or the ground resolution",
    ),
    Constraint(
        "SUR007",
        "Overlaps go with a footprint or ground resolution",
        names.PHOTO_GRID_TASK,
        overlap_unused,
        "leave the overlaps out: a grid resolution is already the distance between photos",
        Severity.WARNING,
    ),
    Constraint(
        "SUR008",
        "A ground resolution goes with a camera whose image size is known",
        names.PHOTO_TASK,
        resolution_unfounded,
        "add the properties image.width and image.height, in pixels, to the camera",
    ),
    Constraint(
        "SUR009",
        "It is clear which device does the action of a survey task",
        TASK,
        device_unclear,
        "name the device in deviceId",
    ),
    Constraint(
        "SUR010",
        "Some robot type has the device and action that a survey task asks for",
        TASK,
        action_undone,
        "correct deviceId or actionName, or add a robot that can do it",
    ),
    Constraint(
        "SUR011",
        "A measurement has an altitude or a depth, not both",
        names.MEASURE_TASK,
        twice_high,
        "keep depth under water, altitude above",
    ),
    Constraint(
        "SUR012",
        "A MeasureTask has points or a shell",
        names.MEASURE_TASK,
        nowhere_to_measure,
        "give points, or a shell of at least three points with a spacing",
    ),
    Constraint(
        "SUR013",
        "A measurement has points or a shell, not both",
        names.MEASURE_TASK,
        where_to_measure_twice,
        "make two tasks of it",
    ),
    Constraint(
        "SUR014",
        "The device's action takes the parameters of a measurement",
        names.MEASURE_TASK,
        parameter_unknown,
        "use the keys that the action's parameters state in the robot type",
    ),
    Constraint(
        "SUR015",
        "The optics and image size of a camera are numbers above zero",
        DEVICE,
        camera_unreadable,
        "write sensor.width, sensor.height and focal.length in millimetres, image.width and image.height "
        "in pixels, without a unit",
    ),
    Constraint(
        "SUR016",
        "How far an object may be from where it is expected is known",
        names.APPROACH_TASK,
        object_anywhere,
        "give a tolerance, or accept the unknown clearance in the mission",
        Severity.WARNING,
    ),
    Constraint(
        "SUR017",
        "A point is observed from somewhere else",
        names.OBSERVE_TASK,
        looks_at_itself,
        "give a distance or another altitude, so that the device has something to look at",
        Severity.WARNING,
    ),
    Constraint(
        "SUR018",
        "No survey task takes more photos or samples than a day has time for",
        MISSION,
        amount_over(MANY, MOST),
        "check that gridResolution, footprint, spacing and overlaps are as meant: lengths are in metres",
        Severity.WARNING,
    ),
    Constraint(
        "SUR019",
        "No survey task takes more photos or samples than can be planned",
        MISSION,
        amount_over(MOST),
        "correct gridResolution, footprint, spacing or overlaps: lengths are in metres; or divide the area",
        Severity.WARNING,
    ),
    Constraint(
        "SUR020",
        "A ground resolution is given in metres per pixel",
        names.PHOTO_TASK,
        resolution_coarse,
        "write 0.02 for 2 cm per pixel",
        Severity.WARNING,
    ),
    Constraint(
        "SUR021",
        "Every point of a measurement, and some part of its line or area, is one that some robot can be at",
        names.MEASURE_TASK,
        nothing_reached,
        "move it away, or make the area or its safetyDistance smaller",
    ),
    Constraint(
        "SUR022",
        "All of a measurement's line or area can be reached",
        names.MEASURE_TASK,
        partly_reached,
        "lead the line around the area, or above it; or measure in the rest alone",
        Severity.WARNING,
    ),
    Constraint(
        "SUR023",
        "All passes along a road can be followed",
        names.ROAD_TASK,
        partly_reached,
        "lead the road around the area, or above it, or make it narrower",
        Severity.WARNING,
    ),
    Constraint(
        "SUR024",
        "A relay task has no dependencies, one robot and no earliest start",
        MISSION,
        relay_bound,
        "remove it: the robot goes when others need it, and stays for as long as they do",
    ),
)

FIXES = (Fix("SUR003", "write the overlaps as parts of one", as_part(*OVERLAPS)),)
