"""Draws figures of one robot over time as SVG: its cross-track error, and its battery."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, isfinite, log10

import numpy as np
from markupsafe import Markup

from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.documents import number, render
from mmrs_core.pictures.preview.timeline import LEFT, RIGHT, WIDTH, TimeAxis

_HEIGHT = 92.0
_TOP = 10.0
_FOOT = 26.0
_MOST_COLUMNS = 1000
_LEAST_METRES = 0.5
_FULL = 1.05

Line = tuple[Floats, Floats]
"""Times and values; a chart may have several pieces, not joined."""


def cross_track_chart(pieces: Sequence[Line], end: float, colour: str) -> Markup:
    """Return a robot's cross-track error over time, metres; the largest of each stretch."""
    most = max((float(values.max()) for _, values in pieces), default=0.0)
    high = _round_above(max(most, _LEAST_METRES))
    levels = [(value, f"{value:g} m") for value in (0.0, high / 2, high)]
    lines = [("height", _line(_largest(piece, end), end, high)) for piece in pieces]
    return _chart("cross-track error in metres", end, levels, high, lines, colour)


def _round_above(value: float) -> float:
    """Return the next of 1, 2, 5, 10, 20 and so on, and of 0.5, 0.2, 0.1 and so on.

    >>> _round_above(0.38), _round_above(2.0), _round_above(61.0)
    (0.5, 2.0, 100.0)
    """
    ten = 10.0 ** floor(log10(value))
    return next(float(step * ten) for step in (1, 2, 5, 10) if step * ten >= value)


def battery_chart(flown: Line, planned: Line, reserve: float, end: float, colour: str) -> Markup:
    """Return a robot's battery level over time, with the plan and the reserve."""
    levels = [(value, f"{100 * value:.0f} %") for value in (0.0, 0.5, 1.0)]
    known = np.isfinite(flown[1])
    lines = [
        ("height planned", _line(planned, end, _FULL)),
        ("height", _line(_thin((flown[0][known], flown[1][known])), end, _FULL)),
    ]
    return _chart("battery", end, levels, _FULL, lines, colour, reserve)


def _chart(
    name: str,
    end: float,
    levels: Sequence[tuple[float, str]],
    high: float,
    lines: Sequence[tuple[str, str]],
    colour: str,
    limit: float | None = None,
) -> Markup:
    return render(
        "chart.svg",
        name=name,
        colour=colour,
        width=WIDTH,
        height=_TOP + _HEIGHT + _FOOT,
        left=LEFT,
        right=WIDTH - RIGHT,
        top=_TOP,
        bottom=_TOP + _HEIGHT,
        ticks=TimeAxis(end or 1.0).ticks(),
        levels=[(_at(value, high), words) for value, words in levels],
        limit=None if limit is None else _at(limit, high),
        lines=lines,
    )


def _at(value: float, high: float) -> float:
    return _TOP + _HEIGHT * (1 - min(max(value / high, 0.0), 1.0))


def _line(piece: Line, end: float, high: float) -> str:
    """Return the data of a path through the values that are finite; empty where there are none."""
    axis = TimeAxis(end or 1.0)
    pairs = zip(piece[0].tolist(), piece[1].tolist(), strict=True)
    placed = [(axis.at(min(time, end)), _at(value, high)) for time, value in pairs if isfinite(value)]
    if not placed:
        return ""
    if len(placed) == 1:
        placed.append((placed[0][0] + 0.5, placed[0][1]))
    return "M" + "L".join(f"{number(x)} {number(y)}" for x, y in placed)


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
