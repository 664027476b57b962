"""Motions by S-curves whose figures are known: what a calibration must find again."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, degrees, dist, sqrt

import numpy as np
from flight_logs import Sample

Place = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Curve:
    """How legs are flown: speed, acceleration, deceleration, jerk, and seconds at each target.

    Speeding up leads to a speed that lacks a share, which then falls with a time constant.
    """

    speed: float = 8.0
    acceleration: float = 2.5
    deceleration: float = 1.5
    jerk: float = 5.0
    pause: float = 0.6
    lacks: float = 0.0
    gaining: float = 1.0


def ramp(change: float, acceleration: float, jerk: float, step: float) -> np.ndarray:
    """Return the speeds of half an S-curve from 0, by integrating its acceleration."""
    growing = min(acceleration / jerk, sqrt(change / jerk))
    whole = change / (jerk * growing) + growing
    fine = step / 50.0
    times = np.arange(0.0, whole, fine)
    gained = np.minimum(np.minimum(jerk * times, jerk * (whole - times)), jerk * growing)
    return np.append((np.cumsum(gained) * fine)[::50], change)


def profile(length: float, curve: Curve, step: float) -> np.ndarray:
    """Return the speeds of a leg from a stop to a stop, as fast as its length allows."""
    low, high = 0.0, curve.speed
    for _ in range(40):
        top = (low + high) / 2.0
        up, down = (ramp(top, each, curve.jerk, step) for each in (curve.acceleration, curve.deceleration))
        low, high = (top, high) if (up.sum() + down.sum()) * step <= length else (low, top)
    up, down = (
        ramp(low, curve.acceleration, curve.jerk, step),
        ramp(low, curve.deceleration, curve.jerk, step),
    )
    lacks = curve.lacks * np.exp(-len(up) * step / curve.gaining)
    up = ramp(low * (1.0 - lacks), curve.acceleration, curve.jerk, step) if lacks else up
    rest = length - (up.sum() + down.sum()) * step
    times = step * (len(up) + np.arange(2 * max(0, round(rest / (low * step))) + 2))
    even = low * (1.0 - curve.lacks * np.exp(-times / curve.gaining))
    gone = np.concatenate([[0.0], np.cumsum(even) * step])
    count = int(np.argmin(abs(gone - max(0.0, rest))))
    return np.concatenate([up, even[:count], down[::-1]])


def flown(
    places: Sequence[Place],
    curve: Curve,
    *,
    rate: float = 10.0,
    noise: float = 0.0,
    mode: int = 4,
    seed: int = 0,
    begin: float = 10.0,
) -> Iterator[Sample]:
    """Yield a flight along places, with a stop at each; the number of the item grows with each target."""
    random, step, time = np.random.default_rng(seed), 1.0 / rate, begin
    here = np.array(places[0])
    for item, (start, end) in enumerate(pairwise(places), start=1):
        along = (np.array(end) - np.array(start)) / dist(start, end)
        heading = degrees(atan2(along[0], along[1]))
        speeds = np.append(profile(dist(start, end), curve, step), np.zeros(round(curve.pause * rate)))
        for speed in speeds.tolist():
            here = here + along * speed * step
            velocity = along * speed + random.normal(0.0, noise, 3)
            yield Sample(time, tuple(here.tolist()), tuple(velocity.tolist()), heading, mode, True, item)
            time += step
        here = np.array(end)
