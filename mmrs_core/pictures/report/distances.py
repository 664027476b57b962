"""How near robots came to what they must keep away from, and to each other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from mmrs_core.analysis.distance import prism_distances
from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.flights.flight import Flown
from mmrs_core.pictures.flights.planned import PlannedLeg, Stretch, without
from mmrs_core.pictures.flights.positions import GeoPosition
from mmrs_core.pictures.flights.tracks import Flags, Track
from mmrs_core.pictures.report.contents import Approach, Separation
from mmrs_core.scene import Area, AreaUse, Position

_AT_ONCE = 512
_RECHARGE = (BEHAVIOUR, "Recharge")

Moving = tuple[Flown, Sequence[Stretch]]
"""A robot, and when it was in motion."""


def approaches_of(
    robot: str,
    track: Track,
    areas: Iterable[Area],
    own: float | None,
    place_of: Callable[[Position], GeoPosition],
    error: float = 0.0,
) -> Iterator[Approach]:
    """Yield the nearest approach of a robot to each area that it must keep away from.

    It is assumed to have gone straight between two fixes; gaps are unknown.

    Args:
        areas: that concern the robot, as drawn.
        own: half its diagonal and the position error, metres; None where they are unknown.
        error: the position error alone, metres.
    """
    begins, ends, times = _segments(track)
    if not len(begins):
        return
    for area in areas:
        if area.use is AreaUse.EMERGENCY:
            continue
        kept, index = _nearest(begins, ends, area)
        middle = ((begins[index] + ends[index]) / 2).tolist()
        required = None if own is None else area.safety_distance + own
        where = place_of((middle[0], middle[1], middle[2]))
        yield Approach(kept, required, error, where, float(times[index]), robot, area.name, area.use.value)


def _segments(track: Track) -> tuple[Floats, Floats, Floats]:
    """Return begins, ends and times of straight segments of a track; lone fixes are points."""
    if len(track.times) < 2:
        return track.positions, track.positions, track.times
    known = ~track.broken[:-1]
    begins, ends = track.positions[:-1], track.positions[1:]
    lone = np.r_[True, ~known] & np.r_[~known, True]
    singles = track.positions[lone]
    return (
        np.concatenate([begins[known], singles]),
        np.concatenate([ends[known], singles]),
        np.concatenate([track.times[:-1][known], track.times[lone]]),
    )


def _nearest(begins: Floats, ends: Floats, area: Area) -> tuple[float, int]:
    """Return the smallest distance to an area, and the index of the segment that is so near.

    Boxes exclude segments that cannot be the nearest.
    """
    least = _box_distances(begins, ends, area)
    order: NDArray[np.intp] = np.argsort(least, kind="stable")
    best, index = float("inf"), 0
    for since in range(0, len(order), _AT_ONCE):
        chosen = order[since : since + _AT_ONCE]
        if least[chosen[0]] > best:
            break
        exact = prism_distances(begins[chosen], ends[chosen], area.shell, area.low, area.high)
        nearest = int(exact.argmin())
        if exact[nearest] < best:
            best, index = float(exact[nearest]), int(chosen[nearest])
    return best, index


def _box_distances(begins: Floats, ends: Floats, area: Area) -> Floats:
    shell = np.asarray(area.shell, dtype=np.float64)
    low, high = np.append(shell.min(axis=0), area.low), np.append(shell.max(axis=0), area.high)
    gaps = np.maximum(np.maximum(low - np.maximum(begins, ends), np.minimum(begins, ends) - high), 0.0)
    distances: Floats = np.linalg.norm(gaps, axis=1)
    return distances


def separations_of(
    robots: Sequence[Moving],
    required: float | None,
    place_of: Callable[[Position], GeoPosition],
    error: float = 0.0,
) -> Iterator[Separation]:
    """Yield how near each two robots came to each other that were in motion at one time.

    Each is assumed to have gone straight at a constant speed between fixes; gaps are unknown.

    Args:
        required: metres that they had to keep; None where nothing is required.
        error: the part of them that allows for position errors.
    """
    for one, other in combinations(robots, 2):
        found = _nearest_pair(one, other)
        if found is not None:
            kept, time, (east, north, up) = found
            where = place_of((east, north, up))
            yield Separation(kept, required, error, where, time, one[0].robot, other[0].robot)


def in_motion(flown: Flown, legs: Sequence[PlannedLeg]) -> tuple[Stretch, ...]:
    """Return when a robot was in motion: from its first move that moves to its last, charging excluded.

    One whose program ended early is in motion until the end of its record.
    """
    moving = [leg for leg in legs if len(set(leg.way)) > 1]
    if not moving:
        return ()
    early = flown.records[-1].label == "fault" or not moving[-1].ended
    charging = ((leg.begin, leg.end) for leg in legs if leg.move.is_a(_RECHARGE))
    return tuple(without((moving[0].begin, flown.end if early else moving[-1].end), charging))


def _nearest_pair(first_moving: Moving, second_moving: Moving) -> tuple[float, float, Position] | None:
    """Return the smallest distance, when it was, and where the first robot was then."""
    one, other = first_moving[0].track, second_moving[0].track
    ends = np.array(
        [time for _, stretches in (first_moving, second_moving) for stretch in stretches for time in stretch]
    )
    times = np.union1d(np.union1d(one.times, other.times), ends)
    known = _known(first_moving, times) & _known(second_moving, times)
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


def _known(moving_robot: Moving, times: Floats) -> Flags:
    """Return for each time whether until the next the position of the robot in motion is known, (n - 1,)."""
    track = moving_robot[0].track
    if not len(track.times) or len(times) < 2:
        return np.zeros(max(len(times) - 1, 0), dtype=bool)
    middles = (times[:-1] + times[1:]) / 2
    before = np.clip(np.searchsorted(track.times, middles, side="right") - 1, 0, len(track.times) - 1)
    inside: Flags = (middles >= track.times[0]) & (middles <= track.times[-1])
    moving = np.zeros(len(middles), dtype=bool)
    for since, until in moving_robot[1]:
        moving |= (middles >= since) & (middles <= until)
    return inside & moving & ~track.broken[before]
