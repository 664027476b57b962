"""When robots were off their paths because of a policy: returning, at home, and coming back."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.flights.flight import Flown
from mmrs_core.pictures.flights.planned import PlannedLeg
from mmrs_core.pictures.flights.tracks import Track, nearest

AWAY = frozenset({"RETURN", "LAND", "EMERGENCY_AREA", "SURFACE", "STOP_THRUST"})
"""Responses by which a robot leaves its path."""
BACK = 2.0
"""Metres from its path within which a robot that was away is back."""

Stretch = tuple[float, float]


def away_of(flown: Flown, legs: Sequence[PlannedLeg]) -> tuple[Stretch, ...]:
    """Return when a robot was off its paths, by the decisions in its black box.

    It is back at the nearest point to the path that it left, or to the position at which it waited. A
    robot that never comes back is away to the end.
    """
    stretches: list[Stretch] = []
    for decision in flown.of_kind("decision"):
        done = stretches and decision.time <= stretches[-1][1]
        if decision.content.get("response") in AWAY and not done:
            stretches.append((decision.time, _back(flown, decision.time, legs)))
    return tuple(stretches)


def without(stretch: Stretch, away: Iterable[Stretch]) -> list[Stretch]:
    """Return what is left of a stretch of time.

    >>> without((0.0, 10.0), [(2.0, 4.0), (9.0, 20.0)])
    [(0.0, 2.0), (4.0, 9.0)]
    """
    since, end = stretch
    left: list[Stretch] = []
    for begin, until in away:
        if until > since and begin < end:
            left += [(since, begin)] if begin > since else []
            since = max(since, until)
    return [*left, (since, end)] if since < end else left


def _back(flown: Flown, time: float, legs: Sequence[PlannedLeg]) -> float:
    track = flown.track
    way = _left_path(track, time, legs)
    first = int(np.searchsorted(track.times, time))
    if way is None or first >= len(track.times):
        return flown.end
    positions = track.positions[first:]
    off = np.linalg.norm(positions - nearest(positions, way)[0], axis=1)
    gone = np.flatnonzero(off > BACK)
    if not len(gone):
        return time
    near = np.flatnonzero(off[gone[0] :] <= BACK)
    if not len(near):
        return flown.end
    at = int(gone[0] + near[0])
    while at + 1 < len(off) and off[at + 1] < off[at]:
        at += 1
    return float(track.times[first + at])


def _left_path(track: Track, time: float, legs: Sequence[PlannedLeg]) -> Floats | None:
    on = next((leg.way for leg in legs if leg.begin <= time <= leg.end and leg.way), None)
    at = track.at(time)
    if on is not None:
        return np.array(on)
    return None if at is None else np.array([at])
