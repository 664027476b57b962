"""Speeds over time: where they change, how fast, and where they are kept.

A change from one speed to another is taken for half of an S-curve: the acceleration grows at a largest jerk,
stays at its largest value, and falls again. A curve that is fitted to all samples of a change is less
sensitive to noise and to few samples than differences are, and yields both figures at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import sqrt

import numpy as np

from .flight import Floats

SMOOTHED = 0.3
"""Seconds over which speeds are averaged before they are differentiated."""

FEWEST = 5
"""Samples from which a change is judged."""

LARGEST_ERROR = 0.05
"""Root mean square of what a curve leaves over, as a part of the change, above which it does not count."""

_EDGE = 0.2
"""Part of the largest slope at which a change begins and ends."""

_TAIL = 0.2
"""Seconds beyond its steep part that belong to a change: there the curve ends."""

_MOST = 40
"""Samples of a change that a curve is fitted to: more of them are averaged."""

LARGEST_JERK = 100.0
"""Metres per second cubed, above which no vehicle changed its speed: its estimate jumped."""


@dataclass(frozen=True, slots=True)
class Ramp:
    """A change of speed.

    Attributes:
        first, last: numbers of its samples.
        middle: time at which half of it is done.
        low, high: speeds. rising: whether it leads from the low one to the high one.
        acceleration, jerk: of the curve.
        error: root mean square of what the curve leaves over, as a part of the change.
    """

    first: int
    last: int
    middle: float
    low: float
    high: float
    rising: bool
    acceleration: float
    jerk: float
    error: float

    @property
    def change(self) -> float:
        """Return the difference of its speeds."""
        return self.high - self.low

    @property
    def fits(self) -> bool:
        """Return whether it is an S-curve, and not a jump of the position."""
        return self.error <= LARGEST_ERROR and self.jerk <= LARGEST_JERK

    @property
    def keeps(self) -> bool:
        """Return whether it keeps its largest acceleration: a longer change would not have a larger one."""
        return self.change * self.jerk >= 1.5 * self.acceleration**2


def smoothed(times: Floats, values: Floats) -> Floats:
    """Return the mean of the values around each of them."""
    count = max(1, round(SMOOTHED / float(np.median(np.diff(times)))) // 2 * 2 + 1)
    padded = np.pad(values, count // 2, mode="edge")
    means: Floats = np.convolve(padded, np.ones(count) / count, "valid")
    return means


def slopes_of(times: Floats, values: Floats) -> Floats:
    """Return how fast values change; averaged before and after, because differences raise noise."""
    return smoothed(times, np.gradient(smoothed(times, values), times))


def extremes(values: Floats, least: float) -> list[int]:
    """Return where values are smallest and largest by turns, with at least a difference between neighbours.

    >>> extremes(np.array([0.0, 1.0, 0.9, 3.0, 3.0, 0.5]), 0.5)
    [0, 3, 5]
    """
    found: list[int] = []
    lowest = highest = 0
    rising: bool | None = None
    for index, value in enumerate(values.tolist()):
        if value < values[lowest]:
            lowest = index
        if value > values[highest]:
            highest = index
        if rising is not True and value - values[lowest] >= least:
            found.append(lowest)
            rising, highest = True, index
        elif rising is not False and values[highest] - value >= least:
            found.append(highest)
            rising, lowest = False, index
    if rising is not None:
        found.append(highest if rising else lowest)
    return found


def steepest(slopes: Floats, first: int, last: int) -> tuple[int, int]:
    """Return where a change between two extremes begins and ends: where it is much less steep than at most.

    Args:
        slopes: that are positive where the change is made.
    """
    begin = end = first + int(np.argmax(slopes[first : last + 1]))
    limit = _EDGE * slopes[begin]
    while begin > first and slopes[begin] > limit:
        begin -= 1
    while end < last and slopes[end] > limit:
        end += 1
    return begin, end


def ramps_in(times: Floats, speeds: Floats, least: float) -> Iterator[Ramp]:
    """Yield the changes of speed.

    Args:
        times: of the samples.
        speeds: not negative.
        least: change that counts.
    """
    slopes = slopes_of(times, speeds)
    turning = extremes(speeds, least)
    more = max(1, round(_TAIL / float(np.median(np.diff(times)))))
    for before, after in pairwise(turning):
        sign = 1.0 if speeds[after] > speeds[before] else -1.0
        first, last = steepest(sign * slopes, before, after)
        first, last = max(before, first - more), min(after, last + more)
        if last - first + 1 < FEWEST or sign * (speeds[last] - speeds[first]) < least:
            continue
        yield _fitted(times[first : last + 1], speeds[first : last + 1], first)


def _fitted(times: Floats, speeds: Floats, first: int) -> Ramp:
    rising = bool(speeds[-1] > speeds[0])
    low, high = sorted((float(speeds[0]), float(speeds[-1])))
    done = speeds - low
    grown = np.maximum.accumulate(done if rising else done[::-1])
    middle = float(np.interp((high - low) / 2.0, grown, times if rising else times[::-1]))
    since = times - middle if rising else middle - times
    acceleration, jerk, error = _closest(_binned(since), _binned(done), high - low)
    return Ramp(first, first + len(times) - 1, middle, low, high, rising, acceleration, jerk, error)


def with_jerk(times: Floats, speeds: Floats, ramp: Ramp, jerk: float) -> float:
    """Return the acceleration of the curve that is closest to a ramp where its jerk is given."""
    part = slice(ramp.first, ramp.last + 1)
    since = times[part] - ramp.middle if ramp.rising else ramp.middle - times[part]
    since, done = _binned(since), _binned(speeds[part] - ramp.low)
    accelerations = np.geomspace(0.02, 20.0, 60)
    for _ in range(3):
        growing = np.minimum(accelerations / jerk, sqrt(ramp.change / jerk))
        errors = _errors(since, done, ramp.change, ramp.change / (jerk * growing) + growing, growing)
        best = int(np.argmin(errors))
        found = float(accelerations[best])
        step = accelerations[1] / accelerations[0]
        accelerations = np.geomspace(found / step, found * step, 21)
    return found


def _binned(values: Floats) -> Floats:
    """Return at most `_MOST` values: means of neighbours where there are more."""
    size = -(-len(values) // _MOST)
    whole = values[: len(values) // size * size]
    means: Floats = whole.reshape(-1, size).mean(axis=1)
    return means


def _closest(since: Floats, done: Floats, change: float) -> tuple[float, float, float]:
    """Return acceleration, jerk and error of the closest curve: by a grid, which is then refined.

    The grid is one of seconds and of the part of them in which the acceleration changes: other than
    acceleration and jerk, these hardly depend on each other.
    """
    spans = np.ptp(since) * np.linspace(0.3, 1.3, 41)
    parts = np.linspace(0.02, 1.0, 25)
    for _ in range(4):
        seconds, growing = spans[:, None], spans[:, None] * parts[None, :] / 2.0
        errors = _errors(since, done, change, seconds, growing)
        at, best = np.unravel_index(int(np.argmin(errors)), errors.shape)
        largest = change / (spans[at] - growing[at, best])
        found = float(largest), float(largest / growing[at, best]), float(errors[at, best]) / change
        spans = _around(spans, int(at), 1e-3, np.inf)
        parts = _around(parts, int(best), 0.01, 1.0)
    return found


def _around(values: Floats, index: int, lowest: float, highest: float) -> Floats:
    step = values[1] - values[0]
    closer: Floats = np.clip(np.linspace(values[index] - step, values[index] + step, 11), lowest, highest)
    return closer


def _errors(since: Floats, done: Floats, change: float, seconds: Floats, growing: Floats) -> Floats:
    """Return what curves leave over: the root of the mean square.

    Args:
        since: seconds since the middle of the change. done: of it.
        seconds: that curves take. growing: those in which the acceleration grows, and falls again at the end.
    """
    seconds, growing = seconds[..., None], growing[..., None]
    largest = change / (seconds - growing)
    x = np.clip(since + seconds / 2.0, 0.0, seconds)
    early = 0.5 * largest / growing * np.minimum(x, growing) ** 2
    late = 0.5 * largest / growing * np.minimum(seconds - x, growing) ** 2
    kept = largest * (x - growing / 2.0)
    curve = np.where(x < growing, early, np.where(x > seconds - growing, change - late, kept))
    errors: Floats = np.sqrt(((curve - done) ** 2).mean(axis=-1))
    return errors


@dataclass(frozen=True, slots=True)
class Plateau:
    """A stretch over which a value is kept. Attributes: numbers of its samples, its value, seconds."""

    first: int
    last: int
    value: float
    seconds: float


def plateaus_in(times: Floats, values: Floats, least: float, seconds: float) -> Iterator[Plateau]:
    """Yield where values stay within a twentieth of their largest between two small ones.

    Args:
        least: value that counts.
        seconds: for which it is kept at least.
    """
    turning = extremes(values, least / 2.0)
    for index in turning:
        top = float(values[index])
        if top < least:
            continue
        first = last = index
        while first > 0 and values[first - 1] >= 0.95 * top:
            first -= 1
        while last < len(values) - 1 and values[last + 1] >= 0.95 * top:
            last += 1
        lasted = float(times[last] - times[first])
        if lasted >= seconds:
            yield Plateau(first, last, float(np.median(values[first : last + 1])), lasted)
