"""Draws what the place holds: areas, tasks, and things that plug-ins know."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import dist

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.figures import clock, heights, length
from mmrs_core.pictures.preview.markup import element, number, text, title
from mmrs_core.pictures.preview.picture import Details, TaskPicture, Thing, Zone
from mmrs_core.pictures.preview.projection import Projection
from mmrs_core.scene import AreaUse, Point

BADGE = 8.5
"""Radius of a badge, pixels."""
STEM = 20.0
"""How far above a thing's place its badge stands, pixels."""

_USES = {
    AreaUse.FORBIDDEN: "forbidden area",
    AreaUse.OBSTACLE: "obstacle",
    AreaUse.EMERGENCY: "emergency area",
}


def zone_shape(zone: Zone, projection: Projection, *, passed: bool = False) -> str:
    """Return an area as drawn; one that robots pass over or under is drawn lightly."""
    extent = heights(zone.low, zone.high) if zone.types is None else f"for {', '.join(sorted(zone.types))}"
    tip = f"{zone.name}: {_USES[zone.use]}, {extent}"
    kind = f"zone {zone.use.value}" + (" passed" if passed else "")
    attributes = {"class": kind, "d": projection.closed((zone.shell,))}
    return element("path", attributes, title(tip))


def kept_shape(zone: Zone, projection: Projection) -> str:
    """Return the outline that robots keep to."""
    verb = "shrunk" if zone.use is AreaUse.EMERGENCY else "grown"
    tip = f"{zone.name}, {verb} by the clearance of {length(zone.clearance)}"
    attributes = {"class": f"kept {zone.use.value}", "d": projection.closed(zone.kept)}
    return element("path", attributes, title(tip)) if zone.kept else ""


def badge_places(tasks: Iterable[TaskPicture], projection: Projection) -> dict[str, Point]:
    """Return the pixels of the badges of tasks at points, by task: side by side where they share a point."""
    taken: list[Point] = []
    places: dict[str, Point] = {}
    for task in tasks:
        if task.point is not None and not (task.rings or task.line):
            x, y = projection.place(task.point)
            while any(dist((x, y), other) < BADGE for other in taken):
                x += 2 * BADGE + 1
            taken.append((x, y))
            places[task.name] = (x, y)
    return places


def task_shapes(tasks: Iterable[TaskPicture], projection: Projection) -> Iterator[str]:
    """Yield every task that has a place: its area, line or point."""
    shown = tuple(tasks)
    places = badge_places(shown, projection)
    return (_task_shape(task, projection, places.get(task.name)) for task in shown)


def _task_shape(task: TaskPicture, projection: Projection, at: Point | None) -> str:
    tip = title(task_tip(task))
    colour = task.symbol.colour
    if task.rings:
        area = {"class": "task area", "d": projection.closed(task.rings), "fill_rule": "evenodd"}
        return element("path", {**area, "stroke": colour, "fill": colour}, tip)
    if task.line:
        line = {"class": "task line", "d": f"M{projection.line(task.line)}", "stroke": colour}
        return element("path", line, tip)
    return badge(task.symbol, at, tip) if at is not None else ""


def task_tip(task: TaskPicture) -> str:
    """Return what a task is, and when."""
    when = "" if task.begin is None or task.end is None else f", {clock(task.begin)} to {clock(task.end)}"
    return f"{task.name}: {task.symbol.label}{_told(task.details)}{when}"


def thing_shape(thing: Thing, projection: Projection) -> str:
    """Return something at the place: its outlines, lines and marks; empty where it has none."""
    tip = title(thing_tip(thing))
    colour = {"stroke": thing.symbol.colour}
    area = {"class": "thing area", "d": projection.closed(thing.outlines), "fill": thing.symbol.colour}
    lines = (f"M{projection.line(line)}" for line in thing.lines)
    shapes = (
        element("path", {**area, **colour}, tip) if thing.outlines else "",
        *(element("path", {"class": "thing line", "d": line, **colour}, tip) for line in lines),
        *(_pin(thing.symbol, projection.place(mark), tip) for mark in thing.marks),
    )
    return element("g", None, shapes) if any(shapes) else ""


def thing_tip(thing: Thing) -> str:
    """Return what something at the place is."""
    called = f"{thing.name}: " if thing.name else ""
    return f"{called}{thing.symbol.label}{_told(thing.details)}"


def _pin(symbol: MapSymbol, at: Point, tip: str) -> str:
    """Return a badge on a stem that stands on a pixel, so that what else is there stays visible."""
    x, y = at
    stem = {"class": "stem", "stroke": symbol.colour, "d": f"M{number(x)} {number(y)}v{number(BADGE - STEM)}"}
    foot = {"class": "foot", "color": symbol.colour, "cx": x, "cy": y, "r": 2.0}
    shapes = element("path", stem), element("circle", foot), badge(symbol, (x, y - STEM))
    return element("g", {"class": "badge"}, shapes, tip)


def badge(symbol: MapSymbol, at: Point, *inside: str) -> str:
    """Return the sign of a symbol around a pixel: its icon on a white disc, a diamond where it has none."""
    x, y = at
    look = {"class": "badge", "stroke": symbol.colour, "transform": f"translate({number(x)} {number(y)})"}
    if not symbol.icon:
        return element("g", look, element("path", {"d": "M0-6L6 0L0 6L-6 0Z"}), *inside)
    icon = {"class": "icon", "y": 4, "text_anchor": "middle", "fill": symbol.colour}
    disc = element("circle", {"r": BADGE})
    return element("g", look, disc, element("text", icon, text(symbol.icon)), *inside)


def _told(details: Details) -> str:
    return "".join(f", {what} {words}" for what, words in details)
