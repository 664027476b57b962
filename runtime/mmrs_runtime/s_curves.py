"""S-curves: how long straight legs take with a limited acceleration and jerk.

The double-S profile of Biagiotti and Melchiorri (2008, section 3.4), with a deceleration of its own. Lengths
are metres, speeds metres per second, accelerations per second squared, and jerks per second cubed.
"""

from __future__ import annotations

from collections.abc import Callable
from math import asin, inf, radians, sqrt
from typing import NamedTuple

ALIGNED = radians(11.5)
"""Angle between its course and the next leg from which on a robot that slowed down for a corner speeds up."""


def speeding(change: float, acceleration: float, jerk: float) -> float:
    """Return the seconds in which one steady speed becomes another."""
    if jerk == inf:
        return change / acceleration
    if change * jerk >= acceleration * acceleration:
        return change / acceleration + acceleration / jerk
    return 2.0 * sqrt(change / jerk)


def turning(speed: float, aside: float, acceleration: float, jerk: float) -> float:
    """Return for how many seconds a robot turns at even speed, before it speeds up again.

    Its velocity turns by an S-curve, whose end, which is not waited for, is a parabola.

    Args:
        speed: in the turn. aside: sine of half the turn.
        acceleration, jerk: of each part of its velocity.
    """
    turn = 2.0 * asin(min(1.0, aside))
    if turn <= ALIGNED:
        return 0.0
    return speeding(2.0 * speed * aside, acceleration, jerk) * (1.0 - sqrt(ALIGNED / turn / 2.0))


class Curve(NamedTuple):
    """A leg by an S-curve: its seconds, largest speed, and the one with which it ends, which may be less.

    Where it is too short to come to the speed with which it is to end, it ends with what it comes to.
    """

    seconds: float
    fastest: float
    leaves: float


def curve(
    length: float, speed: float, limits: tuple[float, float, float], enters: float = 0.0, leaves: float = 0.0
) -> Curve:
    """Return how a leg is taken that begins and ends at steady speeds.

    Args:
        length: metres. speed: largest, metres per second.
        limits: acceleration and deceleration, metres per second squared, and jerk, per second cubed.
        enters, leaves: speeds at its begin and its end, metres per second. One that is entered faster than
            at its largest speed is slowed down on first.
    """
    if enters > speed:
        braking = speeding(enters - speed, limits[1], limits[2])
        metres = (enters + speed) / 2.0 * braking
        if metres >= length:
            return Curve(braking * length / metres, enters, speed)
        rest = curve(length - metres, speed, limits, speed, leaves)
        return Curve(braking + rest.seconds, enters, rest.leaves)
    if enters == leaves == 0.0:
        return Curve(*stop_to_stop(length, speed, *limits), 0.0)
    up, down, jerk = limits

    def phases(fastest: float, last: float) -> tuple[float, float]:
        """Return the seconds and metres in which it gets from its first speed to this one and to its last."""
        first, second = speeding(fastest - enters, up, jerk), speeding(fastest - last, down, jerk)
        return first + second, (enters + fastest) * first / 2.0 + (fastest + last) * second / 2.0

    if leaves > enters and phases(leaves, leaves)[1] > length:
        leaves = _largest(enters, leaves, lambda each: phases(each, each)[1] <= length)
    least = max(enters, leaves)
    speed = max(speed, least)
    seconds, metres = phases(speed, leaves)
    if metres <= length:
        return Curve(seconds + (length - metres) / speed, speed, leaves)
    fastest = _largest(least, speed, lambda each: phases(each, leaves)[1] <= length)
    seconds, metres = phases(fastest, leaves)
    return Curve(seconds * min(1.0, length / metres) if metres > 0.0 else 0.0, fastest, leaves)


def _largest(low: float, high: float, fits: Callable[[float], bool]) -> float:
    """Return the largest value that fits, where smaller ones do, or the least."""
    for _ in range(50):
        middle = (low + high) / 2.0
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def reached(speed: float, acceleration: float, jerk: float) -> tuple[float, float]:
    """Return the seconds and metres in which a robot that speeds up from a stop first is so fast."""
    if acceleration == inf:
        return 0.0, 0.0
    bend = acceleration / jerk if jerk < inf else 0.0
    if bend > 0.0 and 2.0 * speed <= acceleration * bend:
        seconds = sqrt(2.0 * speed / jerk)
        return seconds, speed * seconds / 3.0
    seconds = speed / acceleration + bend / 2.0
    return seconds, speed * speed / (2.0 * acceleration) + acceleration * bend * bend / 24.0


def covering(metres: float, acceleration: float, jerk: float) -> float:
    """Return the seconds in which a robot that speeds up from a stop without end has gone so far."""
    bend = acceleration / jerk if jerk < inf else 0.0
    if metres <= jerk * bend**3 / 6.0 if bend else acceleration == inf:
        return float((6.0 * metres / jerk) ** (1.0 / 3.0)) if jerk < inf else 0.0
    speed, left = acceleration * bend / 2.0, metres - acceleration * bend * bend / 6.0
    return bend + (sqrt(speed * speed + 2.0 * acceleration * left) - speed) / acceleration


def stop_to_stop(
    length: float, speed: float, acceleration: float, deceleration: float, jerk: float
) -> tuple[float, float]:
    """Return the seconds of a leg from a stop to a stop, and its largest speed."""
    if speed < inf:
        phases = speeding(speed, acceleration, jerk) + speeding(speed, deceleration, jerk)
        if 2.0 * length >= speed * phases:
            return length / speed + phases / 2.0, speed
    fastest = largest_speed(length, acceleration, deceleration, jerk)
    if fastest == inf:
        return 0.0, inf
    return speeding(fastest, acceleration, jerk) + speeding(fastest, deceleration, jerk), fastest


def largest_speed(length: float, acceleration: float, deceleration: float, jerk: float) -> float:
    """Return the speed that a leg reaches where nothing limits it but acceleration and jerk.

    Its phases take as many seconds as twice the length by that speed. A phase that does not reach its
    acceleration takes 2 √(v / jerk), another v / a + a / jerk: of the four cases the sum of these leads to
    a power or to a quadratic equation, of v or of √v.
    """
    more, less = (
        (acceleration, deceleration) if acceleration >= deceleration else (deceleration, acceleration)
    )
    if jerk == inf:
        return sqrt(2.0 * length / (1.0 / more + 1.0 / less)) if less < inf else inf
    if more < inf:
        both, linear = 1.0 / more + 1.0 / less, (more + less) / jerk
        speed = (sqrt(linear * linear + 8.0 * both * length) - linear) / (2.0 * both)
        if speed * jerk >= more * more:
            return speed
    if less < inf:
        scale, root = sqrt(less), sqrt(2.0 * length)
        # (v / a + a / j) + 2 √(v / j) = (√(v / a) + √(a / j))², so that √v (√(v / a) + √(a / j)) = √(2 l)
        linear = sqrt(less / jerk)
        root_of_speed = (sqrt(linear * linear + 4.0 * root / scale) - linear) * scale / 2.0
        if root_of_speed * root_of_speed * jerk >= less * less:
            return root_of_speed * root_of_speed
    return float((length * sqrt(jerk) / 2.0) ** (2.0 / 3.0))
