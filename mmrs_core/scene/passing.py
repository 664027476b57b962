"""What a robot saves that passes the end of a leg, rather than stop there.

Autopilots begin the next leg while they still brake on the last one, as far as the corner's radius allows, or
slow down for the corner and turn within that radius.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import asin, degrees, dist, inf, radians, tan
from typing import NamedTuple, TypeAlias

from mmrs_core.scene.headings import turn_at
from mmrs_core.scene.primitives import Position
from mmrs_core.scene.timing import Leg, Push, Rates, moved
from mmrs_runtime.s_curves import Curve, covering, curve, turning
from mmrs_runtime.timing import LegTiming, half_turn

STRAIGHT = 0.005
"""Half the sine of turns, about half a degree, up to which a corner is none."""

NEARLY_BACK = radians(89.0)
"""Half of a turn up to which a robot comes nearer to its next place by that."""

STRAIGHT_DEGREES = 10.0
"""Up to where a turn is none, so that a vehicle that keeps to its legs passes it without a stop."""

_SAME_DEGREES = 0.1
"""Short legs turn more, where their places were rounded for a file."""

SHORTEST_RUN = 3
"""Fewest legs without a stop that are uploaded as a mission: fewer are commanded one by one."""

_Way: TypeAlias = tuple[Sequence[float], Sequence[float]]
"""Where a straight leg begins and ends, in space or in the plane."""


class Passage(NamedTuple):
    """The end of a leg that is passed.

    Attributes:
        saved: seconds by which this leg is shorter: the robot begins the next one, and does not settle.
        onward: seconds by which the next one is: the robot has begun it, and does not set out from a stop.
        speed: metres per second with which it begins the next one.
        start: where it does, if not at the end of this one.
    """

    saved: float
    onward: float
    speed: float = 0.0
    start: Position | None = None


def goes_straight(before: Position, corner: Position, after: Position) -> bool:
    """Return whether a path turns so little at a corner that a vehicle passes it without a stop."""
    return degrees(turn_at(before, corner, after)) <= STRAIGHT_DEGREES + _SAME_DEGREES


def passed(
    rates: Rates,
    before: Leg,
    after: Leg,
    entered: Passage | None = None,
    onward: Rates | None = None,
    push: Push | None = None,
) -> Passage:
    """Return what a robot saves that passes where one leg ends and another begins.

    Of legs that are so short that they are taken as one, each saves its share.

    Args:
        before, after: the legs.
        entered: with which it begins the one before; None: from a stop.
        onward: rates of the one after; None: these.
        push: with which it begins the one before; None: not known.
    """
    onward = onward or rates
    many, more = rates.together(*before), onward.together(*after)
    if many > 1 or more > 1:
        whole = moved(before[1], before, -many * dist(*before)), before[1]
        beyond = after[0], moved(after[0], after, more * dist(*after))
        passage = passed(rates, whole, beyond, entered, onward, push)
        return passage._replace(saved=passage.saved / many, onward=passage.onward / more)
    if rates.timing.slows_down:
        return _slowed(rates, before, after, entered or Passage(0.0, 0.0), onward, push)
    settled, both = settling(rates, *before), overlap(rates, before, after) / 2.0
    starting = min(rates.timing.starting, settled)
    return Passage(settled - starting + both, both + starting)


def _slowed(
    rates: Rates, before: Leg, after: Leg, entered: Passage, onward: Rates, push: Push | None
) -> Passage:
    """Return what a robot saves that slows down for a place, as long as it need not stop for it.

    Within its radius it turns to the next leg, for a while, on an arc.
    """
    (here, there), (_, beyond) = before, after
    aside = _half_turn((here[:2], there[:2]), (there[:2], beyond[:2]))
    if aside is None:
        return Passage(0.0, 0.0)
    speed = rates.timing.passing(aside, dist(there[:2], beyond[:2]), beyond[2] - there[2])
    radius = rates.timing.corner_radius if speed > 0.0 else 0.0
    begun = entered.start or here
    near = moved(there, (begun, there), -min(radius, dist(begun, there)))
    first = _curve(rates, (begun, near), entered.speed, speed)
    if dist(begun, there) <= radius:  # it has passed it as soon as the one before
        aside = 0.0
    seconds = turning(first.leaves, aside, rates.timing.acceleration, rates.timing.jerk)
    half = min(asin(min(1.0, aside)), NEARLY_BACK)
    way = seconds * first.leaves / 2.0 * (tan(half) / half if half > 0.0 else 1.0)
    start = moved(moved(near, before, way), after, way)
    rest = _curve(onward, (start, beyond), first.leaves).seconds + seconds
    saved = _curve(rates, (begun, there), entered.speed).seconds - first.seconds + settling(rates, *before)
    saved += rates.lag(rates.stopping(*before)[0], *before, push) - rates.lag(first.seconds, *before, push)
    return Passage(
        rates.share * saved,
        rates.share * (_curve(onward, after).seconds - rest),
        first.leaves,
        start if radius else None,
    )


def _curve(rates: Rates, leg: Leg, enters: float = 0.0, leaves: float = 0.0) -> Curve:
    length, speed, up, down = rates.limits(*leg)
    return curve(length, speed, (up, down, rates.timing.jerk), enters, min(leaves, speed))


def overlap(rates: Rates, before: Leg, after: Leg) -> float:
    """Return how many seconds a robot saves that passes the corner between two legs.

    That is for as long as it is on both at once: while it brakes on the first and speeds up on the
    second, but it comes no further from the corner than its radius, and half of the turn is over when it
    is as far before as behind it.
    """
    both = min(rates.phases(*before)[1], rates.phases(*after)[0])
    return rates.share * min(both, _turning(rates.timing, before, after))


def settling(rates: Rates, start: Position, end: Position) -> float:
    """Return the seconds that a leg takes longer as it ends with a stop, which is not passed."""
    seconds, fastest = rates.stopping(start, end)
    lag = 0.0 if rates.timing.slows_down else rates.lag(seconds, start, end)
    return rates.share * max(0.0, lag + rates.timing.settled(fastest, seconds))


def _turning(timing: LegTiming, before: Leg, after: Leg) -> float:
    """Return the seconds of a turn that comes as far from its corner as the radius at most.

    Half of it takes as long as the robot needs for its distance from the corner then, from a stop.
    """
    half = _half_turn(before, after)
    if half is None:
        return 0.0
    if half <= STRAIGHT or timing.corner_radius == inf:
        return inf
    apart = timing.corner_radius / (2.0 * half)
    return min(timing.corner_seconds / half, 2.0 * covering(apart, timing.acceleration, timing.jerk))


def _half_turn(before: _Way, after: _Way) -> float | None:
    """Return the sine of half the turn between two legs; None where one has no length."""
    one, two = (tuple(q - p for p, q in zip(*leg, strict=True)) for leg in (before, after))
    return half_turn(one, two)
