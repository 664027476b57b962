"""Which figures of a flight are good enough to be written, judged by the flight itself."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from math import isfinite

from mmrs_core.grounding.robots import LEG_FIGURES
from mmrs_core.scene import Capability

from .attributes import TIMING
from .figures import ENOUGH, MISSION, STEP, Figure, lefts, levels_of, usual_timing
from .flight import Flight
from .motion import legs_of

Current = Callable[[str, str], float | None]
"""What the type states of an attribute, by how legs are flown; None: nothing."""


def judged(flight: Flight, figures: Sequence[Figure], current: Current) -> tuple[Figure, ...]:
    """Return the figures with what keeps some from being written.

    Those of legs hold together: they are written where all legs of the flight together, from a stop to a
    stop, take with them what they took, or are less beside it than with what the type states.

    Args:
        flight: that the figures are of.
        figures: as `figures_of` returns them.
        current: what the type states; nothing where there is none.
    """
    found = list(figures)
    for flown_as in (STEP, MISSION):
        why = _against(flight, [each for each in found if each.flown_as == flown_as], flown_as, current)
        found = [
            replace(each, doubt=each.doubt or why)
            if why and each.values and each.flown_as == flown_as and each.name in TIMING
            else each
            for each in found
        ]
    return tuple(found)


def _against(flight: Flight, figures: Sequence[Figure], flown_as: str, current: Current) -> str:
    """Return why figures of legs are not to be written; empty where they may be."""
    new = {LEG_FIGURES[each.name]: max(0.0, each.median) for each in _writable(figures)}
    stated = {name: current(name, flown_as) for name in LEG_FIGURES}
    old = {LEG_FIGURES[name]: value for name, value in stated.items() if value is not None}
    level = levels_of(flight, flown_as)
    still = 0.3 if flight.profile is None else flight.profile.still
    legs = [each for each in legs_of(flight, level.ramps, still) if isfinite(each.done - each.begun)]
    if not new or len(legs) < ENOUGH:
        return "too few legs between two stops, of which the log tells when they were commanded"
    tops = max(each.speeding_up.high for each in legs)

    def beside(stated: Mapping[str, float]) -> float:
        capability = Capability(
            payload=0.0,
            lifetime=None,
            speed=(0.0, 1000.0),
            acceleration=current("maxAcceleration", ""),
            leg_timings={flown_as: stated},
        )
        return abs(
            sum(lefts(legs, capability.timing(flown_as, usual_timing(flight.profile, flown_as)), tops))
        )

    before, after = beside(old), beside(old | new)
    return (
        ""
        if after <= before
        else "with them, legs would be planned further from what they took than with what the type states"
    )


def _writable(figures: Iterable[Figure]) -> Iterable[Figure]:
    return (each for each in figures if each.values and not each.doubt and each.name in TIMING)
