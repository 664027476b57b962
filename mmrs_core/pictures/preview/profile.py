"""Draws the altitude of each robot over time, with what it passes, as SVG."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import isfinite

from markupsafe import Markup

from mmrs_core.pictures.documents import number, render
from mmrs_core.pictures.figures import heights, length
from mmrs_core.pictures.palette import style_of
from mmrs_core.pictures.preview.crossings import Crossing, corners, crossings
from mmrs_core.pictures.preview.labels import shortened
from mmrs_core.pictures.preview.picture import Picture, RobotPicture
from mmrs_core.pictures.preview.timeline import LEFT, RIGHT, WIDTH, BarShape, TimeAxis

_ROW = 92.0
_GAP = 26.0
_TOP = 20.0
_FOOT = 26.0
_SMALLEST_RANGE = 4.0
_NAMES = 40

BARS = "Grey and red bars: obstacles and forbidden areas above or beneath which a robot passes, to scale."
BARS_OF_FLIGHTS = f"{BARS} Dashed grey: as planned."


@dataclass(frozen=True, slots=True)
class _Strip:
    """One robot's chart: its upper edge in pixels, and the altitudes that it shows in metres."""

    axis: TimeAxis
    top: float
    low: float
    high: float

    @property
    def bottom(self) -> float:
        return self.top + _ROW

    def at(self, up: float) -> float:
        """Return the pixel of an altitude, kept inside the chart."""
        inside = min(max(up, self.low), self.high)
        return self.bottom - _ROW * (inside - self.low) / (self.high - self.low)

    def line(self, profile: Iterable[tuple[float, float]]) -> str:
        """Return (time, altitude) pairs as the data of a path; empty for fewer than two."""
        placed = [f"{number(self.axis.at(time))} {number(self.at(up))}" for time, up in profile]
        return f"M{'L'.join(placed)}" if len(placed) > 1 else ""

    def levels(self) -> list[tuple[float, str]]:
        """Return the pixels and the words of round altitudes."""
        wanted = (self.high - self.low) / 4
        steps = (digit * 10.0**power for power in range(-1, 6) for digit in (1, 2, 5))
        step = next(step for step in steps if step >= wanted)
        rounds = (i * step for i in range(int(self.low // step) + 1, int(self.high // step) + 1))
        return [(self.at(up), length(up)) for up in rounds]


def profile_of(picture: Picture) -> Markup:
    """Return the altitude profiles, one beneath the other, as one ``svg`` element."""
    axis = TimeAxis(picture.shown or 1.0)
    low, high = _range(picture)
    strips = [_Strip(axis, _TOP + i * (_ROW + _GAP), low, high) for i in range(len(picture.robots))]
    bottom = strips[-1].bottom if strips else _TOP
    return render(
        "profile.svg",
        width=WIDTH,
        height=bottom + _FOOT,
        left=LEFT,
        right=WIDTH - RIGHT,
        top=_TOP,
        bottom=bottom,
        ticks=axis.ticks(),
        charts=[_chart(i, picture, strip) for i, strip in enumerate(strips)],
    )


def _range(picture: Picture) -> tuple[float, float]:
    ups = [up for robot in picture.robots for _, up in (*robot.heights, *robot.planned_heights)] or [0.0]
    ups += [point[2] for robot in picture.robots for leg in robot.legs if leg.aside for point in leg.points]
    if picture.surface is not None:
        ups.append(picture.surface)
    low, high = min(ups), max(ups)
    margin = max(0.12 * (high - low), _SMALLEST_RANGE / 2)
    return low - margin, high + margin


def _chart(index: int, picture: Picture, strip: _Strip) -> dict[str, object]:
    robot = picture.robots[index]
    zones = [zone for zone in picture.zones if zone.types is None or robot.type_name in zone.types]
    planned = [(time, up) for time, up in robot.planned_heights if time <= strip.axis.end]
    return {
        "index": index,
        "style": style_of(index),
        "name": robot.name,
        "title": shortened(robot.name, _NAMES),
        "y": strip.top - 5,
        "levels": strip.levels(),
        "passed": [*_passed(crossings(robot, zones), robot, strip)],
        "surface": None if picture.surface is None else strip.at(picture.surface),
        "limits": [*_limits(robot, strip)],
        "planned": strip.line(planned),
        "line": strip.line(robot.heights),
        "aside": [
            (strip.line((time, up) for time, (_, _, up) in corners(leg)), leg.note)
            for leg in robot.legs
            if leg.aside
        ],
    }


def _passed(found: Iterable[Crossing], robot: RobotPicture, strip: _Strip) -> Iterator[BarShape]:
    for crossing in found:
        zone = crossing.zone
        left, right = strip.axis.at(crossing.begin), strip.axis.at(crossing.end)
        upper, lower = strip.at(zone.high), strip.at(zone.low)
        if lower > upper:
            tip = f"{robot.name} passes {zone.name} ({heights(zone.low, zone.high)})"
            yield BarShape(zone.use.value, left, upper, max(right - left, 0.6), lower - upper, tip)


def _limits(robot: RobotPicture, strip: _Strip) -> Iterator[tuple[float, str]]:
    for up, what in ((robot.floor, "floor"), (robot.ceiling, "ceiling")):
        if isfinite(up) and strip.low < up < strip.high:
            yield strip.at(up), f"{what} of {robot.name}: {length(up)}"
