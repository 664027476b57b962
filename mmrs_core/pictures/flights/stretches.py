"""Cuts tracks into pieces without gaps."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

import numpy as np

from mmrs_core.pictures.flights.values import Track
from mmrs_core.scene import Position

Piece: TypeAlias = tuple[tuple[float, ...], tuple[Position, ...]]
"""Times and positions, as many."""


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
