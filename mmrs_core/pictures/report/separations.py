"""How near robots came to each other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations

import numpy as np

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.flights.away import Stretch, without
from mmrs_core.pictures.flights.places import Place
from mmrs_core.pictures.flights.planned import PlannedLeg
from mmrs_core.pictures.flights.values import Flags, Flown, Track
from mmrs_core.pictures.report.values import Separation
from mmrs_core.scene import Position

_RECHARGE = (BEHAVIOUR, "Recharge")

Way = tuple[Flown, Sequence[Stretch]]
"""A robot, and when it was under way."""


def separations_of(
    ways: Sequence[Way], required: float | None, place_of: Callable[[Position], Place], error: float = 0.0
) -> Iterator[Separation]:
    """Yield how near each two robots came to each other that were under way at one time.

    Between fixes each is taken to have gone straight and evenly; nothing is known of gaps.

    Args:
        required: metres that they had to keep; None where nothing was asked for.
        error: the part of them that allows for position errors.
    """
    for one, other in combinations(ways, 2):
        found = _nearest(one, other)
        if found is not None:
            kept, time, (east, north, up) = found
            where = place_of((east, north, up))
            yield Separation(kept, required, error, where, time, one[0].robot, other[0].robot)


def under_way(flown: Flown, legs: Sequence[PlannedLeg]) -> tuple[Stretch, ...]:
    """Return when a robot was under way: from its first move that moves to its last, charging apart.

    One whose program ended early is under way until the last thing that is known of it.
    """
    moving = [leg for leg in legs if len(set(leg.way)) > 1]
    if not moving:
        return ()
    early = flown.records[-1].label == "fault" or not moving[-1].ended
    charging = ((leg.begin, leg.end) for leg in legs if leg.move.is_a(_RECHARGE))
    return tuple(without((moving[0].begin, flown.end if early else moving[-1].end), charging))


def _nearest(first_way: Way, second_way: Way) -> tuple[float, float, Position] | None:
    """Return the smallest distance, when it was, and where the first robot was then."""
    one, other = first_way[0].track, second_way[0].track
    ends = np.array(
        [time for _, stretches in (first_way, second_way) for stretch in stretches for time in stretch]
    )
    times = np.union1d(np.union1d(one.times, other.times), ends)
    known = _known(first_way, times) & _known(second_way, times)
    if len(times) < 2 or not known.any():
        return None
    first, second = _at(one, times), _at(other, times)
    apart = first - second
    begins, moves = apart[:-1][known], np.diff(apart, axis=0)[known]
    lengths = np.einsum("ij,ij->i", moves, moves)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(lengths > 0, -np.einsum("ij,ij->i", begins, moves) / lengths, 0.0)
    share = np.clip(share, 0.0, 1.0)
    distances = np.linalg.norm(begins + share[:, None] * moves, axis=1)
    best = int(distances.argmin())
    since = int(np.flatnonzero(known)[best])
    part = float(share[best])
    east, north, up = (first[since] * (1 - part) + first[since + 1] * part).tolist()
    time = float(times[since] * (1 - part) + times[since + 1] * part)
    return float(distances[best]), time, (east, north, up)


def _at(track: Track, times: Floats) -> Floats:
    return np.stack([np.interp(times, track.times, track.positions[:, axis]) for axis in range(3)], axis=1)


def _known(way: Way, times: Floats) -> Flags:
    """Return for each time whether until the next it is known where the robot was, under way, (n - 1,)."""
    track = way[0].track
    if not len(track.times) or len(times) < 2:
        return np.zeros(max(len(times) - 1, 0), dtype=bool)
    middles = (times[:-1] + times[1:]) / 2
    before = np.clip(np.searchsorted(track.times, middles, side="right") - 1, 0, len(track.times) - 1)
    inside: Flags = (middles >= track.times[0]) & (middles <= track.times[-1])
    moving = np.zeros(len(middles), dtype=bool)
    for since, until in way[1]:
        moving |= (middles >= since) & (middles <= until)
    return inside & moving & ~track.broken[before]
