"""What a vehicle did in a flight: legs from stop to stop, corners passed, turns, take-offs and landings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import hypot, nan, radians

import numpy as np

from .curves import FEWEST, Plateau, Ramp, extremes, plateaus_in, ramps_in, slopes_of, smoothed, steepest
from .flight import Flags, Flight, Floats

STRAIGHT = 0.98
"""Distance between the ends of a leg over the distance flown, from which the leg is straight."""

LEAST_CORNER = radians(20.0)
LEAST_TURN = radians(45.0)

TURNING = 0.2
"""Radians per second by which a course changes at least that turns."""

BEGINNING = 0.5
"""Seconds for which a turn begins and ends more slowly than that."""

EVEN_SECONDS = 2.0
"""Seconds for which a speed is kept at least that counts as even."""

_UPRIGHT = 0.5
"""Metres per second level, below which a climb or a descent is upright."""

_LONGEST_PAUSE = 3.0
"""Seconds between a stop and the next target, above which the vehicle had something else to do there."""

_GAINING_SAMPLES = 60
"""Samples of even speed from which it is judged whether a vehicle came near to its speed only with time."""

_SLOWLY = 4.0
"""Seconds of the time constant from which it counts: gusts and corners make shorter ones."""

_LEAST_LACK, _UNEVEN, _BEYOND = 0.15, 0.02, 1.15
"""Share of its speed that it lacks at first, from which that counts; root mean square of what the curve
leaves over, and the speed that it leads to, as shares of the speed, up to which it is believed."""

_CLIMBING = 0.2
"""Metres per second from which a vehicle climbs or descends."""


@dataclass(frozen=True, slots=True)
class Leg:
    """A straight leg from a stop to a stop.

    Attributes:
        speeding_up, slowing_down: how it begins and ends.
        way: east and north, metres.
        cruise: mean speed between, where one was kept; NaN: none was.
        begun: when the vehicle was given its target; NaN where the log does not tell.
        done: when it was given the next one, or its next mode; NaN likewise.
    """

    speeding_up: Ramp
    slowing_down: Ramp
    way: tuple[float, float]
    cruise: float
    begun: float
    done: float

    @property
    def length(self) -> float:
        """Return its length, metres."""
        return hypot(*self.way)


def level_speeds(flight: Flight) -> Floats:
    """Return the speeds in the plane."""
    speeds: Floats = np.hypot(flight.velocities[:, 0], flight.velocities[:, 1])
    return speeds


def legs_of(flight: Flight, ramps: Sequence[Ramp], still: float) -> Iterator[Leg]:
    """Yield the straight legs that begin and end with a stop.

    Args:
        ramps: changes of the level speed, in their order.
        still: metres per second up to which the vehicle stands.
    """
    speeds = level_speeds(flight)
    for before, after in pairwise(ramps):
        if not before.rising or after.rising or max(before.low, after.low) > still:
            continue
        along = flight.places[before.first : after.last + 1, :2]
        east, north = (along[-1] - along[0]).tolist()
        if hypot(east, north) < STRAIGHT * float(np.hypot(*np.diff(along, axis=0).T).sum()):
            continue
        stands = np.flatnonzero(speeds[after.first :] <= still)
        stood = float(flight.times[after.first + stands[0]]) if len(stands) else float(flight.times[-1])
        even = float(flight.times[after.first] - flight.times[before.last]) >= EVEN_SECONDS
        cruise = float(speeds[before.last : after.first + 1].mean()) if even else nan
        began = float(flight.times[before.first])
        yield Leg(
            before, after, (east, north), cruise, *_bounds(flight, began, before.middle, after.middle, stood)
        )


@dataclass(frozen=True, slots=True)
class Gain:
    """How a vehicle came near to its speed on a leg, as it built up the thrust for it.

    Attributes:
        speed: that it would have reached, metres per second.
        lag: seconds that it takes longer for that. seconds: time constant.
    """

    speed: float
    lag: float
    seconds: float


def gain_of(flight: Flight, leg: Leg) -> Gain | None:
    """Return how the vehicle came near to its speed; None: at once, or the leg is too short to tell.

    After its first, quick change the speed lacks what falls as e^(-t / T): that curve is fitted.
    """
    first, last = leg.speeding_up.last, leg.slowing_down.first
    speeds = level_speeds(flight)[first : last + 1]
    if len(speeds) < _GAINING_SAMPLES:
        return None
    lowest = int(np.argmin(speeds[: len(speeds) * 2 // 5]))
    speeds = speeds[lowest:]
    times = flight.times[first + lowest : last + 1]
    times = times - float(flight.times[leg.speeding_up.first])
    fits = []
    for seconds in np.geomspace(2.0, max(2.5, (times[-1] - times[0]) / 1.5), 40).tolist():
        curve = np.stack([np.ones_like(times), -np.exp(-times / seconds)], axis=1)
        (speed, lacks), *_ = np.linalg.lstsq(curve, speeds, rcond=None)
        error = float(np.sqrt(((curve @ (speed, lacks) - speeds) ** 2).mean()))
        fits.append((error, float(speed), float(lacks), seconds))
    error, speed, lacks, seconds = min(fits)
    clear = error < _UNEVEN * speed and float(np.ptp(speeds)) > 4.0 * error
    if (
        seconds < _SLOWLY
        or not clear
        or not _LEAST_LACK < lacks / speed < 1.0
        or speed > _BEYOND * float(speeds.max())
    ):
        return None
    return Gain(speed, seconds * lacks / speed, seconds)


def _bounds(flight: Flight, began: float, moving: float, slowing: float, stood: float) -> tuple[float, float]:
    """Return when a leg was commanded, and when it was done; places that it passes in line do not end it."""
    commanded = sorted((*flight.targets, *(since for since, _ in flight.modes)))
    given = [each for each in commanded if began - _LONGEST_PAUSE <= each <= moving]
    following = [each for each in commanded if slowing < each <= stood + _LONGEST_PAUSE]
    return (given[-1] if given else nan), (following[0] if following else nan)


@dataclass(frozen=True, slots=True)
class Passage:
    """A corner that was passed without a stop, which is where the straight lines before and after it meet.

    Attributes:
        nearest: metres to which the vehicle came.
        turn: radians.
        speed: median in the turn, metres per second.
        beside: largest on each of its legs, of which the smaller one.
    """

    nearest: float
    turn: float
    speed: float
    beside: float


def corners_passed(flight: Flight, chosen: Flags, slowest: float) -> Iterator[Passage]:
    """Yield the corners that the vehicle passed without a stop.

    Args:
        chosen: samples that count.
        slowest: metres per second below which it has nearly stopped.
    """
    for first, last in stretches(chosen & (level_speeds(flight) > slowest)):
        times, places = flight.times[first : last + 1], flight.places[first : last + 1, :2]
        velocities = flight.velocities[first : last + 1, :2]
        speeds = np.hypot(*velocities.T)
        courses = np.unwrap(np.arctan2(velocities[:, 0], velocities[:, 1]))
        turns = sorted(_turns(times, courses))
        ends = [0, *(end for _, end in turns)], [*(begin for begin, _ in turns), len(times) - 1]
        peaks = [float(speeds[one : two + 1].max()) for one, two in zip(*ends, strict=True)]
        for (begin, end), legs in zip(turns, pairwise(peaks), strict=True):
            corner = _meeting(places[begin], velocities[begin], places[end], velocities[end])
            if corner is not None and begin > 0 and end < len(times) - 1:
                nearest = float(np.hypot(*(places[begin : end + 1] - corner).T).min())
                around = np.interp((times[begin] - BEGINNING, times[end] + BEGINNING), times, courses)
                turn = abs(float(around[1] - around[0]))
                yield Passage(nearest, turn, float(np.median(speeds[begin : end + 1])), min(legs))


def _turns(times: Floats, courses: Floats) -> Iterator[tuple[int, int]]:
    """Yield where a course turns by a corner at least, all in one direction: begin and end of each turn."""
    if len(times) < FEWEST:
        return
    rates = slopes_of(times, courses)
    for turning in (rates > TURNING, rates < -TURNING):
        for begin, end in stretches(turning):
            if abs(courses[end] - courses[begin]) >= LEAST_CORNER:
                yield begin, end


def turns_of(flight: Flight) -> Iterator[float]:
    """Yield the rates of turns about the vertical axis, radians per second."""
    known = np.isfinite(flight.headings)
    times, headings = flight.times[known], flight.headings[known]
    if len(times) < 3:
        return
    for begin, end in _changes(times, headings, LEAST_TURN):
        yield abs(float((headings[end] - headings[begin]) / (times[end] - times[begin])))


def climbs_of(flight: Flight, chosen: Flags, sign: float) -> Iterator[Plateau]:
    """Yield where the vehicle climbs upright at even speed, or descends, for a second at least.

    Args:
        chosen: samples that count.
        sign: 1 for climbs, -1 for descents.
    """
    yield from plateaus_in(flight.times, vertical_speeds(flight, chosen, sign), _CLIMBING, 1.0)


def vertical_speeds(flight: Flight, chosen: Flags, sign: float) -> Floats:
    """Return the speeds of upright climbs (sign 1) or descents (-1); 0 elsewhere."""
    speeds: Floats = np.where(_upright(flight, chosen), np.maximum(sign * flight.velocities[:, 2], 0.0), 0.0)
    return speeds


def vertical_ramps(flight: Flight, chosen: Flags, sign: float) -> Iterator[Ramp]:
    """Yield the changes of speed of upright climbs (sign 1) or descents (-1), but not those at the ground."""
    speeds = np.maximum(sign * flight.velocities[:, 2], 0.0)
    upright = _upright(flight, chosen)
    if not upright.any():
        return
    least = max(0.3, 0.6 * float(speeds[upright].max()))
    for each in ramps_in(flight.times, speeds, least):
        if each.fits and upright[each.first : each.last + 1].all():
            yield each


def _upright(flight: Flight, chosen: Flags) -> Flags:
    upright: Flags = chosen & (level_speeds(flight) < _UPRIGHT)
    return upright


def spin_ups_of(flight: Flight) -> Iterator[float]:
    """Yield the seconds from each command to take off until the vehicle climbs."""
    for commanded in flight.take_offs:
        climbing = np.flatnonzero((flight.times >= commanded) & (flight.velocities[:, 2] > _CLIMBING))
        if len(climbing):
            yield float(flight.times[climbing[0]]) - commanded


@dataclass(frozen=True, slots=True)
class Landing:
    """The end of a landing.

    Attributes:
        begun, ended: times at which its final descent begins, and its motors have stopped.
        rate: of the final descent, metres per second.
        height: above the ground at which that begins, metres; NaN where the descent was even all along.
        stopping: seconds from standing on the ground until the motors have stopped.
        drop, seconds: metres of all its descent, and how long it takes until the motors have stopped.
    """

    begun: float
    ended: float
    rate: float
    height: float
    stopping: float
    drop: float
    seconds: float


def landings_of(flight: Flight) -> Iterator[Landing]:
    """Yield the landings at whose ends the motors were stopped."""
    descents = smoothed(flight.times, -flight.velocities[:, 2])
    for disarmed in (since for since, armed in flight.armed if not armed):
        last = int(np.searchsorted(flight.times, disarmed, side="right")) - 1
        while last > 0 and descents[last] < _CLIMBING:
            last -= 1
        first = last
        while first > 0 and descents[first - 1] >= _CLIMBING:
            first -= 1
        times, heights = flight.times[first : last + 1], flight.places[first : last + 1, 2]
        if len(times) < 5 or float(level_speeds(flight)[first : last + 1].max()) > 2.0:
            continue
        final = _final(times, descents[first : last + 1])
        if final is None:
            continue
        begin, rate = final
        height = float(heights[begin] - heights[-1]) if begin > 0 else float("nan")
        drop, seconds = float(heights[0] - heights[-1]), disarmed - float(times[0])
        yield Landing(float(times[begin]), disarmed, rate, height, disarmed - float(times[-1]), drop, seconds)


def _final(times: Floats, descents: Floats) -> tuple[int, float] | None:
    """Return where the final descent begins, and its rate; None where it is not even."""
    half = times >= times[-1] - 2.0
    rate = float(np.median(descents[half]))
    begin = len(times) - 1
    while begin > 0 and descents[begin - 1] <= 1.2 * rate:
        begin -= 1
    return (begin, rate) if times[-1] - times[begin] >= 2.0 else None


def stretches(chosen: Flags) -> Iterator[tuple[int, int]]:
    """Yield first and last of the samples that are chosen one after the other.

    >>> list(stretches(np.array([False, True, True, False, True])))
    [(1, 2), (4, 4)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], chosen, [False]]).astype(np.int8)))
    for first, behind in edges.reshape(-1, 2).tolist():
        yield first, behind - 1


def _changes(times: Floats, angles: Floats, least: float) -> Iterator[tuple[int, int]]:
    """Yield where an angle changes by at least some radians: begin and end of each change."""
    if len(times) < 3:
        return
    slopes = slopes_of(times, angles)
    for before, after in pairwise(extremes(angles, least)):
        sign = 1.0 if angles[after] > angles[before] else -1.0
        begin, end = steepest(sign * slopes, before, after)
        if abs(angles[end] - angles[begin]) >= 0.7 * least and end > begin:
            yield begin, end


def _meeting(a: Floats, along: Floats, b: Floats, onwards: Floats) -> Floats | None:
    """Return where two lines meet, ahead of one and behind the other; None where they do not."""
    across = float(along[0] * onwards[1] - along[1] * onwards[0])
    if abs(across) < 0.1 * hypot(*along) * hypot(*onwards):
        return None
    gap = b - a
    ahead = float(gap[0] * onwards[1] - gap[1] * onwards[0]) / across
    behind = float(gap[0] * along[1] - gap[1] * along[0]) / across
    if ahead < 0.0 or behind > 0.0:
        return None
    corner: Floats = a + ahead * along
    return corner
