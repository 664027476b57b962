"""Stretches before and after strokes on which a robot turns around and gets up to speed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import dist

import shapely
from shapely.geometry.base import BaseGeometry

from mmrs_core.planning.lines import APART
from mmrs_core.planning.strips import SHAVED
from mmrs_core.scene import Position, Stroke


def turned_around(strokes: Iterable[Stroke], metres: float, closed: BaseGeometry) -> Iterator[Stroke]:
    """Yield strokes extended at both ends, where nothing is done, as far as that is clear.

    Args:
        strokes: those of one point or an upright end have no direction there and are not extended.
        metres: by which each end is extended at most; 0: not at all.
        closed: where the robot may not go, its edge excepted.
    """
    core = shapely.buffer(closed, -SHAVED) if metres > 0.0 else closed
    for stroke in strokes:
        yield _extended(stroke, metres, core) if metres > 0.0 and len(stroke.points) > 1 else stroke


def _extended(stroke: Stroke, metres: float, core: BaseGeometry) -> Stroke:
    points, each, (begin, end) = stroke.points, stroke.repetition, stroke.stretch
    first = _beyond(points[1], points[0], metres, core)
    last = _beyond(points[-2], points[-1], metres, core)
    lead = sum(dist(far, points[0]) for far in first)
    tail = sum(dist(far, points[-1]) for far in last)
    step = (end - begin) / stroke.length
    return replace(
        stroke,
        points=(*first, *points, *last),
        actions=tuple(replace(action, at=action.at + lead) for action in stroke.actions),
        cuts=tuple(cut + lead for cut in stroke.cuts),
        settles=True,
        stretch=(begin - lead * step, end + tail * step),
        repetition=None if each is None else replace(each, before=lead, after=tail),
    )


def _beyond(one: Position, end: Position, metres: float, core: BaseGeometry) -> tuple[Position, ...]:
    """Return where the continuation of a line ends, at the latest before what is closed; empty: at once."""
    if dist(one[:2], end[:2]) <= APART:
        return ()
    far = _on(one, end, metres)
    met = shapely.intersection(shapely.LineString([end[:2], far[:2]]), core)
    if not met.is_empty:
        far = _on(one, end, shapely.Point(end[:2]).distance(met))
    return (far,) if dist(end, far) > APART else ()


def _on(one: Position, end: Position, metres: float) -> Position:
    share = metres / dist(one[:2], end[:2])
    return (end[0] + share * (end[0] - one[0]), end[1] + share * (end[1] - one[1]), end[2])
