"""Draws who does what when, and who waits for whom, as SVG."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import accumulate

from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.preview.labels import shortened, width_of
from mmrs_core.pictures.preview.map_places import task_tip
from mmrs_core.pictures.preview.markup import element, number, style_sheet, text
from mmrs_core.pictures.preview.palette import style_of
from mmrs_core.pictures.preview.picture import Arm, Bar, Handover, Picture, RobotPicture, TaskPicture
from mmrs_core.pictures.preview.time_axis import LEFT, WIDTH, TimeAxis

_ROW = 40.0
_BAR = 22.0
_ARM_ROW = 18.0
_ARM_BAR = 12.0
_TASK_ROW = 22.0
_TASK_BAR = 12.0
_GAP = 16.0
_TOP = 8.0
_NAMES = 22
_BULGE = 26.0
_WHATS = {
    "launch": "takes off",
    "transit": "travels",
    "work": "works",
    "recover": "lands",
    "wait": "waits",
    "hold": "holds",
    "recharge": "recharges",
    "choice": "chooses",
    "response": "does what no move says",
}

KEY = (
    "Tall: works; low: takes off, travels or lands; hatched: waits; framed: stays, recharges or chooses. "
    "Arrows: who lets whom go on; dashed: before anybody waits."
)
KEY_OF_FLIGHTS = f"{KEY} Red stripes: does what no move says. Beneath, smaller: as planned."


def timeline_markup(picture: Picture) -> str:
    """Return the timeline as one ``svg`` element with its own style, readable by itself."""
    axis = TimeAxis(picture.shown or 1.0)
    tasks = [task for task in picture.tasks if task.begin is not None and task.end is not None]
    start = _TOP + len(tasks) * _TASK_ROW + (_GAP if tasks else 0)
    heights = (_ROW + len(robot.arms) * _ARM_ROW for robot in picture.robots)
    *tops, bottom = accumulate(heights, initial=start)
    rows = {robot.name: top + _ROW / 2 for robot, top in zip(picture.robots, tops, strict=True)}
    height = bottom + 26
    children = (
        element("title", None, "timeline"),
        element("style", None, style_sheet("charts.css")),
        _defs(),
        axis.markup(_TOP, bottom),
        "".join(_task_row(task, axis, _TOP + (i + 0.5) * _TASK_ROW) for i, task in enumerate(tasks)),
        "".join(_row(i, robot, axis, rows[robot.name]) for i, robot in enumerate(picture.robots)),
        "".join(_arrow(handover, axis, rows) for handover in picture.handovers),
    )
    attributes = {"xmlns": "http://www.w3.org/2000/svg", "class": "chart timeline", "role": "img"}
    view = {"viewBox": f"0 0 {number(WIDTH)} {number(height)}", "width": WIDTH, "height": height}
    return element("svg", {**attributes, **view}, children)


def _task_row(task: TaskPicture, axis: TimeAxis, middle: float) -> str:
    begin, end = task.begin or 0.0, task.end or 0.0
    name = {"class": "task-name", "x": LEFT - 10, "y": middle + 4, "text_anchor": "end"}
    sign = element("tspan", {"class": "icon", "fill": task.symbol.colour}, text(task.symbol.icon + "\u00a0"))
    words = element("text", name, sign if task.symbol.icon else "", text(shortened(task.name, _NAMES)))
    partly = "" if task.part >= 1.0 else f", done to {100 * task.part:.0f} %"
    title = element("title", None, text(task_tip(task) + partly))
    colour = {"fill": task.symbol.colour}
    left, right = axis.at(begin), axis.at(end)
    if right - left < 1:
        diamond = f"M{number(left)} {number(middle - 6)}l6 6l-6 6l-6-6Z"
        return words + element("path", {"class": "task-mark", "d": diamond, **colour}, title)
    bar = {"x": left, "y": middle - _TASK_BAR / 2, "width": right - left, "height": _TASK_BAR, "rx": 3}
    if not partly:
        return words + element("rect", {"class": "task-bar", **bar, **colour}, title)
    look = {"class": "task-bar partly", "stroke": task.symbol.colour}
    beside = {"class": "task-name", "x": min(right + 6, WIDTH - 34), "y": middle + 4}
    told = element("text", beside, text(f"{100 * task.part:.0f} %"))
    return words + element("rect", {**look, **bar, **colour}, title) + told


def _row(index: int, robot: RobotPicture, axis: TimeAxis, middle: float) -> str:
    colour = style_of(index).colour
    name = {"class": "robot-name", "x": LEFT - 10, "y": middle + 4, "text_anchor": "end", "fill": colour}
    bars = (_bar(robot.name, bar, axis, middle, _BAR) for bar in robot.bars)
    base = element("line", {"class": "row", "x1": LEFT, "x2": axis.at(axis.end), "y1": middle, "y2": middle})
    words = element("text", name, text(shortened(robot.name, _NAMES)))
    return element(
        "g",
        {"class": "robot", "data-robot": index, "color": colour},
        words,
        base,
        bars,
        task_words(robot.bars, axis, middle),
        (_arm(robot.name, arm, axis, middle + _ROW / 2, i) for i, arm in enumerate(robot.arms)),
    )


def _arm(robot: str, arm: Arm, axis: TimeAxis, below: float, index: int) -> str:
    """Return one way of a choice: a row of its own beneath its robot's, joined to the choice by a frame."""
    middle = below + (index + 0.5) * _ARM_ROW - _ARM_ROW / 4
    left, right = axis.at(arm.begin), axis.at(arm.end)
    name = {"class": "arm-name", "x": LEFT - 10, "y": middle + 4, "text_anchor": "end"}
    lead = "\u00b7 " * arm.level
    tip = f"{robot} {arm.words}, {clock(arm.begin)} to {clock(arm.end)}"
    tip += " (planned for)" if arm.longest else ""
    top, bottom = middle - _ARM_ROW / 2, middle + _ARM_ROW / 2
    frame = {"x": left, "y": top, "width": max(right - left, 0.8), "height": bottom - top}
    return element(
        "g",
        {"class": "arm"},
        element("text", name, text(lead + shortened(arm.words, _NAMES)), element("title", None, text(tip))),
        element("rect", {"class": "arm-frame", **frame}, element("title", None, text(tip))),
        (_bar(f"{robot}, {arm.words},", bar, axis, middle, _ARM_BAR) for bar in arm.bars),
        task_words(arm.bars, axis, middle),
    )


def _bar(robot: str, bar: Bar, axis: TimeAxis, middle: float, highest: float) -> str:
    left, right = axis.at(bar.begin), axis.at(bar.end)
    height = highest if bar.kind in ("work", "choice") else highest * 0.55
    place = {"x": left, "y": middle - height / 2, "width": max(right - left, 0.8), "height": height}
    return element(
        "rect", {"class": f"bar {bar.kind}", **place}, element("title", None, text(bar_tip(robot, bar)))
    )


def bar_tip(robot: str, bar: Bar) -> str:
    """Return what a bar is, for people."""
    what = f"{_WHATS[bar.kind]} for {bar.task}" if bar.task else _WHATS[bar.kind]
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


def task_words(bars: Iterable[Bar], axis: TimeAxis, middle: float) -> Iterator[str]:
    """Yield the names of tasks over the stretches that are wide enough for them."""
    for task, begin, end in stretches(bars):
        left, right = axis.at(begin), axis.at(end)
        fitting = int((right - left - 6) / width_of("m", 11.0))
        if fitting >= 4:
            place = {"class": "bar-words", "x": (left + right) / 2, "y": middle + 4, "text_anchor": "middle"}
            yield element("text", place, text(shortened(task, fitting)))


def _arrow(handover: Handover, axis: TimeAxis, rows: dict[str, float]) -> str:
    x = axis.at(handover.sent)
    y1, y2 = rows[handover.sender], rows[handover.receiver]
    way = 1 if y2 > y1 else -1
    start, end = y1 + way * _BAR / 2, y2 - way * _BAR / 2
    bulge = 0.0 if abs(y2 - y1) <= _ROW else _BULGE
    middle = f"{number(x + bulge)} {number((start + end) / 2)}"
    curve = f"M{number(x)} {number(start)}Q{middle} {number(x)} {number(end)}"
    words = f"{handover.sender} tells {handover.receiver} at {clock(handover.sent)}"
    tip = f"{words}: {handover.note} has ended" if handover.note else words
    kind = "handover" if handover.released > handover.since else "handover early"
    arrow = {"class": kind, "d": curve, "marker-end": "url(#arrow)"}
    return element("path", arrow, element("title", None, text(tip)))


def _defs() -> str:
    head = element("path", {"d": "M0 0L8 4L0 8Z", "fill": "#222"})
    size = {"markerWidth": 8, "markerHeight": 8, "refX": 7, "refY": 4, "orient": "auto"}
    hatch = element("path", {"d": "M0 0V6", "stroke": "#777", "stroke-width": 2})
    common = {"width": 6, "height": 6, "patternUnits": "userSpaceOnUse", "patternTransform": "rotate(45)"}
    stripes = element("path", {"d": "M0 0V6", "stroke": "#b2182b", "stroke-width": 7})
    return element(
        "defs",
        None,
        element("marker", {"id": "arrow", **size}, head),
        element("pattern", {"id": "waiting", **common}, hatch),
        element("pattern", {"id": "responding", **common}, stripes),
    )
