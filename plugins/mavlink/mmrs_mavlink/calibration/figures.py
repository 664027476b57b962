"""Figures of a robot type from flights: each with its unit, its number of values, median and spread."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees, inf, isfinite, radians, tan

import numpy as np

from mmrs_core.grounding.robots import LEG_FIGURES
from mmrs_core.scene import Capability
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
    Passage,
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

FASTEST = 1000.0
"""Metres per second that no vehicle makes."""

CLEAR = 0.5
"""Share of a leg's thrust that the leg before may have left, or against it, for the lag to be judged."""

SLOWED, TURNED_ROUND = 0.9, radians(150.0)
"""Share of the speed of its legs at which a corner is passed at most for which the vehicle slowed down; and
turn up to which that shows a circle."""

COULOMBS = 3.6
"""In a milliampere-hour."""

ENOUGH = 3
"""Values of a figure at least that is to be written."""

FROM_ALL = frozenset({"overshoot", "lifetime"})
"""Figures of which a flight has one value, from all of it."""

WIDEST, NOISE = 0.5, 1.0
"""Spread of a figure at most, as a share of its median, and seconds that times may spread in any case."""

HOLDS = "what the type states, or else its autopilot's default, is within the spread, and holds"

Current = Callable[[str, str], float | None]
"""What the type states of an attribute, by how legs are flown, or empty; None: nothing."""


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


def nothing(_name: str, _flown_as: str) -> None:
    """State nothing of any attribute."""


def held(
    profile: VehicleProfile | None, flown_as: str, current: Current, found: Mapping[str, float] | None = None
) -> LegTiming:
    """Return how legs are taken, by figures that were found, by the type, or else by its autopilot."""
    pacing = UNKNOWN if profile is None else profile.pacing
    stated = {name: current(name, flown_as) for name in LEG_FIGURES} | dict(found or {})
    known = {LEG_FIGURES[name]: value for name, value in stated.items() if value is not None}
    if "acceleration" in known:
        known.setdefault("deceleration", known["acceleration"])
    capability = Capability(
        payload=0.0,
        lifetime=None,
        speed=(0.0, FASTEST),
        acceleration=current("maxAcceleration", ""),
        climb_rate=current("maxClimbRate", ""),
        descent_rate=current("maxDescentRate", ""),
        leg_timings={flown_as: known},
    )
    usual = pacing.mission if flown_as == MISSION and pacing.mission is not None else pacing.step
    return capability.timing(flown_as, usual)


def _holds(figure: Figure, timing: LegTiming) -> bool:
    """Return whether a figure of legs does not contradict what is known without it."""
    if figure.name not in LEG_FIGURES or not figure.values:
        return False
    value = getattr(timing, LEG_FIGURES[figure.name])
    low, high = figure.spread
    return low <= (timing.acceleration if value is None else value) <= high


def found_by(figures: Iterable[Figure]) -> dict[str, float]:
    """Return the medians of the figures that are beyond doubt, by name; one less than 0 is 0."""
    return {each.name: max(0.0, each.median) for each in figures if each.values and not each.doubt}


def fastest(values: Sequence[float], part: float = 0.9) -> list[float]:
    """Return the values that come near to the largest one: others were not meant to be as fast."""
    most = max(values, default=0.0)
    return [each for each in values if each >= part * most]


def unbusy(seconds: Sequence[float]) -> list[float]:
    """Return the times that come near to the shortest tenth: at others the vehicle had something to do."""
    shortest = float(np.percentile(seconds, 10.0)) if seconds else 0.0
    return [each for each in seconds if each <= shortest + NOISE]


def figures_of(
    flights: Sequence[Flight], capacity: float | None = None, current: Current = nothing
) -> tuple[Figure, ...]:
    """Return the figures of flights of a vehicle: those of each way of flying legs, then those of all.

    Args:
        flights: one at least.
        capacity: of the vehicle's batteries, in coulombs; None: as the logs tell.
        current: what the type states.
    """
    return (
        *_leg_figures(flights, STEP, current),
        *_leg_figures(flights, MISSION, current),
        _turn_rate(flights),
        *_end_figures(flights),
        *_energy_figures(flights, capacity),
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


def _leg_figures(flights: Sequence[Flight], flown_as: str, current: Current) -> Iterator[Figure]:
    levels = [(flight, levels_of(flight, flown_as)) for flight in flights]
    flown = [each for each in levels if not each[1].missing]
    profile = flights[0].profile
    slowest, known = still(profile), held(profile, flown_as, current)

    def figure(name: str, unit: str, values: Iterable[float], missing: str) -> Figure:
        found = _figure(name, unit, values, missing if flown else levels[0][1].missing, flown_as)
        return replace(found, doubt=HOLDS) if not found.doubt and _holds(found, known) else found

    trails, follows = known.trailing > 0.0, "it follows a set-point that moves at even speed"
    fitting = [each for _, level in flown for each in level.ramps if each.fits and not trails]
    rising = [each for each in fitting if each.rising]
    jerks = [each.jerk for each in rising]
    jerk = float(np.median(jerks)) if jerks else inf
    tops = fastest([each for part in flown for each in _kept(*part, 2.0 * slowest)])
    speeding = fastest([each.acceleration for each in rising if each.keeps], 0.8)
    slowing = fastest([each for part in flown for each in _decelerations(*part, jerk)], 0.8)
    short = follows if trails else "no leg was long enough for it"
    yield figure("maxSpeed", "m/s", tops, "no speed was kept for 2 s")
    up = figure("maxAcceleration", "m/s²", speeding, short)
    slower = short if trails else f"{short}, so take it for maxAcceleration"
    down = figure("maxDeceleration", "m/s²", slowing, slower)
    if {up.doubt, down.doubt} == {"", HOLDS}:  # a type that states one of them states both
        up, down = replace(up, doubt=""), replace(down, doubt="")
    changing = figure("maxJerk", "m/s³", jerks, follows if trails else "no change of speed is an S-curve")
    yield from (up, down, changing)
    yield from _vertical_figures(flown, figure, jerk)
    timing = held(profile, flown_as, current, found_by((up, down, changing)))
    if flown_as == MISSION:
        passed = [
            each
            for flight, level in flown
            for each in corners_passed(flight, level.chosen, max(2.0 * slowest, level.least))
        ]
        radii = [each for corner in passed if (each := corner_radius(corner, timing)) is not None]
        none = "no corner was passed without a stop" if not passed else "no corner was passed more slowly"
        yield figure("cornerRadius", "m", radii, none)
    straight = [(flight, list(legs_of(flight, level.ramps, slowest))) for flight, level in flown]
    gains = [each for part in straight for each in _gains(*part, timing)]
    if gains:
        lags = [each.lag for each in gains], [each.seconds for each in gains]
        timing = replace(timing, lag=float(np.median(lags[0])), lag_within=float(np.median(lags[1])))
    legs = [[each for each in part if isfinite(each.done - each.begun)] for _, part in straight]
    limited = timing.acceleration < inf
    overshoot, settled = _beside(legs, replace(timing, settling=0.0)) if limited else (None, [])
    missing = "no straight leg between two stops, or the log does not hold when targets were given"
    unclear = "the legs do not show it: fly short and long ones" if settled else missing
    if not limited:
        missing = unclear = follows if trails else "no acceleration to judge legs by"
    yield figure("overshoot", "s", () if overshoot is None else (overshoot,), unclear)
    yield figure("settlingTime", "s", unbusy(settled), missing)
    even = "no speed was kept for long that the vehicle came near to only with time"
    yield figure("lag", "s", (each.lag for each in gains), even)
    yield figure("lagTime", "s", (each.seconds for each in gains), even)


def corner_radius(corner: Passage, timing: LegTiming) -> float | None:
    """Return the radius of a corner as it counts for the autopilot; None where the corner does not show it.

    That is how near it comes, or where it slows down for corners, the tangent of the circle that it goes
    round as slowly.
    """
    if not timing.slows_down:
        return corner.nearest
    if corner.speed > SLOWED * corner.beside or corner.turn > TURNED_ROUND:
        return None
    return corner.speed**2 * tan(corner.turn / 2.0) / (timing.turning * timing.acceleration)


def _kept(flight: Flight, level: _Levels, least: float) -> Iterator[float]:
    """Yield the level speeds of at least so much that were kept."""
    speeds = np.where(level.chosen, level.speeds, 0.0)
    yield from (each.value for each in plateaus_in(flight.times, speeds, least, EVEN_SECONDS))


def still(profile: VehicleProfile | None) -> float:
    """Return the metres per second up to which a vehicle stands."""
    return profile.still if profile is not None else _USUAL_STILL


def _decelerations(flight: Flight, level: _Levels, jerk: float) -> Iterator[float]:
    """Yield how fast the vehicle slows down, by curves of the jerk at which it speeds up."""
    for each in level.ramps if jerk < inf else ():
        if each.fits and not each.rising:
            value = with_jerk(flight.times, level.speeds, each, jerk)
            if each.change * jerk >= 1.5 * value**2:
                yield value


def _beside(legs: Sequence[Sequence[Leg]], timing: LegTiming) -> tuple[float | None, list[float]]:
    """Return how far a vehicle goes beyond its targets, and what legs take beside their S-curves and that.

    A vehicle that goes beyond its target by a share of its speed takes the longer, the faster the leg was.
    Where the legs do not show that clearly, it is unknown: None, and they go beyond it as far as is known.

    Args:
        legs: of each flight.
        timing: as far as is known, without settling.
    """

    def going(hundredths: int) -> LegTiming:
        return replace(timing, overshoot=hundredths / 100.0)

    tops = [each.speeding_up.high for flight in legs for each in flight]
    plain = lefts(legs, timing)
    if len(tops) < FEWEST or max(tops) < 1.5 * min(tops):
        return None, plain
    best = min(range(1, 31), key=lambda number: _width(lefts(legs, going(number))))
    left = lefts(legs, going(best))
    return (best / 100.0, left) if _width(left) < 0.7 * _width(plain) else (None, plain)


def _gains(flight: Flight, legs: Sequence[Leg], known: LegTiming) -> list[Gain]:
    """Return how fast the vehicle came near to its speed on legs, each as if it had begun without thrust."""
    found, push = list[Gain](), STANDING
    for leg in legs:
        if (gain := gain_of(flight, leg)) is None:
            push = STANDING
            continue
        timing = LegTiming(lag=gain.lag, lag_within=gain.seconds)
        rates = Rates(gain.speed, 1.0, 1.0, timing)
        left = sum(one * two for one, two in zip(push, leg.way, strict=True)) / leg.length
        left /= gain.speed
        if abs(left) < CLEAR:
            found.append(replace(gain, lag=gain.lag * (1.0 + known.lag_halved / gain.speed) / (1.0 - left)))
        push = rates.push((0.0, 0.0, 0.0), (*leg.way, 0.0), push) or STANDING
    return found


def lefts(flights: Sequence[Sequence[Leg]], timing: LegTiming) -> list[float]:
    """Return by how much the legs of each flight took longer than they are planned to, in their order."""
    found = list[float]()
    fastest = max((leg.speeding_up.high for legs in flights for leg in legs), default=0.0)
    for legs in flights:
        push = STANDING
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


def _vertical_figures(
    flown: Sequence[tuple[Flight, _Levels]], figure: _MakesFigure, jerk: float
) -> Iterator[Figure]:
    accelerations: list[float] = []
    missing = "no upright leg was long enough for it"
    chosen = [(flight, level.chosen & _off_the_ground(flight)) for flight, level in flown]
    for name, sign in (("maxClimbRate", 1.0), ("maxDescentRate", -1.0)):
        rates = [each.value for part in chosen for each in climbs_of(*part, sign)]
        yield figure(name, "m/s", fastest(rates), missing)
        for flight, samples in chosen:
            speeds = np.maximum(sign * flight.velocities[:, 2], 0.0)
            ramps = vertical_ramps(flight, samples, sign)
            accelerations += [
                with_jerk(flight.times, speeds, each, min(jerk, LARGEST_JERK)) for each in ramps
            ]
    yield figure("maxVerticalAcceleration", "m/s²", accelerations, missing)


def _off_the_ground(flight: Flight) -> Flags:
    """Return which samples belong to no final descent of a landing."""
    off = np.ones(len(flight.times), bool)
    for each in landings_of(flight):
        off &= (flight.times < each.begun) | (flight.times > each.ended)
    return off


def _turn_rate(flights: Sequence[Flight]) -> Figure:
    rates = [degrees(each) for flight in flights for each in turns_of(flight)]
    headed = any(np.isfinite(flight.headings).any() for flight in flights)
    missing = "the heading never changed by 45°" if headed else "no headings"
    return _figure("maxTurnRate", "°/s", fastest(rates, 0.8), missing)


def _end_figures(flights: Sequence[Flight]) -> Iterator[Figure]:
    """Yield the figures of take-offs and landings, of a vehicle that flies."""
    if flights[0].profile is None or not flights[0].profile.flies:
        return
    spun_up = [each for flight in flights for each in spin_ups_of(flight)]
    landings = [each for flight in flights for each in landings_of(flight)]
    none = "no landing until the motors stopped"
    yield _figure("launchTime", "s", spun_up, "no command to take off")
    yield _figure("landingRate", "m/s", (each.rate for each in landings), none)
    yield _figure("landingHeight", "m", (each.height for each in landings), none)
    yield _figure("recoveryTime", "s", (each.stopping for each in landings), none)


def _energy_figures(flights: Sequence[Flight], capacity: float | None) -> Iterator[Figure]:
    powers = [each for flight in flights for each in _powers(flight)]
    yield _figure("meanPower", "W", powers, "no voltage and current while it moved")
    found = [_lifetime(flight, capacity) for flight in flights]
    yield _figure("lifetime", "s", (each for values, _ in found for each in values), found[0][1])


def in_flight(flight: Flight, times: Floats) -> Flags:
    """Return at which times the vehicle was armed, between its first and its last motion."""
    moving = np.flatnonzero(np.linalg.norm(flight.velocities, axis=1) > still(flight.profile))
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
    """Return how long a full battery lasts, by its capacity and the current, or else by its charge.

    Its charge is a share of the capacity that the autopilot states, which need not be that of the type.
    """
    taken = flight.power[in_flight(flight, flight.power[:, 0])]
    stated = flight.parameters.get("BATT_CAPACITY", 0.0) * COULOMBS
    known = stated if capacity is None else capacity
    if len(taken) >= FEWEST and known > 0.0 and (current := float(taken[:, 2].mean())) > 0.0:
        return (known / current,), ""
    charges = flight.charges[in_flight(flight, flight.charges[:, 0])]
    if len(charges) and (charges[:, 1] - np.minimum.accumulate(charges[:, 1])).max() > CHARGED:
        return (), "it was charged, or its battery changed, in between: take the log of one sortie"
    if len(charges) >= 2 and (used := float(charges[0, 1] - charges[-1, 1])) >= 0.1:
        if capacity is not None and not stated:
            return (), "no current, and not of which capacity its charge is a share (BATT_CAPACITY)"
        share = 1.0 if capacity is None else capacity / stated
        return (share * float(charges[-1, 0] - charges[0, 0]) / used,), ""
    return (), "no current with the battery's capacity (BATT_CAPACITY), and no tenth of a charge was used"
