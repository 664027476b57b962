"""Collects the fixes of one robot, and converts them to the local frame of the behaviour."""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite, nan
from types import MappingProxyType

import numpy as np

from mmrs_core.behaviour.earth import from_wgs84
from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.contributions.rules import RobotKind, robot_kind_of
from mmrs_core.geometry.frames import Floats, LocalFrame
from mmrs_core.pictures.flights.tracks import Flags, Track
from mmrs_core.scene import Frame, Name, Position, RobotType
from mmrs_runtime.records.entries import Entry, number_of

SHORTEST_GAP = 3.0
"""Shortest gap: seconds without a fix."""
_USUAL_TIMES = 5.0
_ROW = 6


@dataclass(slots=True)
class Fixes:
    """Fixes so far.

    Attributes:
        unplaced: how many had no usable position. turned: how many were older than one before.
        astray: how many were left out because of an inconsistent time.
    """

    unplaced: int = 0
    turned: int = 0
    astray: int = 0
    _values: array[float] = field(default_factory=lambda: array("d"))

    def add(self, entry: Entry) -> None:
        """Add a fix; one without a usable position is counted."""
        place = entry.content.get("place")
        found = spot_of(place) if isinstance(place, Mapping) else None
        if found is None:
            self.unplaced += 1
            return
        energy = number_of(entry.content.get("energy"))
        on_earth, first, second, height = found
        row = (entry.time, on_earth, first, second, height, nan if energy is None else energy)
        self._values.extend(row)

    def track(self, datum: Datum, *, exact: bool) -> Track:
        """Return the track in the local frame; fixes outside of it are counted.

        Args:
            datum: the origin of the positions.
            exact: whether the robot went straight between fixes, however far apart.
        """
        every = np.frombuffer(self._values, dtype=np.float64).reshape(-1, _ROW)
        rows = every[_in_order(every[:, 0])]
        self.astray = len(every) - len(rows)
        positions = datum.positions(rows[:, 1] > 0, rows[:, 2:5])
        placed = np.isfinite(positions).all(axis=1)
        self.unplaced += int(len(rows) - placed.sum())
        times: Floats = np.maximum.accumulate(rows[placed, 0]) if placed.any() else rows[placed, 0]
        self.turned = int((rows[placed, 0] < times).sum())
        return Track(times, positions[placed], rows[placed, 5], _broken(times, exact))


def _in_order(times: Floats) -> Flags:
    """Return false for those times that alone are later than what follows them, as a damaged figure is."""
    sound = np.ones(len(times), dtype=bool)
    if len(times) > 2:
        sound[1:-1] = ~((times[1:-1] > times[2:]) & (times[2:] >= times[:-2]))
    return sound


def _broken(times: Floats, exact: bool) -> Flags:
    broken = np.zeros(len(times), dtype=bool)
    if len(times) > 1 and not exact:
        passed = np.diff(times)
        broken[:-1] = passed > max(SHORTEST_GAP, _USUAL_TIMES * float(np.median(passed)))
    return broken


def spot_of(place: Mapping[str, object]) -> tuple[bool, float, float, float] | None:
    """Return whether a position is on the Earth, and its three figures; None where it is incomplete.

    They are latitude and longitude in degrees, or metres north and east of home; then the height.
    """
    height = number_of(place.get("height"))
    for on_earth, names in ((True, ("latitude", "longitude")), (False, ("north", "east"))):
        first, second = (number_of(place.get(name)) for name in names)
        if first is not None and second is not None and height is not None:
            return on_earth, first, second, height
    return None


@dataclass(frozen=True, slots=True)
class Datum:
    """The origin of the positions that one robot reports.

    Attributes:
        home: of the robot. up: of the altitude datum above the origin, metres: home, or the water surface.
    """

    frame: Frame
    home: Position
    up: float

    def positions(self, on_earth: np.typing.NDArray[np.bool_], figures: Floats) -> Floats:
        """Return (n, 3) metres east, north, up; nan for what has no position in the frame."""
        laid = np.full((len(figures), 3), nan)
        laid[:, 2] = figures[:, 2] + self.up
        local = ~on_earth
        laid[local, 0] = self.home[0] + figures[local, 1]
        laid[local, 1] = self.home[1] + figures[local, 0]
        if on_earth.any() and self.frame.latitude is not None:
            laid[on_earth, :2] = _on_ground(figures[on_earth, :2], self.frame)
        return laid

    def position(self, place: object) -> Position | None:
        """Return a reported position in the frame; None where it is incomplete, or outside of the frame."""
        found = spot_of(place) if isinstance(place, Mapping) else None
        if found is None:
            return None
        east, north, up = self.positions(np.array([found[0]]), np.array([found[1:]]))[0].tolist()
        return (east, north, up) if isfinite(east + north + up) else None


def datum_of(
    robot: RobotProgram,
    program: Program,
    robot_type: RobotType | None,
    vehicle: str = "",
    kinds: Mapping[Name, RobotKind] = MappingProxyType({}),
) -> Datum:
    """Return the origin of the positions in the black box of a robot.

    Args:
        robot_type: None where it is unknown.
        vehicle: class of vehicle that the black box names; empty where it names none.
        kinds: of robots, by metaclass.
    """
    home = robot.home if robot.home is not None else (0.0, 0.0, 0.0)
    kind = robot_kind_of(robot_type, kinds) if robot_type is not None and not vehicle else None
    known = (kind,) if kind is not None else [each for each in kinds.values() if each.vehicle == vehicle]
    dives = any(each.medium == "water" for each in known)
    return Datum(program.frame, home, program.frame.surface if dives else home[2])


def _on_ground(degrees: Floats, frame: Frame) -> Floats:
    """Return metres east and north; nan for degrees out of range."""
    metres = np.full(degrees.shape, nan)
    sound = (np.abs(degrees[:, 0]) < 90) & (np.abs(degrees[:, 1]) <= 360)
    if not sound.any():
        return metres
    longitudes, latitudes = from_wgs84(frame.crs).transform(degrees[sound, 1], degrees[sound, 0])
    assert frame.latitude is not None
    assert frame.longitude is not None
    try:
        metres[sound] = LocalFrame(frame.crs, frame.latitude, frame.longitude).to_local(latitudes, longitudes)
    except ValueError:
        metres[sound] = list(_one_by_one(latitudes, longitudes, frame))
    return metres


def _one_by_one(latitudes: Floats, longitudes: Floats, frame: Frame) -> Iterator[tuple[float, float]]:
    """Yield metres for each, nan for those at the other side of the Earth."""
    assert frame.latitude is not None
    assert frame.longitude is not None
    laid = LocalFrame(frame.crs, frame.latitude, frame.longitude)
    for latitude, longitude in zip(latitudes.tolist(), longitudes.tolist(), strict=True):
        try:
            east, north = laid.to_local(latitude, longitude)[0].tolist()
        except ValueError:
            yield nan, nan
        else:
            yield east, north
