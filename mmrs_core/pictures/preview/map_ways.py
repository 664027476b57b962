"""Draws what robots do on the map: their ways, the ground that they cover, where they act."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import atan2, degrees, dist

from mmrs_core.pictures.figures import clock, length
from mmrs_core.pictures.preview.markup import element, number, title
from mmrs_core.pictures.preview.palette import Style, style_of
from mmrs_core.pictures.preview.picture import Leg, Picture, RobotPicture
from mmrs_core.pictures.preview.projection import Projection
from mmrs_core.scene import Point

_ARROW_EVERY = 90.0
_KINDS = {
    "launch": "take-off",
    "transit": "transit",
    "work": "work",
    "hold": "hold",
    "recover": "landing",
    "response": "not planned",
}
_MARKS = {
    "photo": "M-3-2H3V2H-3Z",
    "missing": "M-4-3H4V3H-4ZM-4-3L4 3",
    "fault": "M-6-6L6 6M6-6L-6 6",
}
STAYING = ("work", "hold")
"""The kinds of legs whose stays are marked."""
STAY = 5.5
"""Radius of the mark of a stay, pixels."""


def coverage(picture: Picture, projection: Projection, first: int = 0) -> Iterator[str]:
    """Yield the ground that each robot covers, each as one shape; styles begin with the first's index."""
    for index, robot in enumerate(picture.robots, start=first):
        rings = [ring for leg in robot.legs for ring in leg.covered]
        look = {"class": "covered", "fill": style_of(index).colour, "data-robot": index}
        if rings:
            yield element("path", {**look, "d": projection.closed(rings)})


def planned_way(index: int, robot: RobotPicture, projection: Projection) -> str:
    """Return where a robot that has flown should have, beneath where it did; empty where nobody knows."""
    lines = " ".join(f"M{projection.line(way)}" for way in robot.planned)
    if not lines:
        return ""
    look = {"class": "planned", "d": lines, "stroke": style_of(index).colour, "data-robot": index}
    return element("path", look, title(f"{robot.name}: as planned"))


def marks_of(index: int, robot: RobotPicture, projection: Projection) -> Iterator[str]:
    """Yield the marks of what happened on the way."""
    for mark in robot.marks:
        x, y = projection.place(mark.at)
        look = {"class": f"mark {mark.kind}", "transform": f"translate({number(x)} {number(y)})"}
        shape = element("path", {"d": _MARKS[mark.kind], "stroke": style_of(index).colour})
        yield element("g", {**look, "data-robot": index}, shape, title(f"{robot.name}: {mark.tip}"))


def robot_way(index: int, robot: RobotPicture, projection: Projection) -> str:
    """Return the way of a robot, with heads that show which way it goes and dots where it acts."""
    style = style_of(index)
    legs = (_leg(i, leg, robot, style, projection) for i, leg in enumerate(robot.legs))
    look = {"class": "robot", "data-robot": index, "stroke": style.colour, "color": style.colour}
    marks = _stays(robot, projection), _arrows(robot, projection), _actions(robot, projection)
    return element("g", look, legs, *marks)


def _leg(index: int, leg: Leg, robot: RobotPicture, style: Style, projection: Projection) -> str:
    if len({projection.place(point) for point in leg.points}) < 2:
        return ""
    attributes = {
        "class": f"leg {leg.kind}",
        "d": f"M{projection.line(leg.points)}",
        "stroke_dasharray": style.dashes or None,
        "data-leg": index,
    }
    return element("path", attributes, title(leg_tip(robot.name, leg)))


def _stays(robot: RobotPicture, projection: Projection) -> Iterator[str]:
    """Yield a mark for each place at which the robot stays, which tells of all its stays there."""
    tips: dict[Point, list[str]] = {}
    for leg in robot.legs:
        if leg.kind in STAYING and len({projection.place(point) for point in leg.points}) < 2:
            x, y = projection.place(leg.points[0])
            tips.setdefault((round(x, 1), round(y, 1)), []).append(leg_tip(robot.name, leg))
    for (x, y), told in tips.items():
        look = {"class": "stay", "cx": x, "cy": y, "r": STAY}
        yield element("circle", look, title("\n".join(told)))


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


def home(index: int, robot: RobotPicture, projection: Projection) -> str:
    """Return the mark of a home."""
    x, y = projection.place(robot.home)
    shape = f"M{number(x - 7)} {number(y + 7)}v-8l7-6l7 6v8Z"
    kind = f"{robot.type_name}, {robot.symbol.label}" if robot.symbol else robot.type_name
    look = {"class": "home", "d": shape, "fill": style_of(index).colour, "data-robot": index}
    return element("path", look, title(f"home of {robot.name} ({kind})"))
