"""Gathers the contents of a log, message by message, and makes a flight of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import dist, hypot, isfinite

import numpy as np

from mmrs_core.errors import UnreadableError
from mmrs_runtime.controllers.geodesy import metres_per_degree, wrapped

from ..profiles import PROFILES, VehicleProfile
from .flight import Flight, Floats

FEWEST_SAMPLES = 50
"""Positions below which a log holds no flight: a few seconds."""

LARGEST_SPEED = 500.0
"""Metres per second that no vehicle reaches."""

LARGEST_EXTENT = 1e6
"""Metres that no flight leads away from its origin."""


@dataclass(slots=True)
class Gathered:
    """What was found so far.

    Attributes:
        file: name of the log.
        now: seconds of the vehicle's clock, by its latest sample.
        samples: time, east, north, up, velocities east, north, up, heading in radians.
    """

    file: str
    vehicle: str = ""
    profile: VehicleProfile | None = None
    now: float = 0.0
    samples: list[tuple[float, ...]] = field(default_factory=list)
    modes: list[tuple[float, int]] = field(default_factory=list)
    armed: list[tuple[float, bool]] = field(default_factory=list)
    targets: list[float] = field(default_factory=list)
    take_offs: list[float] = field(default_factory=list)
    power: list[tuple[float, ...]] = field(default_factory=list)
    charges: list[tuple[float, ...]] = field(default_factory=list)
    parameters: dict[str, float] = field(default_factory=dict)
    damages: list[str] = field(default_factory=list)
    _origin: tuple[float, float] | None = None
    _target: object = None

    def add(self, time: float, place: Sequence[float], velocity: Sequence[float], heading: float) -> None:
        """Add a sample; one that is impossible, or not later than the one before, is left out.

        Args:
            place: east, north and up, metres. velocity: likewise.
            heading: radians clockwise from north; NaN: unknown.
        """
        sample = (time, *place, *velocity)
        possible = (
            all(map(isfinite, sample)) and hypot(*place) < LARGEST_EXTENT and hypot(*velocity) < LARGEST_SPEED
        )
        if possible and (not self.samples or time > self.samples[-1][0]):
            self.samples.append((*sample, heading))
            self.now = time

    def add_by_speed(self, time: float, place: Sequence[float], speed: float, heading: float) -> None:
        """Add a sample whose velocity leads here from the sample before, with a speed that was measured."""
        before = self.samples[-1][1:4] if self.samples else tuple(place)
        length = dist(before, place)
        part = speed / length if length > 0.0 else 0.0
        velocity = tuple(part * (b - a) for a, b in zip(before, place, strict=True))
        self.add(time, place, velocity, heading)

    def metres(self, latitude: float, longitude: float) -> tuple[float, float]:
        """Return the metres east and north of the first place that was asked for."""
        if self._origin is None:
            self._origin = (latitude, longitude)
        northwards, eastwards = metres_per_degree(self._origin[0])
        return wrapped(longitude - self._origin[1]) * eastwards, (latitude - self._origin[0]) * northwards

    def is_in_mode(self, time: float, number: int) -> None:
        """Note the mode, if it is another one."""
        if not self.modes or self.modes[-1][1] != number:
            self.modes.append((time, number))

    def is_armed(self, time: float, armed: bool) -> None:
        """Note whether the motors can turn, if that is new."""
        if not self.armed or self.armed[-1][1] != armed:
            self.armed.append((time, armed))

    def aims_at(self, time: float, target: object) -> None:
        """Note the target, if it is another one."""
        if target != self._target:
            self._target = target
            self.targets.append(time)

    def has_reached(self, time: float, item: int) -> None:
        """Note that it goes to the next item of its mission, if it was going to this one."""
        if self._target == ("item", item):
            self.aims_at(time, ("item", item + 1))

    def restarted(self) -> Gathered:
        """Return what to gather in after the vehicle has restarted, and its clock with it."""
        return Gathered(self.file, self.vehicle, self.profile, parameters=self.parameters)

    def flight(self) -> Flight:
        """Return the flight.

        Raises:
            UnreadableError: there are too few positions.
        """
        if len(self.samples) < FEWEST_SAMPLES:
            raise UnreadableError(f"{self.file}: {len(self.samples)} positions, too few for a flight")
        table = np.array(self.samples)
        first, last = float(table[0, 0]), float(table[-1, 0])
        return Flight(
            self.vehicle or "unknown vehicle",
            self.profile,
            table[:, 0],
            table[:, 1:4],
            table[:, 4:7],
            _unwrapped(table[:, 7]),
            tuple(self.modes),
            tuple(self.armed),
            tuple(each for each in self.targets if first <= each <= last),
            tuple(each for each in self.take_offs if first <= each <= last),
            _between(self.power, 3, first, last),
            _between(self.charges, 2, first, last),
            self.parameters,
            tuple(self.damages),
        )


def profile_of_type(autopilot: int, mav_type: int) -> VehicleProfile | None:
    """Return the profile for what a heartbeat reports; None where none is known."""
    known = (each for each in PROFILES.values() if each.autopilot.number == autopilot)
    return next((each for each in known if mav_type in each.mav_types), None)


def _unwrapped(headings: Floats) -> Floats:
    unwrapped, known = headings.copy(), np.isfinite(headings)
    unwrapped[known] = np.unwrap(headings[known])
    return unwrapped


def _between(rows: list[tuple[float, ...]], width: int, first: float, last: float) -> Floats:
    """Return the finite rows whose times are between two others."""
    table = np.array(rows, dtype=np.float64).reshape(-1, width)
    kept = np.isfinite(table).all(axis=1) & (table[:, 0] >= first) & (table[:, 0] <= last)
    between: Floats = table[kept]
    return between
