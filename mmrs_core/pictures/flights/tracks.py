"""Tracks of robots: where they were when, in pieces without gaps, thinned out, and next to their paths."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf, sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.geometry.frames import Floats
from mmrs_core.scene import Position

Flags: TypeAlias = NDArray[np.bool_]
Piece: TypeAlias = tuple[tuple[float, ...], tuple[Position, ...]]
"""Times and positions, as many."""
TOLERANCE = 0.2
"""Metres by which a thinned track may be off at first."""
MOST_POINTS = 6_000
"""Points of a track beyond which the tolerance is doubled."""
_OFTEN = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Where a robot was when.

    Attributes:
        times: (n,) seconds of the run, never falling.
        positions: (n, 3) metres east, north, up.
        energies: (n,) fraction of the battery that is left, 0 to 1; nan where unknown.
        broken: (n,) whether its position between that fix and the next is unknown; false for the last.
            Between others it went straight.
    """

    times: Floats
    positions: Floats
    energies: Floats
    broken: Flags

    @property
    def gaps(self) -> tuple[tuple[float, float], ...]:
        """Return (since, until) of every gap."""
        found = np.flatnonzero(self.broken)
        return tuple((float(self.times[i]), float(self.times[i + 1])) for i in found)

    def at(self, time: float) -> Position | None:
        """Return where the robot was; None before the first fix, after the last, and in a gap.

        Half a second is tolerated at the ends, the usual time between fixes.
        """
        if not len(self.times) or not self.times[0] - _OFTEN <= time <= self.times[-1] + _OFTEN:
            return None
        time = min(max(time, float(self.times[0])), float(self.times[-1]))
        after = min(int(np.searchsorted(self.times, time, side="right")), len(self.times) - 1)
        before = max(after - 1, 0)
        since, until = self.times[before], self.times[after]
        if self.broken[before] and since < time < until:
            return None
        part = (time - since) / (until - since) if until > since else 1.0
        east, north, up = self.positions[before] * (1 - part) + self.positions[after] * part
        return float(east), float(north), float(up)

    def times_at_each(
        self, every: float, begin: float, end: float, marked: Sequence[float] = ()
    ) -> list[float]:
        """Return when it had gone a distance over ground since one time, and again and again until another.

        Args:
            every: metres; less than a twentieth of them before the end is the end.
            marked: the nearest of these times stands for its own, and the next distance counts from there.
        """
        inside = self.times[(begin < self.times) & (self.times < end)].tolist()
        known = [(time, at) for time in (begin, *inside, end) if (at := self.at(time)) is not None]
        if len(known) < 2:
            return []
        level = np.array([at[:2] for _, at in known])
        gone = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(level, axis=0).T))])
        times = [time for time, _ in known]
        places = {float(np.interp(each, times, gone)): each for each in marked if begin < each < end}
        found: list[float] = []
        mark = every
        while mark < gone[-1] - every / 20.0:
            near = min(places, key=lambda place: abs(place - mark), default=inf)
            if abs(near - mark) <= every / 2.0:
                found.append(places.pop(near))
                mark = near
            else:
                found.append(float(np.interp(mark, gone, times)))
            mark += every
        return found


NOWHERE = Track(np.empty(0), np.empty((0, 3)), np.empty(0), np.empty(0, dtype=bool))


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
    return [positions for _, positions in timed_pieces(track)]


def timed_pieces(track: Track) -> list[tuple[Floats, Floats]]:
    """Return the times (n,) and the positions (n, 3) between gaps."""
    if not len(track.times):
        return []
    ends = np.flatnonzero(track.broken) + 1
    return list(zip(np.split(track.times, ends), np.split(track.positions, ends), strict=True))


def nearest(points: Floats, way: Floats) -> tuple[Floats, Floats]:
    """Return the nearest point of a path to each point, (n, 3), and how far along it is, (n,) metres.

    Args:
        points: (n, 3), at least one.
        way: (m, 3) corners, at least one.
    """
    best = np.broadcast_to(way[0], points.shape).copy()
    least = np.linalg.norm(points - way[0], axis=1)
    along_way = np.zeros(len(points))
    behind = 0.0
    for begin, end in pairwise(way):
        leg = end - begin
        length = float(np.linalg.norm(leg))
        share = np.clip((points - begin) @ leg / length**2, 0.0, 1.0) if length > 0 else np.zeros(len(points))
        foot = begin + share[:, None] * leg
        distance = np.linalg.norm(points - foot, axis=1)
        nearer = distance < least
        best[nearer], least[nearer] = foot[nearer], distance[nearer]
        along_way[nearer] = behind + share[nearer] * length
        behind += length
    return best, along_way


def along(points: Floats, way: Floats) -> Floats:
    """Return how far along a path each point is, (n,) from 0 to 1; 0 for a path without length."""
    length = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
    return nearest(points, way)[1] / length if length > 0 else np.zeros(len(points))
