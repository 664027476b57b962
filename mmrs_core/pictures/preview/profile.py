"""Draws the height of each robot over time, with what it passes on the way, as SVG."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite

from mmrs_core.pictures.figures import heights, length
from mmrs_core.pictures.preview.crossings import Crossing, corners, crossings
from mmrs_core.pictures.preview.labels import shortened
from mmrs_core.pictures.preview.markup import element, number, style_sheet, text
from mmrs_core.pictures.preview.palette import style_of
from mmrs_core.pictures.preview.picture import Leg, Picture, RobotPicture
from mmrs_core.pictures.preview.time_axis import LEFT, RIGHT, WIDTH, TimeAxis

_ROW = 92.0
_GAP = 26.0
_TOP = 20.0
_SMALLEST_RANGE = 4.0
_NAMES = 40

BARS = "Grey and red bars: obstacles and forbidden areas on the way as seen from above, from foot to top."
BARS_OF_FLIGHTS = f"{BARS} Dashed grey: as planned."


@dataclass(frozen=True, slots=True)
class _Strip:
    """One robot's chart: its upper edge in pixels, and the heights that it shows in metres."""

    top: float
    low: float
    high: float

    @property
    def bottom(self) -> float:
        return self.top + _ROW

    def at(self, up: float) -> float:
        """Return the pixel of a height, kept inside the chart."""
        inside = min(max(up, self.low), self.high)
        return self.bottom - _ROW * (inside - self.low) / (self.high - self.low)


def profile_markup(picture: Picture) -> str:
    """Return the height profiles, one beneath the other, as an ``svg`` element with its own style."""
    axis = TimeAxis(picture.shown or 1.0)
    low, high = _range(picture)
    strips = [_Strip(_TOP + i * (_ROW + _GAP), low, high) for i in range(len(picture.robots))]
    bottom = strips[-1].bottom if strips else _TOP
    height = bottom + 26
    attributes = {"xmlns": "http://www.w3.org/2000/svg", "class": "chart profile", "role": "img"}
    view = {"viewBox": f"0 0 {number(WIDTH)} {number(height)}", "width": WIDTH, "height": height}
    return element(
        "svg",
        {**attributes, **view},
        element("title", None, "heights"),
        element("style", None, style_sheet("charts.css")),
        axis.markup(_TOP, bottom),
        (_chart(i, picture, axis, strip) for i, strip in enumerate(strips)),
    )


def _range(picture: Picture) -> tuple[float, float]:
    ups = [up for robot in picture.robots for _, up in (*robot.heights, *robot.planned_heights)] or [0.0]
    ups += [point[2] for robot in picture.robots for leg in robot.legs if leg.aside for point in leg.points]
    if picture.surface is not None:
        ups.append(picture.surface)
    low, high = min(ups), max(ups)
    margin = max(0.12 * (high - low), _SMALLEST_RANGE / 2)
    return low - margin, high + margin


def _chart(index: int, picture: Picture, axis: TimeAxis, strip: _Strip) -> str:
    robot = picture.robots[index]
    name = {"class": "robot-name", "x": LEFT, "y": strip.top - 5, "fill": style_of(index).colour}
    zones = [zone for zone in picture.zones if zone.types is None or robot.type_name in zone.types]
    passed = crossings(robot, zones)
    return element(
        "g",
        {"data-robot": index},
        (_level(up, strip) for up in _levels(strip)),
        (_passed(crossing, robot, axis, strip) for crossing in passed),
        _surface(picture, strip),
        _limits(robot, strip),
        _planned(robot, axis, strip),
        _line(index, robot, axis, strip),
        (_aside(leg, robot, axis, strip, style_of(index).colour) for leg in robot.legs if leg.aside),
        element("text", name, text(shortened(robot.name, _NAMES))),
    )


def _levels(strip: _Strip) -> Iterator[float]:
    wanted = (strip.high - strip.low) / 4
    steps = (digit * 10.0**power for power in range(-1, 6) for digit in (1, 2, 5))
    step = next(step for step in steps if step >= wanted)
    return (i * step for i in range(int(strip.low // step) + 1, int(strip.high // step) + 1))


def _level(up: float, strip: _Strip) -> str:
    y = strip.at(up)
    line = element("line", {"x1": LEFT, "x2": WIDTH - RIGHT, "y1": y, "y2": y})
    words = element("text", {"x": LEFT - 8, "y": y + 4, "text_anchor": "end"}, text(length(up)))
    return element("g", {"class": "level"}, line, words)


def _passed(crossing: Crossing, robot: RobotPicture, axis: TimeAxis, strip: _Strip) -> str:
    zone = crossing.zone
    left, right = axis.at(crossing.begin), axis.at(crossing.end)
    upper, lower = strip.at(zone.high), strip.at(zone.low)
    place = {"x": left, "y": upper, "width": max(right - left, 0.6), "height": lower - upper}
    tip = f"{robot.name} passes {zone.name} ({heights(zone.low, zone.high)})"
    look = {"class": f"passed {zone.use.value}", **place}
    return element("rect", look, element("title", None, text(tip))) if lower > upper else ""


def _surface(picture: Picture, strip: _Strip) -> str:
    if picture.surface is None:
        return ""
    y = strip.at(picture.surface)
    line = element("line", {"x1": LEFT, "x2": WIDTH - RIGHT, "y1": y, "y2": y})
    return element("g", {"class": "surface"}, line, element("title", None, "water surface"))


def _limits(robot: RobotPicture, strip: _Strip) -> Iterator[str]:
    for up, what in ((robot.floor, "floor"), (robot.ceiling, "ceiling")):
        if isfinite(up) and strip.low < up < strip.high:
            y = strip.at(up)
            line = {"class": "limit", "x1": LEFT, "x2": WIDTH - RIGHT, "y1": y, "y2": y}
            yield element("line", line, element("title", None, text(f"{what} of {robot.name}: {length(up)}")))


def _line(index: int, robot: RobotPicture, axis: TimeAxis, strip: _Strip) -> str:
    if len(robot.heights) < 2:
        return ""
    style = style_of(index)
    ends = ((axis.at(time), strip.at(up)) for time, up in robot.heights)
    way = "L".join(f"{number(x)} {number(y)}" for x, y in ends)
    dashes = {"stroke_dasharray": style.dashes or None}
    line = {"class": "height", "d": f"M{way}", "stroke": style.colour}
    return element("path", {**line, **dashes}, element("title", None, text(f"height of {robot.name}")))


def _planned(robot: RobotPicture, axis: TimeAxis, strip: _Strip) -> str:
    """Return the heights that a robot that has flown should have had."""
    inside = [(time, up) for time, up in robot.planned_heights if time <= axis.end]
    if len(inside) < 2:
        return ""
    way = "L".join(f"{number(axis.at(time))} {number(strip.at(up))}" for time, up in inside)
    look = {"class": "height planned", "d": f"M{way}"}
    return element("path", look, element("title", None, text(f"height of {robot.name} as planned")))


def _aside(leg: Leg, robot: RobotPicture, axis: TimeAxis, strip: _Strip, colour: str) -> str:
    """Return the heights on a way of a choice that is not the longest."""
    ends = ((axis.at(time), strip.at(up)) for time, (_, _, up) in corners(leg))
    way = "L".join(f"{number(x)} {number(y)}" for x, y in ends)
    line = {"class": "height aside", "d": f"M{way}", "stroke": colour}
    return element("path", line, element("title", None, text(f"height of {robot.name}, {leg.note}")))
