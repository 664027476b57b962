"""Where the rides of two robots come close to each other, and when each robot may be there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import dist
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray

from mmrs_core.planning.timeline import HomeRelation, Ride
from mmrs_core.scene import Position

Floats: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.intp]

_SLOPE = 0.05
"""Metres by which robots over neighbouring homes may be nearer than the homes: these differ in height."""

_ONE_PLACE = 0.15
"""Metres within which two homes are one place, where no two robots can be."""


@dataclass(frozen=True, slots=True)
class TimedTrack:
    """All that a robot may take up: straight pieces, each within a span of time.

    Attributes:
        times: (n, 2) seconds between which the robot may be on each piece.
        places: (n, 2, 3) ends of each piece, equal for a stay.
        least: (n,) seconds that it takes along the piece at least.
        radii: (n,) metres from the piece within which it may be.
        relations: (n,) where each piece is, seen from the robot's home (see `HomeRelation`).
        home: of the robot.
    """

    times: Floats
    places: Floats
    least: Floats
    radii: Floats
    relations: Indices
    home: Position

    def pick(self, pieces: Indices) -> TimedTrack:
        """Return some pieces only."""
        kept = self.times[pieces], self.places[pieces], self.least[pieces], self.radii[pieces]
        return TimedTrack(*kept, self.relations[pieces], self.home)

    def box(self) -> Floats:
        """Return the lowest and the highest coordinates (2, 3) at which the robot may be."""
        radii = self.radii[:, None, None]
        low, high = (self.places - radii).min(axis=(0, 1)), (self.places + radii).max(axis=(0, 1))
        return np.stack([low, high])

    def cut(self, longest: float) -> TimedTrack:
        """Return the same in pieces of at most `longest` metres, each within its own span of time."""
        length = np.linalg.norm(self.places[:, 1] - self.places[:, 0], axis=1)
        parts = np.maximum(1, np.ceil(length / longest)).astype(np.intp)
        of = np.repeat(np.arange(len(parts)), parts)
        number = np.arange(len(of)) - np.repeat(np.cumsum(parts) - parts, parts)
        low, high = number / parts[of], (number + 1) / parts[of]
        start, offset = self.places[of, 0], (self.places[:, 1] - self.places[:, 0])[of]
        ends = [start + share[:, None] * offset for share in (low, high)]
        times = [self.times[of, 0] + self.least[of] * low, self.times[of, 1] - self.least[of] * (1.0 - high)]
        least = self.least[of] / parts[of]
        times_of_each, places = np.stack(times, axis=1), np.stack(ends, axis=1)
        return TimedTrack(times_of_each, places, least, self.radii[of], self.relations[of], self.home)


def track_of(rides: Sequence[Ride], home: Position) -> TimedTrack:
    """Return the rides of a robot as pieces, one for each leg or stay."""
    times, places, least, radii, relations = [], [], [], [], []
    for ride in rides:
        points = ride.points if len(ride.points) > 1 else ride.points * 2
        seconds = ride.least or (0.0,)
        before, whole = 0.0, sum(seconds)
        for leg, each in zip(pairwise(points), seconds, strict=True):
            times.append((ride.early + before, ride.late - (whole - before - each)))
            places.append(leg)
            least.append(each)
            radii.append(ride.radius)
            relations.append(ride.relation)
            before += each
    return TimedTrack(
        np.array(times, dtype=np.float64).reshape(-1, 2),
        np.array(places, dtype=np.float64).reshape(-1, 2, 3),
        np.array(least, dtype=np.float64),
        np.array(radii, dtype=np.float64),
        np.array(relations, dtype=np.intp),
        home,
    )


@dataclass(frozen=True, slots=True)
class ClosePairs:
    """Pairs of pieces of two tracks that are nearer to each other than allowed.

    Attributes:
        one, two: (n, 2) seconds between which each robot may be on its piece.
        distance: (n,) metres at the nearest.
        at_home: (n,) whether one of the robots then stands at its home.
    """

    one: Floats
    two: Floats
    distance: Floats
    at_home: NDArray[np.bool_]


def near_pairs(
    one: TimedTrack, two: TimedTrack, least: float, *, finest: float, spare: float | None = None
) -> ClosePairs:
    """Return the pairs of pieces that come within a distance of each other, in space.

    Homes that are nearer to each other are the operator's choice: a robot that stands at such a home is
    no hindrance to the other one at its own, nor in the column over it, while their distance is at least
    that of their homes.

    Args:
        one: track of a robot.
        two: of another.
        least: metres to keep.
        finest: length in metres of the pieces that are distinguished.
        spare: None: whenever the robots are there; a number: only where their times come within
            that many seconds of overlapping.
    """
    i, j = _pairs(one, two, least)
    counts = ~_excused(one, two, least, i, j)
    if spare is not None:
        counts &= _overlap(one.times[i], two.times[j], spare)
    i, j = i[counts], j[counts]
    first, second = one.pick(np.unique(i)).cut(finest), two.pick(np.unique(j)).cut(finest)
    i, j = _pairs(first, second, least)
    counts = ~_excused(first, second, least, i, j)
    if spare is not None:
        counts &= _overlap(first.times[i], second.times[j], spare)
    i, j = i[counts], j[counts]
    apart = legs_apart(first.places[i], second.places[j]) - first.radii[i] - second.radii[j]
    near = apart < least
    i, j = i[near], j[near]
    at_home = (first.relations[i] == HomeRelation.HOME) | (second.relations[j] == HomeRelation.HOME)
    return ClosePairs(first.times[i], second.times[j], apart[near], at_home)


def _excused(one: TimedTrack, two: TimedTrack, least: float, i: Indices, j: Indices) -> NDArray[np.bool_]:
    """Return (n,): which pairs of pieces are one at a home and one at or over a neighbouring home.

    Only those at least as far from each other as the homes.
    """
    if dist(one.home, two.home) >= least:
        return np.zeros(len(i), dtype=np.bool_)
    relations = np.stack([one.relations[i], two.relations[j]])
    found: NDArray[np.bool_] = (relations.min(axis=0) > HomeRelation.ELSEWHERE) & (
        relations.max(axis=0) == HomeRelation.HOME
    )
    nearest = max(dist(one.home, two.home) - _SLOPE, _ONE_PLACE)
    found[found] = legs_apart(one.places[i[found]], two.places[j[found]]) >= nearest
    return found


def _overlap(one: Floats, two: Floats, spare: float) -> NDArray[np.bool_]:
    found: NDArray[np.bool_] = np.maximum(one[:, 0], two[:, 0]) < np.minimum(one[:, 1], two[:, 1]) + spare
    return found


def _pairs(one: TimedTrack, two: TimedTrack, least: float) -> tuple[Indices, Indices]:
    reach = least + max(one.radii.max(initial=0.0) + two.radii.max(initial=0.0), 0.0)
    tree = shapely.STRtree(_boxes(two, 0.0))
    i, j = tree.query(_boxes(one, reach))
    low, high = one.places[i, :, 2].min(axis=1) - reach, one.places[i, :, 2].max(axis=1) + reach
    other = two.places[j, :, 2]
    level = (other.max(axis=1) > low) & (other.min(axis=1) < high)
    return i[level], j[level]


def _boxes(track: TimedTrack, more: float) -> NDArray[np.object_]:
    low, high = track.places[:, :, :2].min(axis=1) - more, track.places[:, :, :2].max(axis=1) + more
    found: NDArray[np.object_] = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
    return found


def legs_apart(one: Floats, two: Floats) -> Floats:
    """Return the distances (n,) between straight legs (n, 2, 3), exact but for rounding.

    The least distance is at an end of one of them, or where both are nearest to each other inside.
    """
    ends = [
        _to_leg(one[:, 0], two),
        _to_leg(one[:, 1], two),
        _to_leg(two[:, 0], one),
        _to_leg(two[:, 1], one),
        _inside(one, two),
    ]
    nearest: Floats = np.min(ends, axis=0)
    return nearest


def _to_leg(points: Floats, legs: Floats) -> Floats:
    offset, gap = legs[:, 1] - legs[:, 0], points - legs[:, 0]
    length2 = (offset**2).sum(axis=1)
    share = np.clip((gap * offset).sum(axis=1) / np.where(length2 > 0.0, length2, 1.0), 0.0, 1.0)
    found: Floats = np.linalg.norm(gap - share[:, None] * offset, axis=1)
    return found


def _inside(one: Floats, two: Floats) -> Floats:
    """Return the distances where the legs' lines are nearest, taken back into both legs."""
    u, v, w = one[:, 1] - one[:, 0], two[:, 1] - two[:, 0], one[:, 0] - two[:, 0]
    a, b, c = (u * u).sum(axis=1), (u * v).sum(axis=1), (v * v).sum(axis=1)
    d, e = (u * w).sum(axis=1), (v * w).sum(axis=1)
    across = a * c - b * b
    safe = np.where(across > 0.0, across, 1.0)
    s = np.clip((b * e - c * d) / safe, 0.0, 1.0)[:, None]
    t = np.clip((a * e - b * d) / safe, 0.0, 1.0)[:, None]
    found: Floats = np.linalg.norm(w + s * u - t * v, axis=1)
    return found
