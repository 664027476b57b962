"""What the log of a flight holds, whatever its format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ..profiles import VehicleProfile

Floats: TypeAlias = npt.NDArray[np.float64]
Flags: TypeAlias = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Flight:
    """A flight of one vehicle, in seconds of one clock, metres (east, north, up) and radians.

    Attributes:
        vehicle: the firmware or the vehicle, as the log names it.
        profile: of its autopilot and class; None where the log does not tell.
        times: of the samples; they increase.
        places: (n, 3). velocities: (n, 3). headings: clockwise from north, not wrapped; NaN where unknown.
        modes: numbers of modes, and since when.
        armed: whether the motors could turn, and since when; empty where the log does not tell.
        targets: when the vehicle received or began another target.
        take_offs: when it was commanded to take off.
        power: (m, 3) times, volts, amperes.
        charges: (m, 2) times, fraction of the battery that is left.
        parameters: of the autopilot.
        damages: messages about what could not be read.
    """

    vehicle: str
    profile: VehicleProfile | None
    times: Floats
    places: Floats
    velocities: Floats
    headings: Floats
    modes: tuple[tuple[float, int], ...] = ()
    armed: tuple[tuple[float, bool], ...] = ()
    targets: tuple[float, ...] = ()
    take_offs: tuple[float, ...] = ()
    power: Floats = field(default_factory=lambda: np.empty((0, 3)))
    charges: Floats = field(default_factory=lambda: np.empty((0, 2)))
    parameters: Mapping[str, float] = field(default_factory=dict)
    damages: tuple[str, ...] = ()

    @property
    def rate(self) -> float:
        """Return the samples per second, as they usually come."""
        return float(1.0 / np.median(np.diff(self.times)))

    @property
    def seconds(self) -> float:
        """Return how long the log is."""
        return float(self.times[-1] - self.times[0])

    def in_mode(self, number: int, times: Floats) -> Flags:
        """Return at which times the vehicle was in a mode."""
        return _holding([(since, each == number) for since, each in self.modes], times, before=False)

    def while_armed(self, times: Floats) -> Flags:
        """Return at which times the vehicle was armed; always where the log does not tell."""
        return _holding(self.armed, times, before=not (self.armed and self.armed[0][1]))


def _holding(changes: Sequence[tuple[float, bool]], times: Floats, *, before: bool) -> Flags:
    """Return what holds at some times by what holds since others, and before the first of them."""
    since = np.array([each for each, _ in changes])
    values = np.array([before, *(value for _, value in changes)], dtype=np.bool_)
    held: Flags = values[np.searchsorted(since, times, side="right")]
    return held
