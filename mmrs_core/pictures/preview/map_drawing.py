"""Draws the place: areas, tasks, homes and everybody's way, as SVG."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from shapely.geometry import Polygon

from mmrs_core.pictures.preview.crossings import crossings
from mmrs_core.pictures.preview.legend import legend_height, legend_markup
from mmrs_core.pictures.preview.map_furniture import furniture, grid, patterns
from mmrs_core.pictures.preview.map_places import kept_shape, task_shapes, thing_shape, zone_shape
from mmrs_core.pictures.preview.map_ways import coverage, home, marks_of, planned_way, robot_way
from mmrs_core.pictures.preview.map_words import words
from mmrs_core.pictures.preview.markup import element, number, style_sheet, text
from mmrs_core.pictures.preview.picture import Picture, Zone
from mmrs_core.pictures.preview.projection import Projection, projection_of
from mmrs_core.scene import AreaUse


def map_markup(picture: Picture, *, legend: bool = False, only: int | None = None) -> str:
    """Return the map as one ``svg`` element with its own style, readable by itself.

    Args:
        legend: whether to explain robots and signs beneath the map.
        only: index of the only robot to show; None: all of them.
    """
    shown = picture if only is None else replace(picture, robots=picture.robots[only : only + 1])
    projection = projection_of(shown)
    key = legend_markup(picture, projection) if legend else ""
    height = projection.height + (legend_height(picture, projection) if legend else 0.0)
    size = {"width": number(projection.width), "height": number(height)}
    attributes = {"xmlns": "http://www.w3.org/2000/svg", "class": "map", "role": "img", **size}
    view = {"viewBox": f"0 0 {size['width']} {size['height']}"}
    head = element("title", None, text(picture.title or "mission"))
    style = element("style", None, style_sheet("map.css"))
    return element(
        "svg", {**attributes, **view}, head, style, patterns(), _layers(shown, projection, only or 0), key
    )


def _layers(picture: Picture, projection: Projection, first: int) -> Iterator[str]:
    """Yield the layers; `first` is the index of the first robot, for its style."""
    robots = tuple(enumerate(picture.robots, start=first))
    yield element("rect", {"class": "ground", "width": projection.width, "height": projection.height})
    yield _layer("grid", grid(projection))
    yield _layer("emergency", (zone_shape(z, projection) for z in _with_use(picture, AreaUse.EMERGENCY)))
    yield _layer("tasks", task_shapes(picture.tasks, projection))
    yield _layer("coverage", coverage(picture, projection, first))
    yield _layer("clearance", (kept_shape(zone, projection) for zone in picture.zones))
    yield _layer("areas", _barriers(picture, projection))
    yield _layer("things", (thing_shape(thing, projection) for thing in picture.things))
    if picture.flown:
        yield _layer("planned", (planned_way(i, robot, projection) for i, robot in robots))
    yield _layer("ways", (robot_way(i, robot, projection) for i, robot in robots))
    if picture.flown:
        marks = (mark for i, robot in robots for mark in marks_of(i, robot, projection))
        yield _layer("marks", marks)
    yield _layer("homes", (home(i, robot, projection) for i, robot in robots))
    yield _layer("labels", (words(picture, projection, first),))
    yield _layer("furniture", furniture(projection))


def _layer(name: str, children: Iterable[str]) -> str:
    return element("g", {"class": f"layer {name}", "data-layer": name}, children)


def _with_use(picture: Picture, use: AreaUse) -> Iterator[Zone]:
    return (zone for zone in picture.zones if zone.use is use)


def _barriers(picture: Picture, projection: Projection) -> Iterator[str]:
    """Yield forbidden areas and obstacles, small ones over large ones."""
    barriers = (zone for zone in picture.zones if zone.use is not AreaUse.EMERGENCY)
    for zone in sorted(barriers, key=lambda zone: -Polygon(zone.shell).area):
        beneath = any(True for robot in picture.robots for _ in crossings(robot, [zone]))
        yield zone_shape(zone, projection, passed=beneath)
