"""Which figures of flights are good enough to be written, judged by these flights."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite

from mmrs_core.scene.timing import Rates

from .attributes import TIMING
from .figures import ENOUGH, FASTEST, MISSION, STEP, Current, Figure, found_by, held, lefts, levels_of, still
from .flight import Flight
from .motion import landings_of, legs_of

CURVES = {"maxAcceleration", "maxDeceleration", "maxJerk", "settlingTime", "overshoot", "lag", "lagTime"}
"""Figures that level legs from a stop to a stop show together."""

LEGS = 2
"""Legs for each of them, at least."""

LANDING = ("landingRate", "landingHeight", "recoveryTime")

FURTHER = "would be planned further from what they took than with what the type states"


def judged(flights: Sequence[Flight], figures: Sequence[Figure], current: Current) -> tuple[Figure, ...]:
    """Return the figures with what keeps some from being written.

    Those of legs hold together, and those of landings: they are written where all legs of the flights
    together, from a stop to a stop, or all landings, are planned with them no further from what they took
    than with what the type states.

    Args:
        flights: that the figures are of.
        figures: as `figures_of` returns them.
        current: what the type states; nothing where there is none.
    """
    legs = [
        ([each for each in figures if each.flown_as == flown_as and each.name in TIMING], flown_as)
        for flown_as in (STEP, MISSION)
    ]
    landings = [each for each in figures if each.name in LANDING]
    causes = [(each, _against(flights, each, flown_as, current)) for each, flown_as in legs]
    causes.append((landings, _against_landings(flights, landings, current)))
    kept_out = {(each.name, each.flown_as): why for group, why in causes for each in group if each.values}
    return tuple(
        replace(each, doubt=each.doubt or kept_out.get((each.name, each.flown_as), "")) for each in figures
    )


def _against(flights: Sequence[Flight], figures: Sequence[Figure], flown_as: str, current: Current) -> str:
    """Return why figures of legs are not to be written; empty where they may be."""
    new, profile = found_by(figures), flights[0].profile
    legs = [
        [
            each
            for each in legs_of(flight, levels_of(flight, flown_as).ramps, still(profile))
            if isfinite(each.done - each.begun)
        ]
        for flight in flights
    ]
    needed = max(ENOUGH, LEGS * len(CURVES & new.keys()))
    if not new:
        return ""
    if sum(map(len, legs)) < needed:
        return f"fewer than {needed} legs between two stops, of which the log tells when they were commanded"
    before, after = (
        sum(map(abs, lefts(legs, held(profile, flown_as, current, found)))) for found in ({}, new)
    )
    return f"with them, legs {FURTHER}" if after > before else ""


def _against_landings(flights: Sequence[Flight], figures: Sequence[Figure], current: Current) -> str:
    """Return why figures of landings are not to be written; empty where they may be."""
    new, profile = found_by(figures), flights[0].profile
    if not new or profile is None:
        return ""
    pacing = profile.pacing
    timing = pacing.upright or held(profile, STEP, current)
    rates = Rates(FASTEST, timing.climb, timing.descent, timing)
    usual = dict(
        zip(LANDING, (pacing.landing_rate, pacing.landing_height, pacing.recovery or 0.0), strict=True)
    )
    stated = {name: value for name in LANDING if (value := current(name, "")) is not None}

    def beside(values: Mapping[str, float]) -> float:
        rate, height, stopping = (values[name] for name in LANDING)
        landings = [each for flight in flights for each in landings_of(flight)]
        slow = [min(height, each.drop) for each in landings]
        planned = [rates.rise(low - each.drop) + low / rate for low, each in zip(slow, landings, strict=True)]
        return abs(sum(each.seconds for each in landings) - sum(planned) - len(landings) * stopping)

    return f"with them, landings {FURTHER}" if beside(usual | stated | new) > beside(usual | stated) else ""
