"""Where a robot stops along a stroke, and how its legs are expected to be flown, as missions or one by one.

A stroke on which the robot looks at one place begins and ends with a stop, so that this does not depend on
what comes before and after. Of others it is supposed that hops follow each other without a stop.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from math import dist

from mmrs_core.planning.corners import runs_between
from mmrs_core.planning.strokes import NEAR, commanded_speed, length_of, stops_of
from mmrs_core.planning.travel import Travel
from mmrs_core.scene import ActionAt, RobotType, Stroke
from mmrs_core.scene.passing import Passage, goes_straight, passed
from mmrs_core.scene.timing import Leg, Push, Rates


@dataclass(frozen=True, slots=True)
class FlownLegs:
    """How the legs of a stroke are expected to be flown.

    Attributes:
        mission: rates of a mission; None: there is none.
        legs: that are part of missions; others are commanded one by one.
        saved: by leg, the seconds that it takes less than from a stop to a stop, as it is passed where it
            ends. Of the last one of a mission less than none: its end is noticed late.
        gained: seconds that all of them take less than if each was commanded alone, from a stop to a stop.
        most: seconds that any part of the stroke takes less so, added up: however it is cut, no more.
    """

    mission: Rates | None = None
    legs: frozenset[int] = frozenset()
    saved: Sequence[float] = ()
    gained: float = 0.0
    most: float = 0.0


BESIDE = 2, 2
"""Legs before and after a stroke that may continue it without a stop where nothing is known of them: a
hop, and a leg of what is done beyond that."""

_NONE = FlownLegs()


def flown_legs(stroke: Stroke, travel: Travel) -> FlownLegs:
    """Return how a stroke is flown; where the robot looks at one place, as missions if that is quicker."""
    if travel.corners is None or len(stroke.points) == 1:
        return _NONE
    speed, legs = commanded_speed(stroke, travel.kinematics), list(pairwise(stops_of(stroke)))
    mission, alone = travel.kinematics.in_mission(), travel.bounds(speed)[1]
    keeps_to_legs, rates = mission.turning_radius <= 0.0, mission.rates(speed)
    saved = [0.0] * len(legs)
    for run in _between(halts_at_corners(replace(stroke, look=None), travel)):
        saved[run] = _saved_on(legs[run], alone, begins=False, keeps_to_legs=keeps_to_legs)
    seconds = [alone.from_stop_to_stop(*leg) - less for leg, less in zip(legs, saved, strict=True)]
    flown, quickest, halts = set[int](), list(seconds), halts_at_corners(stroke, travel)
    beside = BESIDE if stroke.look is None else (0, 0)
    for its, _ in runs_between(halts, beside) if travel.uploading is not None else ():
        run = slice(its.start, its.stop)
        less = [*_saved_on(legs[run], rates, begins=halts[its.start], keeps_to_legs=keeps_to_legs)]
        less[-1] -= rates.share * mission.noticing * halts[its.stop]
        uploaded = [rates.from_stop_to_stop(*leg) - each for leg, each in zip(legs[run], less, strict=True)]
        quickest[run] = map(min, uploaded, seconds[run])
        if stroke.look is None or sum(uploaded) < sum(seconds[run]):
            flown.update(its)
            saved[run], seconds[run] = less, uploaded
    plain = sum(alone.from_stop_to_stop(*leg) for leg in legs)
    return FlownLegs(rates, frozenset(flown), saved, plain - sum(seconds), plain - sum(quickest))


def _between(halts: Sequence[bool]) -> Iterator[slice]:
    """Yield the legs between one stop and the next."""
    stops = [0, *(i for i in range(1, len(halts) - 1) if halts[i]), len(halts) - 1]
    yield from (slice(*each) for each in pairwise(stops))


def _saved_on(legs: Sequence[Leg], rates: Rates, *, begins: bool, keeps_to_legs: bool) -> Iterator[float]:
    """Yield the seconds that each of some legs saves, here and on the next, where it ends without a stop.

    A robot that keeps to its legs stops where the path turns, and where a mission `begins` at the end of the
    first one.
    """
    before: Passage | None = None
    push: Push | None = None
    for i, leg in enumerate(legs):
        saved = rates.from_stop_to_stop(*leg) - rates.from_stop_to_stop(*leg, push=push)
        after = legs[i + 1] if i + 1 < len(legs) and rates.timing.passes else None
        if after is not None and (not keeps_to_legs or (i >= begins and goes_straight(*leg, after[1]))):
            before = passed(rates, leg, after, before, push=push)
            saved += before.saved + before.onward
        else:
            before = None
        push = rates.push(*leg, push)
        yield min(saved, rates.from_stop_to_stop(*leg))


def halts_at_corners(stroke: Stroke, travel: Travel) -> list[bool]:
    """Return at which of its places a robot stops for certain, corners that it may not cut included."""
    halts, speed = halts_of(stroke, travel.robot.type), commanded_speed(stroke, travel.kinematics)
    stops, corners = stops_of(stroke), travel.corners
    for i in range(1, len(halts) - 1):
        if not halts[i] and corners is not None:
            start, corner, end = stops[i - 1 : i + 2]
            halts[i] = not corners.may_pass(start, corner, end, speed)
    return halts


def halts_of(stroke: Stroke, type: RobotType) -> list[bool]:
    """Return at which of the places where a stroke stops or turns a robot stops for certain."""
    stops, look = stops_of(stroke), stroke.look
    if look is not None and (look.angle_degrees or not type.looks_ahead(look.device)):
        return [True] * len(stops)
    arcs = accumulate((dist(one, two) for one, two in pairwise(stops)), initial=0.0)
    halts = [bool(each) for each in due_at(stroke, arcs)]
    halts[0], halts[-1] = halts[0] or _stays(stroke), halts[-1] or not _passes(stroke)
    return halts


def passed_at_begin(stroke: Stroke) -> bool:
    """Return whether a robot need not stop where a stroke begins."""
    return not _stays(stroke) and not any(each.at <= NEAR for each in stroke.commands)


def passed_at_end(stroke: Stroke) -> bool:
    """Return whether a robot need not stop where a stroke ends."""
    length = length_of(stroke.points)
    return _passes(stroke) and not any(each.at >= length - NEAR for each in stroke.commands)


def _passes(stroke: Stroke) -> bool:
    return not _stays(stroke) and not stroke.hold and stroke.object is None


def _stays(stroke: Stroke) -> bool:
    """Return whether a robot stops at both ends of a stroke: it settles, or looks elsewhere beyond them."""
    return stroke.settles or stroke.look is not None


def due_at(stroke: Stroke, arcs: Iterable[float]) -> list[list[ActionAt]]:
    """Return the commands of a stroke by the places, as metres along it, at which they are done."""
    todo, found = deque(stroke.commands), []
    for arc in arcs:
        due = list[ActionAt]()
        while todo and todo[0].at <= arc + NEAR:
            due.append(todo.popleft())
        found.append(due)
    return found
