"""What can be done with a stroke: how long it takes, cutting it, turning it round."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from math import dist, inf
from operator import attrgetter

from mmrs_core.scene import ActionAt, Kinematics, Position, Robot, RobotType, Stroke
from mmrs_core.scene.timing import noticing

_SAME = 1e-9

_OF_A_WHOLE = attrgetter("look", "speed", "slow_down", "reversible")
"""What the parts of a stroke have in common."""

_REPEATED = attrgetter("every", "action", "device")

NEAR = 1e-6
"""Metres within which a robot is at the same place."""


def length_of(points: Iterable[Position]) -> float:
    """Return the metres along a polyline."""
    return sum(dist(one, two) for one, two in pairwise(points))


def commanded_speed(stroke: Stroke, kinematics: Kinematics) -> float:
    """Return the speed commanded on a stroke, metres per second.

    That is its cruise slowed down by the stroke's factor, or the largest speed that the stroke allows
    (inf: as fast as can be), within the robot's limits.
    """
    speed = kinematics.cruise * (1.0 if stroke.slow_down is None else stroke.slow_down)
    if stroke.speed is not None:
        speed = stroke.speed if stroke.slow_down is None else min(speed, stroke.speed)
    return min(max(speed, kinematics.slowest), kinematics.fastest)


def approach_speed(stroke: Stroke, kinematics: Kinematics) -> float | None:
    """Return the speed commanded on the route to a stroke, metres per second; None: the robot's cruise.

    A stroke of one point has no length: its speed is that at which the robot comes there.
    """
    limited = stroke.speed is not None or stroke.slow_down is not None
    if len(stroke.points) > 1 or not limited:
        return None
    speed = commanded_speed(stroke, kinematics)
    return None if abs(speed - kinematics.cruise) < _SAME else speed


def serve_seconds(stroke: Stroke, robot: Robot, kinematics: Kinematics) -> float:
    """Return how long a robot takes for a stroke from its first point, actions, hold and turn included.

    It stops at every vertex and wherever something is done. Where the robot must turn on the spot, half
    a circle is counted; where an object may be anywhere within a tolerance, the search there and back is.
    """
    rates = kinematics.rates(commanded_speed(stroke, kinematics))
    moving = sum(rates.from_stop_to_stop(one, two) for one, two in pairwise(stops_of(stroke)))
    acting = sum(action_seconds(robot.type, action) for action in stroke.commands)
    return moving + acting + stroke.hold + uncertain_seconds(stroke, kinematics)


def stops_of(stroke: Stroke) -> list[Position]:
    """Return where a robot stops along a stroke: its vertices, and the places of its actions."""
    stops = [stroke.points[0]]
    todo = [action.at for action in stroke.actions]
    done = 0.0
    for one, two in pairwise(stroke.points):
        length = dist(one, two)
        between = [at for at in todo if done + NEAR < at < done + length - NEAR]
        for at in dict.fromkeys(between):
            share = (at - done) / length
            stops.append(
                (
                    one[0] + share * (two[0] - one[0]),
                    one[1] + share * (two[1] - one[1]),
                    one[2] + share * (two[2] - one[2]),
                )
            )
        stops.append(two)
        done += length
    return stops


def uncertain_seconds(stroke: Stroke, kinematics: Kinematics) -> float:
    """Return how much quicker than estimated a stroke may be done: turns and searches take up to that."""
    stays = stroke.hold > 0 or len(stroke.points) == 1 or stroke.object is not None
    turning = _longest_turn(kinematics) if stroke.look is not None and stays else 0.0
    if stroke.object is None:
        return turning
    return turning + 2.0 * (stroke.object_tolerance or 0.0) / commanded_speed(stroke, kinematics)


def longest_end(stroke: Stroke, kinematics: Kinematics) -> float:
    """Return how long what a robot does at the last point of a stroke takes at most.

    That is to turn, to hold, and to search there and back; what it does before it is there is not counted.
    """
    stays = len(stroke.points) == 1 and stroke.object is None
    seconds = stroke.hold + (noticing(kinematics.timing) if stroke.hold > 0.0 or stays else 0.0)
    if stroke.look is not None and (
        stroke.hold > 0.0 or len(stroke.points) == 1 or stroke.object is not None
    ):
        seconds += kinematics.turning().longest if kinematics.turn_rate > 0 else inf
    if stroke.object is not None:
        slowest = min(commanded_speed(stroke, kinematics), kinematics.climb, kinematics.descent)
        away = stroke.object_tolerance or 0.0
        seconds += kinematics.timing.reporting + (2.0 * away / slowest if slowest > 0.0 else inf) * (
            away > 0.0
        )
    return seconds


def _longest_turn(kinematics: Kinematics) -> float:
    """Return how long a turn takes at most, less what the planner adds to everything."""
    return (
        kinematics.turning().longest / (1.0 + kinematics.timing.spread) if kinematics.turn_rate > 0 else inf
    )


def action_seconds(robot_type: RobotType, action: ActionAt) -> float:
    """Return how long a device action takes; 0 where no device of the type supports it."""
    devices = robot_type.devices
    named = [devices[action.device]] if action.device in devices else list(devices.values())
    found = [device.actions[action.action] for device in named if action.action in device.actions]
    return found[0].duration if found else 0.0


def missing_action(robot_type: RobotType, action: ActionAt) -> str | None:
    """Return why a robot type cannot do an action; None if it can."""
    devices = robot_type.devices
    if action.device:
        if action.device not in devices:
            return f"has no device '{action.device}'"
        if action.action not in devices[action.device].actions:
            return f"device '{action.device}' does not support action '{action.action}'"
        return None
    able = sorted(device.id for device in devices.values() if action.action in device.actions)
    if not able:
        return f"has no device for action '{action.action}'"
    if len(able) > 1:
        return f"has several devices for action '{action.action}' ({', '.join(able)}), and none is named"
    return None


def parts_of(stroke: Stroke) -> tuple[Stroke, ...]:
    """Return the stroke in parts, split at all its cuts."""
    stops = [0.0, *stroke.cuts, inf]
    return tuple(between(stroke, begin, end) for begin, end in pairwise(stops))


def between(stroke: Stroke, begin: float, end: float) -> Stroke:
    """Return the part of a stroke between two arc lengths, metres; inf: to its last point.

    Actions at a cut belong to the part that begins there. The hold and the object belong to the part
    with the last point.
    """
    whole = length_of(stroke.points)
    to_the_end = end >= whole - _SAME
    if begin <= 0.0 and to_the_end:
        return stroke
    actions = tuple(
        replace(action, at=max(0.0, action.at - begin))
        for action in stroke.actions
        if (action.at >= begin - _SAME or begin <= 0.0) and (action.at < end - _SAME or to_the_end)
    )
    each = stroke.repetition
    left = max(0.0, whole - end)
    return replace(
        stroke,
        points=_points_between(stroke.points, begin, min(end, whole)),
        actions=actions,
        cuts=tuple(cut - begin for cut in stroke.cuts if begin < cut < end),
        hold=stroke.hold if to_the_end else 0.0,
        object=stroke.object if to_the_end else None,
        repetition=each
        and replace(each, before=max(0.0, each.before - begin), after=max(0.0, each.after - left)),
    )


def _points_between(points: tuple[Position, ...], begin: float, end: float) -> tuple[Position, ...]:
    kept: list[Position] = [_at(points, begin)]
    done = 0.0
    for one, two in pairwise(points):
        done += dist(one, two)
        if begin + _SAME < done < end - _SAME:
            kept.append(two)
    return (*kept, _at(points, end))


def _at(points: tuple[Position, ...], where: float) -> Position:
    done = 0.0
    for one, two in pairwise(points):
        step = dist(one, two)
        if where <= done + step and step > 0.0:
            part = max(0.0, where - done) / step
            if part >= 1.0:
                return two
            return (
                one[0] + part * (two[0] - one[0]),
                one[1] + part * (two[1] - one[1]),
                one[2] + part * (two[2] - one[2]),
            )
        done += step
    return points[-1]


def can_turn(stroke: Stroke) -> bool:
    """Return whether a stroke may be done from its last point to its first."""
    return stroke.reversible and stroke.hold == 0.0 and stroke.object is None


def turned(stroke: Stroke) -> Stroke:
    """Return the stroke from its last point to its first."""
    whole, each = length_of(stroke.points), stroke.repetition
    return replace(
        stroke,
        repetition=each and replace(each, before=each.after, after=each.before),
        points=stroke.points[::-1],
        actions=tuple(replace(action, at=whole - action.at) for action in reversed(stroke.actions)),
        cuts=tuple(whole - cut for cut in reversed(stroke.cuts)),
    )


def joined(parts: Iterable[Stroke]) -> tuple[Stroke, ...]:
    """Return strokes with neighbouring parts of one stroke put together again."""
    strokes: list[Stroke] = []
    for part in parts:
        last = strokes[-1] if strokes else None
        if last is not None and continues(last, part):
            strokes[-1] = _put_together(last, part)
        else:
            strokes.append(part)
    return tuple(strokes)


def continues(one: Stroke, two: Stroke) -> bool:
    """Return whether one stroke continues another, so that both may be one."""
    if one.points[-1] != two.points[0] or not len(one.points) > 1 < len(two.points):
        return False
    a, b = one.repetition, two.repetition
    if a is not b and (a is None or b is None or _REPEATED(a) != _REPEATED(b)):
        return False
    if a is not None and b is not None and not a.after == b.before == 0.0:
        return False
    return one.hold == 0.0 and one.object is None and _OF_A_WHOLE(one) == _OF_A_WHOLE(two)


def _put_together(one: Stroke, two: Stroke) -> Stroke:
    done = length_of(one.points)
    bend = _is_bend(one.points[-2], one.points[-1], two.points[1])
    points = (*one.points, *two.points[1:]) if bend else (*one.points[:-1], *two.points[1:])
    each = two.repetition
    return replace(
        two,
        points=points,
        repetition=each and replace(each, before=one.repetition.before if one.repetition else 0.0),
        actions=(*one.actions, *(replace(action, at=action.at + done) for action in two.actions)),
        cuts=(*one.cuts, done, *(cut + done for cut in two.cuts)),
    )


def _is_bend(one: Position, middle: Position, two: Position) -> bool:
    return dist(one, middle) + dist(middle, two) > dist(one, two) + 1e-7
