"""Swaths as lines to be followed, and where along them something is to be done.

A robot that acts along a swath need not go further than from the first to the last place of an
action, because what an action covers reaches beyond its place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from math import ceil, dist, hypot, inf
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.planning.levels import LevelLeg

Floats: TypeAlias = NDArray[np.float64]
Place: TypeAlias = tuple[float, float]
Clear: TypeAlias = Callable[[Place, Place], bool]
"""Whether a robot may go straight from one place to another."""

APART = 0.01
"""Metres: places nearer to each other than this are one."""

_BEND = 1e-9
"""Metres by which the path over a point is longer than the straight one if it turns there."""

_RUN_IN = 0.5
"""Metres of the path before a single action that give it its direction."""


@dataclass(frozen=True, slots=True)
class Swath:
    """A polyline to be followed.

    Attributes:
        points: (n, 2), at least one.
        spots: arc lengths at which an action is due, ascending; empty where the path itself covers.
    """

    points: Floats
    spots: tuple[float, ...] = ()

    def reversed(self) -> Swath:
        """Return the same swath, followed from its end."""
        whole = self.length
        return Swath(self.points[::-1], tuple(max(0.0, whole - spot) for spot in reversed(self.spots)))

    @property
    def ends(self) -> Floats:
        """Return (2, 2): where it begins and ends, or where its only action is, twice."""
        if len(self.spots) != 1:
            return self.points[[0, -1]]
        at = [np.interp(self.spots[0], self.arcs, self.points[:, axis]) for axis in (0, 1)]
        return np.array([at, at])

    @property
    def length(self) -> float:
        """Metres along all legs."""
        return float(self.arcs[-1])

    @property
    def legs_of_spots(self) -> NDArray[np.int_]:
        """Return the index of each spot's leg; a spot at a bend belongs to the leg before."""
        done = self.arcs
        return np.clip(np.searchsorted(done, np.array(self.spots) - 1e-9) - 1, 0, len(done) - 2)

    def by_leg(self) -> Iterator[tuple[Floats, tuple[float, ...]]]:
        """Yield the two ends of each leg that has spots, and the metres along it at which these are."""
        legs, spots, arcs = self.legs_of_spots, np.array(self.spots), self.arcs
        for leg in np.unique(legs):
            yield self.points[leg : leg + 2], tuple((spots[legs == leg] - arcs[leg]).tolist())

    def only(self, spots: Sequence[float]) -> Swath:
        """Return the swath from the first to the last of some of its spots, each seen from the same side."""
        arcs, legs = self.arcs, replace(self, spots=tuple(spots)).legs_of_spots
        first, last = int(legs[0]), int(legs[-1])
        begin = spots[0] if len(spots) > 1 and arcs[first + 1] - spots[0] > APART else float(arcs[first])
        if spots[-1] - begin < APART:
            return Swath(self.points[first : first + 2], (spots[0] - begin,))
        ends = [[np.interp(arc, arcs, self.points[:, axis]) for axis in (0, 1)] for arc in (begin, spots[-1])]
        return Swath(
            np.array([ends[0], *self.points[first + 1 : last + 1], ends[1]]),
            tuple(each - begin for each in spots),
        )

    @property
    def arcs(self) -> Floats:
        """Return the metres along the legs at each point."""
        return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self.points, axis=0).T))])


@dataclass(frozen=True, slots=True)
class _Stop:
    """A place on the path, and whether an action is due there."""

    at: Place
    acts: bool


def swath_over(
    legs: Sequence[LevelLeg], width: float, length: float, clear: Clear, *, facing: bool = False
) -> Swath | None:
    """Return the swath that follows legs, each reached upright from the end of the one before.

    Args:
        legs: from left to right.
        width: metres that the swath covers across.
        length: metres that an action covers along; 0: the path itself covers.
        clear: whether a robot may go straight from one place to another.
        facing: whether a robot is to face along the swath, even where an action covers all whichever way it
            faces.

    Returns:
        None where the path itself would cover, but there is none.
    """
    if length <= 0.0:
        stops = _merged([_Stop(at, acts=False) for leg in legs for at in (leg.begin, leg.end)], clear)
        return _joined(stops) if len(stops) > 1 else None
    stops = _merged(list(_trimmed([stop for leg in legs for stop in _stops(leg, length)])), clear)
    if len(stops) == 1 and (facing or not _seen_any_way(legs, stops[0].at, min(width, length) / 2)):
        stops = [*_run_in(stops[0].at, min(_RUN_IN, length / 2), clear), *stops]
    return _joined(stops)


def spots_over(needs: Sequence[tuple[float, float]], length: float) -> list[float]:
    """Return the fewest places such that stretches of `length` centred on them cover all needs.

    Where stretches must touch, they share evenly what they overlap.

    >>> spots_over([(0.0, 8.0), (9.0, 18.0), (40.0, 41.0)], 10.0)
    [4.5, 13.5, 40.5]
    """
    spots: list[float] = []
    for begin, end in _blocks(needs, length):
        count = max(1, ceil((end - begin) / length - 1e-9))
        spots += [begin + (i + 0.5) * (end - begin) / count for i in range(count)]
    return spots


def _blocks(needs: Sequence[tuple[float, float]], length: float) -> Iterator[tuple[float, float]]:
    """Yield stretches that are covered by whole lengths, one after the other, from their beginning."""
    begin = end = seen = -inf
    for left, right in needs:
        if left > seen:
            if seen > begin:
                yield begin, end
            begin, seen = left, left + length
        seen += length * max(0, ceil((right - seen) / length - 1e-9))
        end = right
    if seen > begin:
        yield begin, end


def _stops(leg: LevelLeg, length: float) -> Iterator[_Stop]:
    """Yield a leg's beginning, the places of its actions, and its end."""
    (left, low), (right, high) = leg.begin, leg.end
    steep = hypot(right - left, high - low) / (right - left)
    yield _Stop(leg.begin, acts=False)
    for x in spots_over(leg.needs, length / steep):
        yield _Stop((x, low + (x - left) / (right - left) * (high - low)), acts=True)
    yield _Stop(leg.end, acts=False)


def _trimmed(stops: Sequence[_Stop]) -> Sequence[_Stop]:
    acting = [i for i, stop in enumerate(stops) if stop.acts]
    return stops[acting[0] : acting[-1] + 1]


def _merged(stops: Sequence[_Stop], clear: Clear) -> list[_Stop]:
    """Return the stops without those that are where another is, as far as the path stays clear."""
    kept = [stops[0]]
    for i, stop in enumerate(stops[1:], 1):
        if dist(kept[-1].at, stop.at) >= APART:
            kept.append(stop)
        elif stop.acts and not kept[-1].acts:
            before = kept[-2].at if len(kept) > 1 else stop.at
            if clear(before, stop.at):
                kept[-1] = stop
            else:
                kept.append(stop)
        elif i + 1 < len(stops) and not clear(kept[-1].at, stops[i + 1].at):
            kept.append(stop)
    return kept


def _seen_any_way(legs: Sequence[LevelLeg], spot: Place, radius: float) -> bool:
    """Return whether an action at a spot covers all that the legs need, whichever way the robot faces."""
    return all(dist(spot, corner) <= radius + APART for leg in legs for corner in leg.corners)


def _run_in(spot: Place, distance: float, clear: Clear) -> list[_Stop]:
    """Return where a level path before a spot begins; empty where neither side is clear."""
    x, y = spot
    begins = [(x - distance, y), (x + distance, y)]
    return [_Stop(begin, acts=False) for begin in begins if clear(begin, spot)][:1]


def _joined(stops: Sequence[_Stop]) -> Swath:
    at = [stop.at for stop in stops]
    bends = [_bends(*three) for three in zip(at, at[1:], at[2:], strict=False)]
    points = [place for place, kept in zip(at, [True, *bends, True], strict=False) if kept]
    along = [0.0, *accumulate(dist(one, two) for one, two in pairwise(at))]
    whole = sum(dist(one, two) for one, two in pairwise(points))
    spots = (min(spot, whole) for spot, stop in zip(along, stops, strict=True) if stop.acts)
    return Swath(np.array(points), tuple(spots))


def _bends(one: Place, middle: Place, two: Place) -> bool:
    return dist(one, middle) + dist(middle, two) > dist(one, two) + _BEND
