"""What robots used of their batteries, and what was left."""

from __future__ import annotations

import numpy as np

from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.flights.flight import Flown
from mmrs_core.pictures.report.contents import EnergyReport
from mmrs_core.simulation.run import SimulatedRun

_CHARGED = 0.05
"""Part of a battery by which a level rises when it was charged or changed, and not only read otherwise."""


def energy_of(flown: Flown, plan: SimulatedRun | None, reserve: float) -> EnergyReport:
    """Return what is known of one robot's energy, as flown and as planned."""
    levels = flown.track.energies
    known = np.isfinite(levels)
    left, times = levels[known], flown.track.times[known]
    planned, capacity = planned_levels(plan, flown.robot)
    lowest = int(left.argmin()) if len(left) else None
    return EnergyReport(
        flown.robot,
        used(planned) if len(planned) else None,
        used(left) if len(left) else None,
        float(left[lowest]) if lowest is not None else None,
        float(times[lowest]) if lowest is not None else None,
        float(planned.min()) if len(planned) else None,
        float(left[-1]) if len(left) else None,
        reserve,
        capacity,
    )


def planned_levels(plan: SimulatedRun | None, robot: str) -> tuple[Floats, float | None]:
    """Return the parts that are left in the plan, and joules when full; empty and None where not known."""
    track = plan.tracks.get(robot, ()) if plan is not None else ()
    full = track[0].energy if track else None
    if not full or full == float("inf"):
        return np.empty(0), None
    return np.array([sample.energy / full for sample in track if sample.energy is not None]), full


def used(levels: Floats) -> float:
    """Return the sum of what was used between charges, as a part of a full battery.

    A level that rises is one that is charged, or read otherwise than before; neither is anything used.

    >>> round(used(np.array([1.0, 0.6, 0.61, 0.5, 1.0, 0.9])), 3)
    0.6
    >>> round(used(np.array([1.0, 0.2, 0.24, 0.28, 0.34, 0.33, 0.4, 0.3])), 3)
    0.9
    """
    total, since = 0.0, float(levels[0])
    least = since
    for level in levels.tolist():
        if level > min(since, least + _CHARGED):
            total += since - least if since - least > _CHARGED else 0.0
            since = least = level
        least = min(least, level)
    return total + since - least
