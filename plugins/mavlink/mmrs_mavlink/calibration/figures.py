"""Figures of a robot type from one flight: each with its unit, its number of values, median and spread."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import degrees, inf, isfinite

import numpy as np

from mmrs_core.scene.timing import STANDING, Rates
from mmrs_runtime.timing import LegTiming

from ..profiles import VehicleProfile
from ..profiles.modes import AUTO, GUIDED
from ..profiles.pacing import UNKNOWN
from .curves import FEWEST, LARGEST_JERK, Ramp, plateaus_in, ramps_in, with_jerk
from .flight import Flags, Flight, Floats
from .motion import (
    EVEN_SECONDS,
    Gain,
    Leg,
    climbs_of,
    corners_passed,
    gain_of,
    landings_of,
    legs_of,
    level_speeds,
    spin_ups_of,
    turns_of,
    vertical_ramps,
)

STEP, MISSION = "STEP", "MISSION"
WAYS = {STEP: GUIDED, MISSION: AUTO}
"""Modes of a vehicle's profile, by how its legs are flown: one target at a time, or as a mission."""

SLOWEST_RATE = 3.0
"""Positions per second below which changes of speed cannot be judged."""

CHARGED = 0.02
"""Rise of the charge from which on a battery was charged; less is noise."""

_USUAL_STILL = 0.3

CLEAR = 0.5
"""Share of a leg's thrust that the leg before may have left, or against it, for the lag to be judged."""

COULOMBS = 3.6
"""In a milliampere-hour."""

ENOUGH = 3
"""Values of a figure at least that is to be written."""

FROM_ALL = frozenset({"overshoot", "lifetime"})
"""Figures of which a flight has one value, from all of it."""

WIDEST, NOISE = 0.5, 1.0
"""Spread of a figure at most, as a share of its median, and seconds that times may spread in any case."""


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure of a robot type.

    Attributes:
        name: of the attribute of the robot language. unit: of its value.
        flown_as: how the legs were flown that it holds for; empty: any.
        values: every time that it was seen, in ascending order.
        missing: why there is none; empty where there are values.
        doubt: why it is not to be written; empty where it may be.
    """

    name: str
    unit: str
    flown_as: str = ""
    values: tuple[float, ...] = ()
    missing: str = ""
    doubt: str = ""

    @property
    def median(self) -> float:
        """Return the median of the values."""
        return float(np.median(self.values))

    @property
    def spread(self) -> tuple[float, float]:
        """Return what lies between the lowest and the highest tenth of the values."""
        low, high = np.percentile(self.values, (10.0, 90.0))
        return float(low), float(high)


def _figure(name: str, unit: str, values: Iterable[float], missing: str, flown_as: str = "") -> Figure:
    found = tuple(sorted(each for each in values if isfinite(each)))
    if not found:
        return Figure(name, unit, flown_as, (), missing)
    return Figure(name, unit, flown_as, found, doubt="" if name in FROM_ALL else _doubt(found, unit))


def _doubt(values: Sequence[float], unit: str = "") -> str:
    """Return why a figure of these values is not to be written; empty where it may be."""
    if len(values) < ENOUGH:
        return f"fewer than {ENOUGH} values"
    low, high = np.percentile(values, (10.0, 90.0))
    most = max(WIDEST * abs(float(np.median(values))), NOISE if unit == "s" else 0.0)
    return "its values differ by more than half of their median" if high - low > most else ""


def _sure(values: Sequence[float], usual: float) -> float:
    """Return the median of values, or what is usual where it is in doubt."""
    return usual if isfinite(usual) and _doubt(values) else float(np.median(values))


def fastest(values: Sequence[float], part: float = 0.9) -> list[float]:
    """Return the values that come near to the largest one: others were not meant to be as fast."""
    return [each for each in values if each >= part * max(values)]


def figures_of(flight: Flight, capacity: float | None = None) -> tuple[Figure, ...]:
    """Return the figures of a flight: those of each way of flying legs, then those of all.

    Args:
        capacity: of the vehicle's batteries, in coulombs; None: as the log tells.
    """
    return (
        *_leg_figures(flight, STEP),
        *_leg_figures(flight, MISSION),
        _turn_rate(flight),
        *_end_figures(flight),
        *_energy_figures(flight, capacity),
    )


@dataclass(frozen=True, slots=True)
class _Levels:
    """The level motion of one way of flying.

    Attributes:
        chosen: samples that count. speeds: in the plane. ramps: changes of it of at least `least`.
        missing: why there are none; empty where there may be.
    """

    chosen: Flags
    speeds: Floats
    ramps: tuple[Ramp, ...]
    missing: str
    least: float = 0.0


def levels_of(flight: Flight, flown_as: str) -> _Levels:
    """Return the level motion of one way of flying."""
    speeds, mode = level_speeds(flight), WAYS[flown_as]
    nothing = np.zeros(len(speeds), dtype=np.bool_)
    if flight.profile is None:
        return _Levels(nothing, speeds, (), "unknown vehicle: its modes have no names")
    chosen = flight.in_mode(flight.profile.modes[mode].number, flight.times)
    chosen &= flight.while_armed(flight.times)
    if not chosen.any():
        return _Levels(chosen, speeds, (), f"not flown in {mode}")
    if flight.rate < SLOWEST_RATE:
        return _Levels(chosen, speeds, (), f"{flight.rate:.1f} positions per second are too few")
    least = max(0.15, 0.15 * float(np.percentile(speeds[chosen], 98.0)))
    found = (each for each in ramps_in(flight.times, speeds, least) if chosen[[each.first, each.last]].all())
    return _Levels(chosen, speeds, tuple(found), "", least)


def _leg_figures(flight: Flight, flown_as: str) -> Iterator[Figure]:
    level = levels_of(flight, flown_as)
    still = _still(flight.profile)

    def figure(name: str, unit: str, values: Iterable[float], missing: str) -> Figure:
        return _figure(name, unit, () if level.missing else values, level.missing or missing, flown_as)

    fitting = [each for each in level.ramps if each.fits]
    rising = [each for each in fitting if each.rising]
    jerks = [each.jerk for each in rising]
    speeding = [each.acceleration for each in rising if each.keeps]
    kept = plateaus_in(flight.times, np.where(level.chosen, level.speeds, 0.0), 2.0 * still, EVEN_SECONDS)
    tops = [each.value for each in kept]
    slowing = _decelerations(flight, level, fitting, float(np.median(jerks)) if jerks else 0.0)
    short = "no leg was long enough for it"
    yield figure("maxSpeed", "m/s", fastest(tops) if tops else (), "no speed was kept for 2 s")
    yield figure("maxAcceleration", "m/s²", fastest(speeding, 0.8) if speeding else (), short)
    yield figure(
        "maxDeceleration",
        "m/s²",
        fastest(slowing, 0.8) if slowing else (),
        f"{short}, so take it for maxAcceleration",
    )
    yield figure("maxJerk", "m/s³", jerks, "no change of speed is an S-curve")
    yield from _vertical_figures(flight, level, figure, float(np.median(jerks)) if jerks else inf)
    if flown_as == MISSION:
        passed = corners_passed(flight, level.chosen, max(2.0 * still, level.least))
        yield figure("cornerRadius", "m", passed, "no corner was passed without a stop")
    overshoot: float | None = None
    settled = list[float]()
    straight = list(legs_of(flight, level.ramps, still))
    gains = _gains(flight, straight)
    if speeding and jerks and tops:
        usual = usual_timing(flight.profile, flown_as)
        a, j = _sure(fastest(speeding, 0.8), usual.acceleration), _sure(jerks, usual.jerk)
        d = (
            _sure(fastest(slowing, 0.8), usual.braking)
            if slowing
            else usual.braking
            if usual.braking < inf
            else a
        )
        timing = LegTiming(acceleration=a, deceleration=d, jerk=j)
        legs = [each for each in straight if isfinite(each.done - each.begun)]
        lag, within = usual.lag, usual.lag_within
        if gains:
            lag = float(np.median([each.lag for each in gains]))
            within = float(np.median([each.seconds for each in gains]))
        timing = replace(timing, lag=lag, lag_within=within)
        overshoot, settled = _beside(legs, timing, max(tops), usual.overshoot)
    missing = "no straight leg between two stops, or the log does not hold when targets were given"
    unclear = "the legs do not show it: fly short and long ones" if settled else missing
    if not (speeding and jerks and tops):
        missing = unclear = "no acceleration and speed to judge legs by"
    yield figure("overshoot", "s", () if overshoot is None else (overshoot,), unclear)
    yield figure("settlingTime", "s", settled, missing)
    even = "no speed was kept for long that the vehicle came near to only with time"
    yield figure("lag", "s", (each.lag for each in gains), even)
    yield figure("lagTime", "s", (each.seconds for each in gains), even)


def usual_timing(profile: VehicleProfile | None, flown_as: str) -> LegTiming:
    """Return how a vehicle's autopilot takes legs, whose lag counts where the legs do not show it."""
    pacing = UNKNOWN if profile is None else profile.pacing
    return pacing.mission if flown_as == MISSION and pacing.mission is not None else pacing.step


def _still(profile: VehicleProfile | None) -> float:
    return profile.still if profile is not None else _USUAL_STILL


def _decelerations(flight: Flight, level: _Levels, fitting: Iterable[Ramp], jerk: float) -> list[float]:
    """Return how fast the vehicle slows down, by curves of the jerk at which it speeds up."""
    if jerk <= 0.0:
        return []
    slowing = [each for each in fitting if not each.rising]
    found = [(each, with_jerk(flight.times, level.speeds, each, jerk)) for each in slowing]
    return [value for each, value in found if each.change * jerk >= 1.5 * value**2]


def _beside(
    legs: Sequence[Leg], timing: LegTiming, fastest: float, usual: float
) -> tuple[float | None, list[float]]:
    """Return how far a vehicle goes beyond its targets, and what legs take beside their S-curves and that.

    A vehicle that goes beyond its target by a share of its speed takes the longer, the faster the leg was.
    Where the legs do not show that clearly, it is unknown: None, and they go beyond it as usual.

    Args:
        timing: acceleration, deceleration and jerk.
        fastest: speed that was kept.
        usual: how far its autopilot goes beyond targets.
    """

    def going(hundredths: int) -> LegTiming:
        return replace(timing, overshoot=hundredths / 100.0)

    tops = [each.speeding_up.high for each in legs]
    plain = lefts(legs, replace(timing, overshoot=usual), fastest)
    if len(legs) < FEWEST or max(tops) < 1.5 * min(tops):
        return None, plain
    best = min(range(1, 31), key=lambda number: _width(lefts(legs, going(number), fastest)))
    left = lefts(legs, going(best), fastest)
    return (best / 100.0, left) if _width(left) < 0.7 * _width(plain) else (None, plain)


def _gains(flight: Flight, legs: Sequence[Leg]) -> list[Gain]:
    """Return how fast the vehicle came near to its speed on legs, each as if it had begun without thrust."""
    found, push = list[Gain](), STANDING
    for leg in legs:
        if (gain := gain_of(flight, leg)) is None:
            push = STANDING
            continue
        rates = Rates(gain.speed, 1.0, 1.0, LegTiming(lag=gain.lag, lag_within=gain.seconds))
        left = sum(one * two for one, two in zip(push, leg.way, strict=True)) / leg.length
        if abs(left) < CLEAR:
            found.append(replace(gain, lag=gain.lag / (1.0 - left)))
        push = rates.push((0.0, 0.0, 0.0), (*leg.way, 0.0), push) or STANDING
    return found


def lefts(legs: Sequence[Leg], timing: LegTiming, fastest: float) -> list[float]:
    """Return by how much legs took longer than they are planned to, in their order."""
    found, push = list[float](), STANDING
    for leg in legs:
        cruise = leg.cruise if isfinite(leg.cruise) and not timing.lag else fastest
        rates = Rates(cruise, climb=cruise, descent=cruise, timing=timing)
        here, there = (0.0, 0.0, 0.0), (*leg.way, 0.0)
        found.append(leg.done - leg.begun - rates.from_stop_to_stop(here, there, push=push))
        push = rates.push(here, there, push) or STANDING
    return found


def _width(values: Sequence[float]) -> float:
    low, high = np.percentile(values, (10.0, 90.0))
    return float(high - low)


_MakesFigure = Callable[[str, str, Iterable[float], str], Figure]


def _vertical_figures(flight: Flight, level: _Levels, figure: _MakesFigure, jerk: float) -> Iterator[Figure]:
    accelerations: list[float] = []
    for name, sign in (("maxClimbRate", 1.0), ("maxDescentRate", -1.0)):
        rates = [each.value for each in climbs_of(flight, level.chosen, sign)]
        yield figure(name, "m/s", fastest(rates) if rates else (), "no upright leg was long enough for it")
        ramps = vertical_ramps(flight, level.chosen, sign)
        speeds = np.maximum(sign * flight.velocities[:, 2], 0.0)
        accelerations += [with_jerk(flight.times, speeds, each, min(jerk, LARGEST_JERK)) for each in ramps]
    missing = "no upright leg was long enough for it"
    yield figure("maxVerticalAcceleration", "m/s²", accelerations, missing)


def _turn_rate(flight: Flight) -> Figure:
    rates = [degrees(each) for each in turns_of(flight)]
    missing = "the heading never changed by 45°" if np.isfinite(flight.headings).any() else "no headings"
    return _figure("maxTurnRate", "°/s", fastest(rates, 0.8) if rates else (), missing)


def _end_figures(flight: Flight) -> Iterator[Figure]:
    """Yield the figures of take-offs and landings, of a vehicle that flies."""
    if flight.profile is None or not flight.profile.flies:
        return
    landings = list(landings_of(flight))
    none = "no landing until the motors stopped"
    yield _figure("launchTime", "s", spin_ups_of(flight), "no command to take off")
    yield _figure("landingRate", "m/s", (each.rate for each in landings), none)
    yield _figure("landingHeight", "m", (each.height for each in landings), none)
    yield _figure("recoveryTime", "s", (each.stopping for each in landings), none)


def _energy_figures(flight: Flight, capacity: float | None) -> Iterator[Figure]:
    yield _figure("meanPower", "W", _powers(flight), "no voltage and current while it moved")
    lifetime, missing = _lifetime(flight, capacity)
    yield _figure("lifetime", "s", lifetime, missing)


def in_flight(flight: Flight, times: Floats) -> Flags:
    """Return at which times the vehicle was armed, between its first and its last motion."""
    moving = np.flatnonzero(np.linalg.norm(flight.velocities, axis=1) > _still(flight.profile))
    if not len(moving):
        return np.zeros(len(times), dtype=np.bool_)
    first, last = flight.times[moving[0]], flight.times[moving[-1]]
    found: Flags = flight.while_armed(times) & (times >= first) & (times <= last)
    return found


def _powers(flight: Flight) -> Iterator[float]:
    """Yield the mean power of each ten seconds."""
    taken = flight.power[in_flight(flight, flight.power[:, 0])]
    if len(taken) < FEWEST or not (taken[:, 2] > 0.0).any():
        return
    watts = taken[:, 1] * taken[:, 2]
    tens = ((taken[:, 0] - taken[0, 0]) // 10.0).astype(int)
    for number in np.unique(tens):
        part = watts[tens == number]
        if len(part) >= FEWEST:
            yield float(part.mean())


def _lifetime(flight: Flight, capacity: float | None) -> tuple[tuple[float, ...], str]:
    """Return how long a full battery lasts, by its capacity and the current, or else by its charge."""
    taken = flight.power[in_flight(flight, flight.power[:, 0])]
    if capacity is None:
        capacity = flight.parameters.get("BATT_CAPACITY", 0.0) * COULOMBS
    if len(taken) >= FEWEST and capacity > 0.0 and (current := float(taken[:, 2].mean())) > 0.0:
        return (capacity / current,), ""
    charges = flight.charges[in_flight(flight, flight.charges[:, 0])]
    if len(charges) and (charges[:, 1] - np.minimum.accumulate(charges[:, 1])).max() > CHARGED:
        return (), "it was charged, or its battery changed, in between: take the log of one sortie"
    if len(charges) >= 2 and (used := float(charges[0, 1] - charges[-1, 1])) >= 0.1:
        return (float(charges[-1, 0] - charges[0, 0]) / used,), ""
    return (), "no current with the battery's capacity (BATT_CAPACITY), and no tenth of a charge was used"
