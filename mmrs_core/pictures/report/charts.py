"""Draws figures of one robot over time as SVG: how far off it was, and how full its battery."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import floor, isfinite, log10

import numpy as np

from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.preview.markup import element, number, style_sheet, text
from mmrs_core.pictures.preview.time_axis import LEFT, RIGHT, WIDTH, TimeAxis

_HEIGHT = 92.0
_TOP = 10.0
_FOOT = 26.0
_MOST_COLUMNS = 1000
_LEAST_METRES = 0.5

Line = tuple[Floats, Floats]
"""Times and values; a chart may have several pieces, not joined."""


def off_way_chart(pieces: Sequence[Line], end: float, colour: str) -> str:
    """Return how far a robot was from its planned way over time, metres; the largest of each stretch."""
    most = max((float(values.max()) for _, values in pieces), default=0.0)
    high = _round_above(max(most, _LEAST_METRES))
    thin = [_largest(piece, end) for piece in pieces]
    levels = [(value, f"{value:g} m") for value in (0.0, high / 2, high)]
    lines = (_line(piece, end, high, {"class": "height", "stroke": colour}) for piece in thin)
    return _chart("metres from the planned way", end, levels, high, lines)


def _round_above(value: float) -> float:
    """Return the next of 1, 2, 5, 10, 20 and so on, and of 0.5, 0.2, 0.1 and so on.

    >>> _round_above(0.38), _round_above(2.0), _round_above(61.0)
    (0.5, 2.0, 100.0)
    """
    ten = 10.0 ** floor(log10(value))
    return next(float(step * ten) for step in (1, 2, 5, 10) if step * ten >= value)


def battery_chart(flown: Line, planned: Line, reserve: float, end: float, colour: str) -> str:
    """Return how full a robot's battery was over time, with the plan and the reserve."""
    levels = [(value, f"{100 * value:.0f} %") for value in (0.0, 0.5, 1.0)]
    y = _at(reserve, 1.05)
    limit = element("line", {"class": "reserve", "x1": LEFT, "x2": WIDTH - RIGHT, "y1": y, "y2": y})
    known = np.isfinite(flown[1])
    lines = (
        limit,
        _line(planned, end, 1.05, {"class": "height planned"}),
        _line(_thin((flown[0][known], flown[1][known])), end, 1.05, {"class": "height", "stroke": colour}),
    )
    return _chart("battery", end, levels, 1.05, lines)


def _chart(
    name: str,
    end: float,
    levels: Sequence[tuple[float, str]],
    high: float,
    lines: Iterator[str] | tuple[str, ...],
) -> str:
    height = _TOP + _HEIGHT + _FOOT
    attributes = {"xmlns": "http://www.w3.org/2000/svg", "class": "chart", "role": "img", "aria-label": name}
    view = {"viewBox": f"0 0 {number(WIDTH)} {number(height)}", "width": WIDTH, "height": height}
    return element(
        "svg",
        {**attributes, **view},
        element("title", None, text(name)),
        element("style", None, style_sheet("charts.css")),
        TimeAxis(end or 1.0).markup(_TOP, _TOP + _HEIGHT),
        (_level(value, words, high) for value, words in levels),
        lines,
    )


def _level(value: float, words: str, high: float) -> str:
    y = _at(value, high)
    line = element("line", {"x1": LEFT, "x2": WIDTH - RIGHT, "y1": y, "y2": y})
    label = element("text", {"x": LEFT - 8, "y": y + 4, "text_anchor": "end"}, text(words))
    return element("g", {"class": "level"}, line, label)


def _at(value: float, high: float) -> float:
    return _TOP + _HEIGHT * (1 - min(max(value / high, 0.0), 1.0))


def _line(piece: Line, end: float, high: float, look: dict[str, object]) -> str:
    axis = TimeAxis(end or 1.0)
    pairs = zip(piece[0].tolist(), piece[1].tolist(), strict=True)
    placed = [(axis.at(min(time, end)), _at(value, high)) for time, value in pairs if isfinite(value)]
    if not placed:
        return ""
    if len(placed) == 1:
        placed.append((placed[0][0] + 0.5, placed[0][1]))
    way = "L".join(f"{number(x)} {number(y)}" for x, y in placed)
    return element("path", {**look, "d": f"M{way}"})


def _largest(piece: Line, end: float) -> Line:
    """Return the largest value of each stretch of time as wide as a pixel."""
    times, values = piece
    if len(times) < 2:
        return piece
    columns = (times / max(end, 1e-9) * _MOST_COLUMNS).astype(int)
    starts = np.flatnonzero(np.r_[True, np.diff(columns) > 0])
    return times[starts], np.maximum.reduceat(values, starts)


def _thin(piece: Line) -> Line:
    times, values = piece
    step = max(len(times) // _MOST_COLUMNS, 1)
    chosen = np.unique(np.r_[0 : len(times) : step, len(times) - 1]) if len(times) else np.empty(0, dtype=int)
    return times[chosen], values[chosen]
