"""How near robots came to what they must keep away from, measured to the shapes as drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from mmrs_core.analysis.distance import prism_distances
from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.flights.places import Place
from mmrs_core.pictures.flights.values import Track
from mmrs_core.pictures.report.values import Approach
from mmrs_core.scene import Area, AreaUse, Position

_AT_ONCE = 512


def approaches_of(
    robot: str,
    track: Track,
    areas: Iterable[Area],
    own: float | None,
    place_of: Callable[[Position], Place],
    error: float = 0.0,
) -> Iterator[Approach]:
    """Yield the nearest approach of a robot to each area that it must keep away from.

    Between two fixes it is taken to have gone straight; nothing is known of gaps.

    Args:
        areas: that concern the robot, as drawn.
        own: half its diagonal and the position error, metres; None where they are not known.
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
    """Return begins, ends and times of what a robot went straight; single fixes stay where they are."""
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
    """Return the smallest distance to an area, and the index of the piece that is so near.

    Boxes tell which pieces cannot be the nearest; of these no exact distance is taken.
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
