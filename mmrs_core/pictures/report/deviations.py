"""How far robots were off their planned paths."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.flights.flight import Flown
from mmrs_core.pictures.flights.planned import PlannedLeg, away_of, without
from mmrs_core.pictures.flights.positions import GeoPosition
from mmrs_core.pictures.flights.tracks import nearest
from mmrs_core.pictures.report.contents import Deviation, Spread
from mmrs_core.scene import Position

_ON_GROUND = tuple((BEHAVIOUR, name) for name in ("Start", "Stop", "Recharge"))


def deviation_of(
    flown: Flown, legs: Sequence[PlannedLeg], place_of: Callable[[Position], GeoPosition]
) -> Deviation | None:
    """Return how far a robot was off its planned paths, over all fixes on them.

    Responses of policies belong to no planned path. None where there is no fix on one.
    """
    parts = list(_by_leg(flown, legs))
    if not parts:
        return None
    times = np.concatenate([part[1] for part in parts])
    off = np.concatenate([part[2] for part in parts])
    moves = [part[0] for part in parts for _ in part[1]]
    positions = np.concatenate([part[3] for part in parts])
    sideways, upwards = np.hypot(off[:, 0], off[:, 1]), np.abs(off[:, 2])
    farthest, highest = int(sideways.argmax()), int(upwards.argmax())
    east, north, up = positions[farthest].tolist()
    return Deviation(
        flown.robot,
        len(times),
        _spread(sideways),
        _spread(upwards),
        place_of((east, north, up)),
        float(times[farthest]),
        moves[farthest],
        float(times[highest]),
        moves[highest],
    )


def deviations_over_time(flown: Flown, legs: Sequence[PlannedLeg]) -> list[tuple[Floats, Floats]]:
    """Return (times, metres sideways) of each piece of a planned path, for a chart."""
    return [(times, np.hypot(off[:, 0], off[:, 1])) for _, times, off, _ in _by_leg(flown, legs)]


def _by_leg(flown: Flown, legs: Sequence[PlannedLeg]) -> Iterator[tuple[str, Floats, Floats, Floats]]:
    """Yield (move, times, offsets, positions) of each piece of a leg that fixes are on."""
    track, away = flown.track, away_of(flown, legs)
    for leg in legs:
        if not leg.way or any(leg.move.is_a(kind) for kind in _ON_GROUND):
            continue
        for begin, end in without((leg.begin, leg.end), away):
            inside = slice(*np.searchsorted(track.times, [begin, end], side="left"))
            times, positions = track.times[inside], track.positions[inside]
            if len(times):
                yield leg.move.id, times, positions - nearest(positions, np.array(leg.way))[0], positions


def _spread(values: Floats) -> Spread:
    median, most = np.quantile(values, [0.5, 0.95])
    return Spread(float(median), float(most), float(values.max()))
