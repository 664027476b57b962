"""The moves of a stroke: one for each place where it turns or something is done."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from math import dist

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.contributions.rules import MoveSpec, RobotKind
from mmrs_core.scene import ActionAt, Position, Stroke

SAME_PLACE = 1e-6


def moves_of(stroke: Stroke, kind: RobotKind, speed: float | None) -> tuple[MoveSpec, ...]:
    """Return the moves of a stroke for a robot that is at its first point.

    Actions at the first point come before the first movement; all others after the movement that
    ends where they are due; those at the last point after the hold there.

    Args:
        speed: commanded, metres per second; None: by the travel mode.
    """
    stops = list(_stops(stroke))
    specs: list[MoveSpec] = []
    (here, first), rest = stops[0], stops[1:]
    pending = first
    for place, actions in rest:
        (spec,) = kind.travel((here, place))
        specs.append(replace(spec, look=stroke.look, speed=speed, before=pending, after=actions))
        here, pending = place, ()
    return (*specs, *_at_the_end(stroke, here, pending, specs))


def _at_the_end(
    stroke: Stroke, here: Position, pending: tuple[ActionAt, ...], specs: list[MoveSpec]
) -> Iterator[MoveSpec]:
    """Yield turn, hold and approach at the last point; moves actions that are due after them there."""
    stays = stroke.hold > 0 or bool(pending) or (not specs and stroke.object is None)
    if stays or stroke.object is not None:
        due = pending or (specs[-1].after if specs else ())
        if not pending and specs:
            specs[-1] = replace(specs[-1], after=())
        ends = [_turn(stroke)] if stroke.look is not None else []
        if stays:
            ends.append(MoveSpec((BEHAVIOUR, "HoldPosition"), {"duration": stroke.hold}))
        if stroke.object is not None:
            ends.append(_approach(stroke, here))
        ends[-1] = replace(ends[-1], after=due)
        yield from ends


def _turn(stroke: Stroke) -> MoveSpec:
    return MoveSpec((BEHAVIOUR, "HeadTo"), look=stroke.look)


def _approach(stroke: Stroke, here: Position) -> MoveSpec:
    return MoveSpec(
        (BEHAVIOUR, "GoTo"),
        target=here,
        object=stroke.object,
        object_tolerance=stroke.object_tolerance,
        distance=stroke.object_distance,
        look=None,
    )


def _stops(stroke: Stroke) -> Iterator[tuple[Position, tuple[ActionAt, ...]]]:
    """Yield each vertex and each place of an action, in order, with the actions due there."""
    todo = list(stroke.actions)
    yield stroke.points[0], _due(todo, 0.0)
    travelled = 0.0
    for start, end in pairwise(stroke.points):
        length = dist(start, end)
        if length <= SAME_PLACE:
            continue
        while todo and todo[0].at < travelled + length - SAME_PLACE:
            part = (todo[0].at - travelled) / length
            place = tuple(a + part * (b - a) for a, b in zip(start, end, strict=True))
            yield (place[0], place[1], place[2]), _due(todo, todo[0].at)
        travelled += length
        yield end, _due(todo, travelled)


def _due(todo: list[ActionAt], at: float) -> tuple[ActionAt, ...]:
    due = []
    while todo and todo[0].at <= at + SAME_PLACE:
        due.append(todo.pop(0))
    return tuple(due)
