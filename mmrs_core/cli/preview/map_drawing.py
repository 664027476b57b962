"""Draws the place: areas, tasks, homes and everybody's way, as SVG."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from math import atan2, degrees, dist

import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.cli.preview.figures import clock, heights, length
from mmrs_core.cli.preview.labels import Labels
from mmrs_core.cli.preview.legend import legend_height, legend_markup
from mmrs_core.cli.preview.markup import element, number, style_sheet, text
from mmrs_core.cli.preview.palette import Style, style_of
from mmrs_core.cli.preview.picture import Leg, Picture, RobotPicture, TaskPicture, Zone
from mmrs_core.cli.preview.projection import Projection, projection_of
from mmrs_core.scene import AreaUse, Point, Position

_ARROW_EVERY = 90.0
_KINDS = {"launch": "take-off", "transit": "transit", "work": "work", "recover": "landing"}
_USES = {
    AreaUse.FORBIDDEN: "forbidden area",
    AreaUse.OBSTACLE: "obstacle",
    AreaUse.EMERGENCY: "emergency area",
}


def map_markup(picture: Picture, *, legend: bool = False) -> str:
    """Return the map as one ``svg`` element with its own style, readable by itself.

    Args:
        legend: whether to explain robots and signs beneath the map.
    """
    projection = projection_of(picture)
    key = legend_markup(picture, projection) if legend else ""
    height = projection.height + (legend_height(picture, projection) if legend else 0.0)
    size = {"width": number(projection.width), "height": number(height)}
    attributes = {"xmlns": "http://www.w3.org/2000/svg", "class": "map", "role": "img", **size}
    view = {"viewBox": f"0 0 {size['width']} {size['height']}"}
    head = element("title", None, text(picture.title or "mission"))
    style = element("style", None, style_sheet("map.css"))
    return element("svg", {**attributes, **view}, head, style, _defs(), _layers(picture, projection), key)


def _layers(picture: Picture, projection: Projection) -> Iterator[str]:
    robots = tuple(enumerate(picture.robots))
    yield element("rect", {"class": "ground", "width": projection.width, "height": projection.height})
    yield _layer("grid", _grid(projection))
    yield _layer("emergency", (_zone(z, projection) for z in _with_use(picture, AreaUse.EMERGENCY)))
    yield _layer("tasks", (_task(task, projection) for task in picture.tasks))
    yield _layer("coverage", _coverage(picture, projection))
    yield _layer("clearance", (_kept(zone, projection) for zone in picture.zones))
    yield _layer("areas", (_zone(zone, projection) for zone in _barriers(picture)))
    yield _layer("ways", (_robot(i, robot, projection) for i, robot in robots))
    yield _layer("homes", (_home(i, robot, projection) for i, robot in robots))
    yield _layer("labels", (_words(picture, projection),))
    yield _layer("furniture", _furniture(projection))


def _layer(name: str, children: Iterable[str]) -> str:
    return element("g", {"class": f"layer {name}", "data-layer": name}, children)


def _with_use(picture: Picture, use: AreaUse) -> Iterator[Zone]:
    return (zone for zone in picture.zones if zone.use is use)


def _barriers(picture: Picture) -> Iterator[Zone]:
    return (zone for zone in picture.zones if zone.use is not AreaUse.EMERGENCY)


def _closed(rings: Iterable[Iterable[Point]], projection: Projection) -> str:
    return " ".join(f"M{_line(ring, projection)}Z" for ring in rings)


def _line(points: Iterable[Point | Position], projection: Projection) -> str:
    placed = (projection.place(point) for point in points)
    return "L".join(f"{number(x)} {number(y)}" for x, y in placed)


def _zone(zone: Zone, projection: Projection) -> str:
    tip = f"{zone.name}: {_USES[zone.use]}, {heights(zone.low, zone.high)}"
    attributes = {"class": f"zone {zone.use.value}", "d": _closed((zone.shell,), projection)}
    return element("path", attributes, _title(tip))


def _kept(zone: Zone, projection: Projection) -> str:
    verb = "shrunk" if zone.use is AreaUse.EMERGENCY else "grown"
    tip = f"{zone.name}, {verb} by the clearance of {length(zone.clearance)}"
    attributes = {"class": f"kept {zone.use.value}", "d": _closed(zone.kept, projection)}
    return element("path", attributes, _title(tip)) if zone.kept else ""


def _title(words: str) -> str:
    return element("title", None, text(words))


def _task(task: TaskPicture, projection: Projection) -> str:
    tip = _title(_task_tip(task))
    if task.rings:
        area = {"class": "task area", "d": _closed(task.rings, projection), "fill_rule": "evenodd"}
        return element("path", area, tip)
    if task.line:
        return element("path", {"class": "task line", "d": f"M{_line(task.line, projection)}"}, tip)
    if task.point is None:
        return ""
    x, y = projection.place(task.point)
    return element("path", {"class": "task point", "d": f"M{number(x)} {number(y - 6)}l6 6l-6 6l-6-6Z"}, tip)


def _task_tip(task: TaskPicture) -> str:
    when = "" if task.begin is None or task.end is None else f", {clock(task.begin)} to {clock(task.end)}"
    return f"{task.name}: {task.kind}{when}"


def _coverage(picture: Picture, projection: Projection) -> Iterator[str]:
    for index, robot in enumerate(picture.robots):
        covered = [leg for leg in robot.legs if leg.width > 0 and len(leg.points) > 1]
        parts = (_strip(leg, projection) for leg in covered)
        look = {"class": "covered", "stroke": style_of(index).colour, "data-robot": index}
        if covered:
            yield element("g", look, parts)


def _strip(leg: Leg, projection: Projection) -> str:
    points = list(leg.points)
    points[0] = _beyond(points[1], points[0], leg.reach)
    points[-1] = _beyond(points[-2], points[-1], leg.reach)
    return element(
        "path", {"d": f"M{_line(points, projection)}", "stroke_width": leg.width * projection.scale}
    )


def _beyond(before: Position, last: Position, reach: float) -> Position:
    whole = dist(before[:2], last[:2]) or 1.0
    part = reach / whole
    return last[0] + part * (last[0] - before[0]), last[1] + part * (last[1] - before[1]), last[2]


def _robot(index: int, robot: RobotPicture, projection: Projection) -> str:
    style = style_of(index)
    legs = (_leg(i, leg, robot, style, projection) for i, leg in enumerate(robot.legs))
    look = {"class": "robot", "data-robot": index, "stroke": style.colour, "color": style.colour}
    return element("g", look, legs, _arrows(robot, projection), _actions(robot, projection))


def _leg(index: int, leg: Leg, robot: RobotPicture, style: Style, projection: Projection) -> str:
    if len({projection.place(point) for point in leg.points}) < 2:
        return ""
    attributes = {
        "class": f"leg {leg.kind}",
        "d": f"M{_line(leg.points, projection)}",
        "stroke_dasharray": style.dashes or None,
        "data-leg": index,
    }
    return element("path", attributes, _title(leg_tip(robot.name, leg)))


def leg_tip(robot: str, leg: Leg) -> str:
    """Return what a leg is, for people: who, what for, when, at what height."""
    ups = [point[2] for point in leg.points]
    level = length(ups[0]) if max(ups) - min(ups) < 0.05 else f"{length(ups[0])} to {length(ups[-1])}"
    what = f"{_KINDS[leg.kind]} for {leg.task}" if leg.task else _KINDS[leg.kind]
    parts = (what, f"{clock(leg.begin)} to {clock(leg.end)}", f"up {level}", leg.moves, leg.note)
    return f"{robot}: " + ", ".join(part for part in parts if part)


def _arrows(robot: RobotPicture, projection: Projection) -> str:
    """Return small heads on long stretches that show which way the robot goes."""
    heads: list[str] = []
    since = _ARROW_EVERY / 2
    for leg in robot.legs:
        for start, end in pairwise(projection.place(point) for point in leg.points):
            since += dist(start, end)
            if since >= _ARROW_EVERY and dist(start, end) > 12:
                heads.append(_head(start, end))
                since = 0.0
    return element("g", {"class": "arrows"}, heads) if heads else ""


def _head(start: Point, end: Point) -> str:
    x, y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    angle = degrees(atan2(end[1] - start[1], end[0] - start[0]))
    place = f"translate({number(x)} {number(y)}) rotate({number(angle)})"
    return element("path", {"d": "M-4-4L5 0L-4 4Z", "transform": place})


def _actions(robot: RobotPicture, projection: Projection) -> str:
    placed = (projection.place(at) for leg in robot.legs for at in leg.actions)
    dots = "".join(f"M{number(x)} {number(y)}h0" for x, y in placed)
    if not dots:
        return ""
    rims = element("path", {"class": "actions", "d": dots})
    return rims + element("path", {"class": "actions inner", "d": dots})


def _home(index: int, robot: RobotPicture, projection: Projection) -> str:
    x, y = projection.place(robot.home)
    shape = f"M{number(x - 7)} {number(y + 7)}v-8l7-6l7 6v8Z"
    look = {"class": "home", "d": shape, "fill": style_of(index).colour, "data-robot": index}
    return element("path", look, _title(f"home of {robot.name} ({robot.type_name})"))


def _words(picture: Picture, projection: Projection) -> str:
    labels = Labels(projection.width)
    shown = shapely.box(projection.west, projection.south, projection.east, projection.north)
    for index, robot in enumerate(picture.robots):
        x, y = projection.place(robot.home)
        labels.put(robot.name, (x, y + 22), "name", colour=style_of(index).colour)
    for task in picture.tasks:
        at = _middle(task)
        if at is not None:
            x, y = projection.place(at)
            labels.put(task.name, (x, y - (10 if task.point else 0)), "of-task", tip=_task_tip(task))
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


def _grid(projection: Projection) -> Iterator[str]:
    step = projection.bar_length() / 2
    first, last = int(projection.west // step) + 1, int(projection.east // step)
    lower, upper = int(projection.south // step) + 1, int(projection.north // step)
    columns = (((i * step, projection.south), (i * step, projection.north)) for i in range(first, last + 1))
    rows = (((projection.west, i * step), (projection.east, i * step)) for i in range(lower, upper + 1))
    for ends in (*columns, *rows):
        yield element("path", {"d": f"M{_line(ends, projection)}"})


def _furniture(projection: Projection) -> Iterator[str]:
    metres = projection.bar_length()
    pixels = metres * projection.scale
    x, y = 18.0, projection.height - 18
    bar = f"M{number(x)} {number(y - 6)}v6h{number(pixels)}v-6"
    yield element("path", {"class": "scale", "d": bar})
    words = {"class": "label scale-words", "x": x + pixels / 2, "y": y - 8, "text_anchor": "middle"}
    yield element("text", words, text(f"{metres:g} m"))
    north = f"translate({number(projection.width - 26)} 34)"
    yield element(
        "g",
        {"class": "north", "transform": north},
        element("path", {"d": "M0-22L8 6L0 1L-8 6Z"}),
        element("text", {"class": "label", "y": 20, "text_anchor": "middle"}, "N"),
    )


def _defs() -> str:
    line = element("path", {"d": "M0 0V8", "stroke": "#b2182b", "stroke-width": 2})
    cross = element("path", {"d": "M0 5H10M5 0V10", "stroke": "#1b7837", "stroke-width": 1})
    common = {"patternUnits": "userSpaceOnUse"}
    return element(
        "defs",
        None,
        element(
            "pattern",
            {"id": "forbidden", "width": 8, "height": 8, "patternTransform": "rotate(45)", **common},
            line,
        ),
        element("pattern", {"id": "emergency", "width": 10, "height": 10, **common}, cross),
    )
