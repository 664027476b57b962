"""Writes the names on the map."""

from __future__ import annotations

import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.cli.preview.figures import heights
from mmrs_core.cli.preview.labels import Labels
from mmrs_core.cli.preview.map_places import task_tip
from mmrs_core.cli.preview.palette import style_of
from mmrs_core.cli.preview.picture import Picture, TaskPicture, Zone
from mmrs_core.cli.preview.projection import Projection
from mmrs_core.scene import AreaUse, Point

_HOME = 9.0
"""Half the width of the mark of a home, pixels."""


def words(picture: Picture, projection: Projection) -> str:
    """Return the names of robots, tasks and areas, none over another."""
    labels = Labels(projection.width)
    shown = shapely.box(projection.west, projection.south, projection.east, projection.north)
    for robot in picture.robots:
        labels.keep_off(projection.place(robot.home), _HOME)
    for index, robot in enumerate(picture.robots):
        x, y = projection.place(robot.home)
        labels.put(robot.name, (x, y + 22), "name", colour=style_of(index).colour)
    for task in picture.tasks:
        at = _middle(task)
        if at is not None:
            x, y = projection.place(at)
            labels.put(task.name, (x, y - (10 if task.point else 0)), "of-task", tip=task_tip(task))
    for zone in picture.zones:
        seen = shapely.intersection(Polygon(zone.shell), shown)
        if not seen.is_empty:
            x, y = projection.place(_middle_of(seen))
            labels.put(_zone_words(zone), (x, y + 4), f"of-{zone.use.value}")
    return labels.markup()


def _zone_words(zone: Zone) -> str:
    return f"{zone.name} ({heights(zone.low, zone.high)})" if zone.use is AreaUse.OBSTACLE else zone.name


def _middle(task: TaskPicture) -> Point | None:
    if task.rings:
        return _middle_of(Polygon(task.rings[0]))
    return task.line[len(task.line) // 2] if task.line else task.point


def _middle_of(shape: BaseGeometry) -> Point:
    x, y = shape.representative_point().coords[0]
    return float(x), float(y)
