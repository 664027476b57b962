"""Cuts tracks into pieces without gaps, and thins them out for pictures, within a tolerance."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, sqrt
from typing import TypeAlias

import numpy as np

from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.flights.values import Track
from mmrs_core.scene import Position

Piece: TypeAlias = tuple[tuple[float, ...], tuple[Position, ...]]
"""Times and positions, as many."""
TOLERANCE = 0.2
"""Metres by which a thinned track may be off at first."""
MOST_POINTS = 6_000
"""Points of a track beyond which the tolerance is doubled."""


def stretches_of(track: Track, begin: float, end: float) -> Iterator[Piece]:
    """Yield times and positions within a stretch of time, for each piece between gaps."""
    if not len(track.times) or end < begin:
        return
    first, last = np.searchsorted(track.times, begin, side="right"), np.searchsorted(track.times, end)
    times, broken = track.times[first:last].tolist(), track.broken[first:last].tolist()
    points: list[Position] = [(east, north, up) for east, north, up in track.positions[first:last].tolist()]
    at_begin, at_end = track.at(begin), track.at(end)
    if at_begin is not None:
        times.insert(0, begin)
        points.insert(0, at_begin)
        broken.insert(0, bool(track.broken[first - 1]) if first else False)
    if at_end is not None:
        times.append(end)
        points.append(at_end)
        broken.append(False)
    since = 0
    for i in range(len(times)):
        if broken[i] or i + 1 == len(times):
            yield tuple(times[since : i + 1]), tuple(points[since : i + 1])
            since = i + 1


def thinned(track: Track, tolerance: float = TOLERANCE) -> tuple[Track, float]:
    """Return a track with fewer points, and the tolerance in metres that it keeps to.

    At the time of every fix that is left out, the thinned track is within the tolerance of it; ends of
    gaps stay. The tolerance is doubled until the track has at most `MOST_POINTS` points, but for gaps.
    Linear in the number of fixes for each tolerance.
    """
    while True:
        kept = _kept(track, tolerance)
        if len(kept) <= MOST_POINTS or len(kept) <= 2 * len(track.gaps) + 2:
            chosen = track.times[kept], track.positions[kept], track.energies[kept], track.broken[kept]
            return Track(*chosen), tolerance
        tolerance *= 2


def _kept(track: Track, tolerance: float) -> list[int]:
    """Return the indices of the points that stay.

    From the last point that stays, cones of velocities lead through all points since; where a point's
    own velocity is outside of one, the point before it stays, too. Each direction may be off by as
    much as keeps the distance within the tolerance.
    """
    if not len(track.times):
        return []
    cones = _Cones(track, tolerance / sqrt(3))
    times, broken = cones.times, track.broken.tolist()
    for i in range(1, len(times)):
        if broken[i - 1]:
            cones.stay(i - 1)
            cones.stay(i)
        elif cones.hold(i):
            cones.narrow(i)
        else:
            cones.stay(i - 1)
            if cones.hold(i):
                cones.narrow(i)
            else:  # it was there in no time
                cones.stay(i)
    cones.stay(len(times) - 1)
    return cones.kept


class _Cones:
    """The velocities, in each direction, that lead from the last point that stays through all since."""

    def __init__(self, track: Track, off: float) -> None:
        self.times: list[float] = track.times.tolist()
        self.kept = [0]
        self._along: list[list[float]] = [track.positions[:, axis].tolist() for axis in range(3)]
        self._off = off
        self._low, self._high = [-inf] * 3, [inf] * 3

    def stay(self, i: int) -> None:
        """Keep a point, and begin new cones there."""
        if i != self.kept[-1]:
            self.kept.append(i)
        self._low, self._high = [-inf] * 3, [inf] * 3

    def hold(self, i: int) -> bool:
        """Return whether a straight line to the point passes near enough to all points since."""
        first = self.kept[-1]
        passed = self.times[i] - self.times[first]
        if passed <= 0.0:
            return all(values[i] == values[first] for values in self._along)
        for values, low, high in zip(self._along, self._low, self._high, strict=True):
            if not low <= (values[i] - values[first]) / passed <= high:
                return False
        return True

    def narrow(self, i: int) -> None:
        """Narrow the cones to a point."""
        first = self.kept[-1]
        passed = self.times[i] - self.times[first]
        if passed <= 0.0:
            return
        reach = self._off / passed
        for axis, values in enumerate(self._along):
            middle = (values[i] - values[first]) / passed
            self._low[axis] = max(self._low[axis], middle - reach)
            self._high[axis] = min(self._high[axis], middle + reach)


def pieces(track: Track) -> list[Floats]:
    """Return the positions between gaps, each (n, 3)."""
    if not len(track.times):
        return []
    ends = np.flatnonzero(track.broken) + 1
    return list(np.split(track.positions, ends))
