"""Draws what the place holds: areas and tasks."""

from __future__ import annotations

from mmrs_core.cli.preview.figures import clock, heights, length
from mmrs_core.cli.preview.markup import element, number, title
from mmrs_core.cli.preview.picture import TaskPicture, Zone
from mmrs_core.cli.preview.projection import Projection
from mmrs_core.scene import AreaUse

_USES = {
    AreaUse.FORBIDDEN: "forbidden area",
    AreaUse.OBSTACLE: "obstacle",
    AreaUse.EMERGENCY: "emergency area",
}


def zone_shape(zone: Zone, projection: Projection, *, passed: bool = False) -> str:
    """Return an area as drawn; one that robots pass over or under is drawn lightly."""
    tip = f"{zone.name}: {_USES[zone.use]}, {heights(zone.low, zone.high)}"
    kind = f"zone {zone.use.value}" + (" passed" if passed else "")
    attributes = {"class": kind, "d": projection.closed((zone.shell,))}
    return element("path", attributes, title(tip))


def kept_shape(zone: Zone, projection: Projection) -> str:
    """Return the outline that robots keep to."""
    verb = "shrunk" if zone.use is AreaUse.EMERGENCY else "grown"
    tip = f"{zone.name}, {verb} by the clearance of {length(zone.clearance)}"
    attributes = {"class": f"kept {zone.use.value}", "d": projection.closed(zone.kept)}
    return element("path", attributes, title(tip)) if zone.kept else ""


def task_shape(task: TaskPicture, projection: Projection) -> str:
    """Return a task: its area, line or point; empty for one without a place."""
    tip = title(task_tip(task))
    if task.rings:
        area = {"class": "task area", "d": projection.closed(task.rings), "fill_rule": "evenodd"}
        return element("path", area, tip)
    if task.line:
        return element("path", {"class": "task line", "d": f"M{projection.line(task.line)}"}, tip)
    if task.point is None:
        return ""
    x, y = projection.place(task.point)
    return element("path", {"class": "task point", "d": f"M{number(x)} {number(y - 6)}l6 6l-6 6l-6-6Z"}, tip)


def task_tip(task: TaskPicture) -> str:
    """Return what a task is, and when."""
    when = "" if task.begin is None or task.end is None else f", {clock(task.begin)} to {clock(task.end)}"
    return f"{task.name}: {task.kind}{when}"
