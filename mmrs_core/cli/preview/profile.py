"""Draws each robot's height over time, as SVG."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite

from mmrs_core.cli.preview.figures import length
from mmrs_core.cli.preview.markup import element, number, style_sheet, text
from mmrs_core.cli.preview.palette import style_of
from mmrs_core.cli.preview.picture import Picture, RobotPicture
from mmrs_core.cli.preview.time_axis import LEFT, RIGHT, WIDTH, TimeAxis

_HEIGHT = 150.0
_TOP = 14.0
_SMALLEST_RANGE = 4.0


def profile_markup(picture: Picture) -> str:
    """Return the height profiles of all robots in one chart as an ``svg`` element with its own style."""
    axis = TimeAxis(picture.makespan or 1.0)
    low, high = _range(picture)
    bottom = _TOP + _HEIGHT

    def y_of(up: float) -> float:
        return bottom - _HEIGHT * (up - low) / (high - low)

    children = (
        element("title", None, "heights"),
        element("style", None, style_sheet("charts.css")),
        axis.markup(_TOP, bottom),
        "".join(_level(up, y_of(up)) for up in _levels(low, high)),
        _surface(picture, low, high, y_of(picture.surface or 0.0)),
        "".join(_limits(index, robot, low, high, y_of) for index, robot in enumerate(picture.robots)),
        "".join(_profile(index, robot, axis, y_of) for index, robot in enumerate(picture.robots)),
    )
    height = bottom + 26
    attributes = {"xmlns": "http://www.w3.org/2000/svg", "class": "chart profile", "role": "img"}
    view = {"viewBox": f"0 0 {number(WIDTH)} {number(height)}", "width": WIDTH, "height": height}
    return element("svg", {**attributes, **view}, children)


def _range(picture: Picture) -> tuple[float, float]:
    ups = [up for robot in picture.robots for _, up in robot.heights] or [0.0]
    if picture.surface is not None:
        ups.append(picture.surface)
    low, high = min(ups), max(ups)
    margin = max(0.12 * (high - low), _SMALLEST_RANGE / 2)
    return low - margin, high + margin


def _levels(low: float, high: float) -> list[float]:
    wanted = (high - low) / 4
    step = next(step for step in _steps() if step >= wanted)
    first = int(low // step) + 1
    return [i * step for i in range(first, int(high // step) + 1)]


def _steps() -> list[float]:
    return [digit * 10.0**power for power in range(-1, 6) for digit in (1, 2, 5)]


def _level(up: float, y: float) -> str:
    line = element("line", {"x1": LEFT, "x2": WIDTH - RIGHT, "y1": y, "y2": y})
    words = element("text", {"x": LEFT - 10, "y": y + 4, "text_anchor": "end"}, text(length(up)))
    return element("g", {"class": "level"}, line, words)


def _surface(picture: Picture, low: float, high: float, y: float) -> str:
    if picture.surface is None or not low < picture.surface < high:
        return ""
    line = element("line", {"x1": LEFT, "x2": WIDTH - RIGHT, "y1": y, "y2": y})
    return element("g", {"class": "surface"}, line, element("title", None, "water surface"))


def _limits(index: int, robot: RobotPicture, low: float, high: float, y_of: Callable[[float], float]) -> str:
    lines = []
    for up, what in ((robot.floor, "floor"), (robot.ceiling, "ceiling")):
        if isfinite(up) and low < up < high:
            line = {"x1": LEFT, "x2": WIDTH - RIGHT, "y1": y_of(up), "y2": y_of(up)}
            title = element("title", None, text(f"{what} of {robot.name}: {length(up)}"))
            lines.append(element("line", {"class": "limit", **line}, title))
    return element("g", {"data-robot": index, "stroke": style_of(index).colour}, lines) if lines else ""


def _profile(index: int, robot: RobotPicture, axis: TimeAxis, y_of: Callable[[float], float]) -> str:
    if len(robot.heights) < 2:
        return ""
    style = style_of(index)
    ends = ((axis.at(time), y_of(up)) for time, up in robot.heights)
    way = "L".join(f"{number(x)} {number(y)}" for x, y in ends)
    line = {"d": f"M{way}", "stroke": style.colour, "stroke_dasharray": style.dashes or None}
    title = element("title", None, text(f"height of {robot.name}"))
    return element("g", {"class": "height", "data-robot": index}, element("path", line, title))
