"""What must hold for panel groups, tasks on them, and cameras; and fixes of figures of panel groups."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.constraints.ranges import Range, at_least_zero, every, positive, share
from mmrs_core.analysis.fixes.figures import as_part
from mmrs_core.contributions.constraints import Constraint
from mmrs_core.contributions.fixes import Edit, Fix, Wrong, with_value
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import number
from mmrs_solar.names import IRRADIANCE, PANEL_GROUP, PANEL_LOOK_TASK, PANEL_TASK, THERMAL_ROW_TASK
from mmrs_solar.panel_checks import (
    OVERLAPS,
    camera_unreadable,
    coarse,
    dim,
    hasty,
    name_shared,
    out_of_square,
    panel_outside,
    row_outside,
    rows_overlap,
    too_dark,
    undescribed,
    undone,
    unrecorded,
)

CONTEXT = ("urn:mmrs:context:1.0", "Context")
DEVICE = ("urn:mmrs:robot:1.0", "Device")

CONSTRAINTS = (
    Constraint(
        "SOL001",
        "Numbers and lengths of a panel group are above zero, its height is not negative",
        PANEL_GROUP,
        every(positive("rows", "pitch", "rowWidth", "columns", "tiers", "cellSize"), at_least_zero("height")),
        "correct the figure, or leave it out where it is optional",
    ),
    Constraint(
        "SOL002",
        "Panels have a tilt from 0 to 90 and an azimuth from 0 to 360 degrees",
        PANEL_GROUP,
        every(Range(("tilt",), low=0.0, high=90.0), Range(("azimuth",), low=0.0, high=360.0)),
        "tilt 0 faces the sky, 90 the horizon; azimuth 180 is south",
    ),
    Constraint(
        "SOL003",
        "Panels face square to their row",
        PANEL_GROUP,
        out_of_square,
        "put the points at the two ends of the first row",
    ),
    Constraint(
        "SOL004",
        "Rows of panels leave each other room",
        PANEL_GROUP,
        rows_overlap,
        "give the pitch from one row to the same place of the next, level and across the rows",
    ),
    Constraint(
        "SOL005",
        "Every panel group has a name of its own",
        CONTEXT,
        name_shared,
        "give each panel group another name",
    ),
    Constraint(
        "SOL006",
        "Lengths and speeds of tasks on panels are above zero, their irradiance is not negative",
        PANEL_TASK,
        every(positive("distance", "pixelSize", "blur", "speed"), at_least_zero(IRRADIANCE)),
        "correct the figure, or leave it out where it is optional",
    ),
    Constraint(
        "SOL007",
        "Overlaps of thermal images are from 0 to below 1",
        THERMAL_ROW_TASK,
        share(*OVERLAPS),
        "write 0.8 for an overlap of 80 per cent",
    ),
    Constraint(
        "SOL008",
        "A panel group has the rows that a task asks for",
        THERMAL_ROW_TASK,
        row_outside,
        "rows count from 1, the one that the group's points are below",
    ),
    Constraint(
        "SOL009",
        "A panel group has the panels that are suspected",
        PANEL_LOOK_TASK,
        panel_outside,
        "rows, columns and tiers count from 1, up to their numbers in the group",
    ),
    Constraint(
        "SOL010",
        "A cell is seen with five pixels across at least, as IEC TS 62446-3 asks",
        PANEL_TASK,
        coarse,
        "ask for smaller pixels",
        Severity.WARNING,
    ),
    Constraint(
        "SOL011",
        "Panels are inspected in 600 W/m² at least, as IEC TS 62446-3 asks",
        PANEL_TASK,
        dim,
        "ask for 600: with less sunlight faults hardly show",
        Severity.WARNING,
    ),
    Constraint(
        "SOL012",
        "Thermal images along rows are taken at no more than 2 m/s, overlapping by 80 and 60 per cent",
        THERMAL_ROW_TASK,
        hasty,
        "keep to what is recommended, or check that every panel is on a sharp image",
        Severity.WARNING,
    ),
    Constraint(
        "SOL013",
        "Some robot type has a camera for what a task on panels asks for",
        PANEL_TASK,
        undone,
        "correct deviceId or the names of the actions, or add a robot that can do it",
    ),
    Constraint(
        "SOL014",
        "A camera for tasks on panels states its optics, exposure and interval",
        PANEL_TASK,
        undescribed,
        "add these properties to the camera: lengths in millimetres, images in pixels, times in seconds",
    ),
    Constraint(
        "SOL015",
        "Times and angles of a camera are figures",
        DEVICE,
        camera_unreadable,
        "write times in seconds, above zero, and angles from -90 to 90 degrees, without a unit",
    ),
    Constraint(
        "SOL016",
        "The least irradiance is recorded with the images that need it",
        PANEL_TASK,
        unrecorded,
        "add a parameter with that key to the camera's action",
    ),
    Constraint(
        "SOL017",
        "There is as much sunlight as tasks on panels ask for",
        PANEL_TASK,
        too_dark,
        "wait for more sun, and state the irradiance that is measured in the plane of the panels",
    ),
)


def _azimuth_in_the_circle(wrong: Wrong) -> Iterator[Edit]:
    """Yield an azimuth that counts anticlockwise, or beyond the circle, as one from 0 to 360."""
    found = number(wrong.element, "azimuth") if wrong.element is not None else None
    attribute = wrong.tag.attribute("azimuth")
    if attribute is not None and found is not None and not 0.0 <= found <= 360.0 and abs(found) <= 720.0:
        yield with_value(attribute, f"{found % 360.0:.12g}")


FIXES = (
    Fix("SOL002", "write the azimuth clockwise from north", _azimuth_in_the_circle),
    Fix("SOL007", "write the overlaps as parts of one", as_part(*OVERLAPS)),
)
