"""Draws what each robot does when, and which robot waits for which, as SVG."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import accumulate
from typing import NamedTuple

from markupsafe import Markup

from mmrs_core.pictures.documents import number, render
from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.palette import style_of
from mmrs_core.pictures.preview.labels import shortened, width_of
from mmrs_core.pictures.preview.picture import Arm, Bar, Handover, Picture, TaskPicture

LEFT = 172.0
RIGHT = 24.0
WIDTH = 1000.0
_STEPS = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 28800, 86400)
_MOST_MARKS = 12
_ROW = 40.0
_BAR = 22.0
_ARM_ROW = 18.0
_ARM_BAR = 12.0
_TASK_ROW = 22.0
_TASK_BAR = 12.0
_GAP = 16.0
_TOP = 8.0
_FOOT = 26.0
_NAMES = 22
_BULGE = 26.0
_BARS = {
    "launch": "takes off",
    "transit": "in transit",
    "work": "works",
    "recover": "lands",
    "wait": "waits",
    "hold": "holds",
    "recharge": "recharges",
    "choice": "chooses",
    "response": "off-plan response",
}

KEY = (
    "Tall: work; low: take-off, transit or landing; hatched: wait; framed: hold, recharge or choice. "
    "Arrows: which robot releases which; dashed: before the other waits."
)
KEY_OF_FLIGHTS = f"{KEY} Red stripes: off-plan response. Beneath, smaller: as planned."


@dataclass(frozen=True, slots=True)
class TimeAxis:
    """Time from 0 to `end` seconds, along the width of a chart."""

    end: float

    def at(self, seconds: float) -> float:
        """Return the pixel of a time."""
        return LEFT + (WIDTH - LEFT - RIGHT) * seconds / max(self.end, 1e-9)

    def marks(self) -> Iterator[float]:
        """Yield round times, at most about a dozen."""
        step = next((step for step in _STEPS if self.end / step <= _MOST_MARKS), self.end / _MOST_MARKS)
        count = int(self.end // step)
        return (i * step for i in range(count + 1))

    def ticks(self) -> list[tuple[float, str]]:
        """Return the pixel and the words of every mark."""
        return [(self.at(seconds), clock(seconds)) for seconds in self.marks()]


class BarShape(NamedTuple):
    """A bar of the timeline: its class in the style sheet, its place in pixels, and what it is."""

    kind: str
    x: float
    y: float
    width: float
    height: float
    tip: str


class Caption(NamedTuple):
    """Words, the middle of their base line in pixels, and what they stand for, for the pointer."""

    words: str
    x: float
    y: float
    tip: str = ""


@dataclass(frozen=True, slots=True)
class _Row:
    """A robot's row, or one of a branch beneath it, with its frame."""

    name: Caption
    bars: tuple[BarShape, ...]
    tasks: tuple[Caption, ...]
    frame: BarShape | None = None


@dataclass(frozen=True, slots=True)
class _TaskRow:
    """A task's row: a bar, or a mark where it has no duration; `part` is how much of it was done."""

    name: Caption
    icon: str
    colour: str
    bar: BarShape
    part: str = ""

    @property
    def is_mark(self) -> bool:
        """Return whether the bar is too short to be seen."""
        return self.bar.width < 1


def timeline_of(picture: Picture) -> Markup:
    """Return the timeline as one ``svg`` element."""
    axis = TimeAxis(picture.shown or 1.0)
    tasks = [task for task in picture.tasks if task.begin is not None and task.end is not None]
    start = _TOP + len(tasks) * _TASK_ROW + (_GAP if tasks else 0)
    sizes = (_ROW + len(robot.arms) * _ARM_ROW for robot in picture.robots)
    *tops, bottom = accumulate(sizes, initial=start)
    middles = {robot.name: top + _ROW / 2 for robot, top in zip(picture.robots, tops, strict=True)}
    return render(
        "timeline.svg",
        width=WIDTH,
        height=bottom + _FOOT,
        left=LEFT,
        top=_TOP,
        bottom=bottom,
        right=axis.at(axis.end),
        ticks=axis.ticks(),
        tasks=[_task_row(task, axis, _TOP + (i + 0.5) * _TASK_ROW) for i, task in enumerate(tasks)],
        robots=[
            (
                index,
                style_of(index),
                _row(robot.name, robot.name, robot.bars, axis, middles[robot.name], _BAR),
                [_arm(robot.name, arm, axis, middles[robot.name], i) for i, arm in enumerate(robot.arms)],
            )
            for index, robot in enumerate(picture.robots)
        ],
        arrows=[_arrow(handover, axis, middles) for handover in picture.handovers],
    )


def _task_row(task: TaskPicture, axis: TimeAxis, middle: float) -> _TaskRow:
    left, right = axis.at(task.begin or 0.0), axis.at(task.end or 0.0)
    part = "" if task.part >= 1.0 else f"{100 * task.part:.0f} %"
    tip = f"{task.tip}, done to {part}" if part else task.tip
    bar = BarShape("", left, middle - _TASK_BAR / 2, right - left, _TASK_BAR, tip)
    name = Caption(shortened(task.name, _NAMES), LEFT - 10, middle + 4)
    return _TaskRow(name, task.symbol.icon, task.symbol.colour, bar, part)


def _row(
    name: str, subject: str, bars: Iterable[Bar], axis: TimeAxis, middle: float, highest: float, tip: str = ""
) -> _Row:
    shown = tuple(bars)
    shapes = tuple(_bar(subject, bar, axis, middle, highest) for bar in shown)
    label = Caption(shortened(name, _NAMES), LEFT - 10, middle + 4, tip)
    return _Row(label, shapes, tuple(_task_names(shown, axis, middle)))


def _arm(robot: str, arm: Arm, axis: TimeAxis, above: float, index: int) -> _Row:
    """Return one branch of a choice: a row beneath its robot's, joined to the choice by a frame."""
    middle = above + _ROW / 2 + (index + 0.25) * _ARM_ROW
    tip = f"{robot} {arm.words}, {clock(arm.begin)} to {clock(arm.end)}"
    tip += " (planned for)" if arm.longest else ""
    left, right = axis.at(arm.begin), axis.at(arm.end)
    frame = BarShape("", left, middle - _ARM_ROW / 2, max(right - left, 0.8), _ARM_ROW, tip)
    row = _row(arm.words, f"{robot}, {arm.words},", arm.bars, axis, middle, _ARM_BAR, tip)
    name = row.name._replace(words="\u00b7 " * arm.level + row.name.words)
    return _Row(name, row.bars, row.tasks, frame)


def _bar(robot: str, bar: Bar, axis: TimeAxis, middle: float, highest: float) -> BarShape:
    left, right = axis.at(bar.begin), axis.at(bar.end)
    height = highest if bar.kind in ("work", "choice") else highest * 0.55
    width = max(right - left, 0.8)
    return BarShape(bar.kind, left, middle - height / 2, width, height, bar_tip(robot, bar))


def bar_tip(robot: str, bar: Bar) -> str:
    """Return what a robot does in a bar, and when."""
    what = f"{_BARS[bar.kind]} for {bar.task}" if bar.task else _BARS[bar.kind]
    parts = (what, f"{clock(bar.begin)} to {clock(bar.end)}", bar.note)
    return f"{robot} " + ", ".join(part for part in parts if part)


def stretches(bars: Iterable[Bar]) -> Iterator[tuple[str, float, float]]:
    """Yield (task, begin, end) of each stretch of bars that serves one task without a longer stop."""
    task, begin, end = "", 0.0, 0.0
    for bar in bars:
        if bar.kind in ("recharge", "wait", "choice", "response") and task:
            yield task, begin, end
            task = ""
        if bar.kind != "work":
            continue
        if bar.task == task:
            end = bar.end
            continue
        if task:
            yield task, begin, end
        task, begin, end = bar.task, bar.begin, bar.end
    if task:
        yield task, begin, end


def _task_names(bars: Iterable[Bar], axis: TimeAxis, middle: float) -> Iterator[Caption]:
    """Yield the names of tasks over the stretches that are wide enough for them."""
    for task, begin, end in stretches(bars):
        left, right = axis.at(begin), axis.at(end)
        fitting = int((right - left - 6) / width_of("m", 11.0))
        if fitting >= 4:
            yield Caption(shortened(task, fitting), (left + right) / 2, middle + 4)


def _arrow(handover: Handover, axis: TimeAxis, rows: dict[str, float]) -> tuple[str, str, str]:
    """Return the class, the data and the meaning of the arrow of a handover."""
    x = axis.at(handover.sent)
    y1, y2 = rows[handover.sender], rows[handover.receiver]
    direction = 1 if y2 > y1 else -1
    start, end = y1 + direction * _BAR / 2, y2 - direction * _BAR / 2
    bulge = 0.0 if abs(y2 - y1) <= _ROW else _BULGE
    middle = f"{number(x + bulge)} {number((start + end) / 2)}"
    curve = f"M{number(x)} {number(start)}Q{middle} {number(x)} {number(end)}"
    words = f"{handover.sender} releases {handover.receiver} at {clock(handover.sent)}"
    tip = f"{words}: {handover.note} has ended" if handover.note else words
    return "handover" if handover.released > handover.since else "handover early", curve, tip
