"""The mean wind of a sortie: gusts come and go, return paths last for minutes."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, degrees, exp, hypot, radians, sin

from mmrs_runtime.controllers.state import State

MEAN_SECONDS = 60.0
"""Over how long winds are averaged, at most."""


class MeanWind:
    """Averages the wind that a vehicle tells: evenly at first, later the more the newer it is."""

    def __init__(self) -> None:
        """Create without wind."""
        self._mean: tuple[float, ...] | None = None
        self._begun = self._last = 0.0

    def with_mean(self, state: State) -> State:
        """Return a state with the mean wind instead of that of the moment, which is taken into account."""
        if state.wind is None:
            return state
        now = (state.wind,) if state.wind_from is None else _components(state.wind, state.wind_from)
        if self._mean is None or len(self._mean) != len(now):
            self._mean, self._begun = now, state.time
        else:
            share = self._share(state.time)
            self._mean = tuple(old + share * (new - old) for old, new in zip(self._mean, now, strict=True))
        self._last = state.time
        if len(self._mean) == 1:
            return replace(state, wind=self._mean[0])
        north, east = self._mean
        return replace(state, wind=hypot(north, east), wind_from=degrees(atan2(east, north)) % 360.0)

    def _share(self, time: float) -> float:
        """Return how much the newest wind counts: as long as it lasts, of all that is remembered."""
        lasted, seen = time - self._last, time - self._begun
        if lasted <= 0.0:
            return 0.0
        return max(lasted / seen, 1.0 - exp(-lasted / MEAN_SECONDS))


def _components(speed: float, comes_from: float) -> tuple[float, float]:
    angle = radians(comes_from)
    return speed * cos(angle), speed * sin(angle)
