"""Tracks of vehicles: where each was by its own estimate, and what that shows."""

import csv
import gzip
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import hypot
from pathlib import Path

from mmrs_core.scene import Position
from mmrs_runtime.controllers.geodesy import metres_per_degree

NEAR, STILL = 0.5, 0.3
"""Metres and metres per second within which a vehicle is at a target, as its recording shows it."""

ITEM = 0.9
"""Seconds that an item of a mission is shown at least which is a leg."""

PX4_AUTO = 0x404_0000
AUTO = {3, 10, PX4_AUTO}
"""Modes of ArduPilot's copters and subs, of its rovers, and of PX4s, in which missions are flown."""


@dataclass(frozen=True, slots=True)
class Sample:
    """Where a vehicle was: east, north and up of the robot's home; the first item of a mission is 1."""

    time: float
    place: Position
    speed: float
    armed: bool
    mode: int
    item: int


def track_in(file: Path) -> list[Sample]:
    """Return a track from a file, from where the vehicle was armed; empty where there is none."""
    if not file.is_file():
        return []
    with gzip.open(file, "rt") as rows:
        found = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(rows)]
    if not found:
        return []
    home = next((each for each in found if each["armed"]), found[0])
    north, east = metres_per_degree(home["lat"])
    return [
        Sample(
            each["t"],
            (
                (each["lon"] - home["lon"]) * east,
                (each["lat"] - home["lat"]) * north,
                each["rel"] - home["rel"],
            ),
            hypot(each["vx"], each["vy"], each["vz"]),
            bool(each["armed"]),
            int(each["mode"]),
            int(each["seq"]) + (each["mode"] == PX4_AUTO),  # its missions do not begin with home
        )
        for each in found
    ]


def missions_in(track: Sequence[Sample]) -> list[list[float]]:
    """Return for each mission that was flown when it began, and when each leg of it ended."""
    found: list[list[float]] = []
    item, since = 0, 0.0
    for one, two in pairwise(track):
        if two.mode in AUTO and one.mode not in AUTO:
            found.append([two.time])
            item, since = two.item, two.time
        elif one.mode in AUTO and (two.mode not in AUTO or two.item != item):
            if two.time - since > ITEM or two.mode not in AUTO:
                found[-1].append(two.time)
            item, since = two.item, two.time
    return found


def stop_at(place: Position, track: Sequence[Sample], about: float, within: float) -> float | None:
    """Return when the vehicle came to a stop at a place, nearest to a time; None: it is not seen to."""
    return _nearest((two.time for _, two, is_there in _stops(place, track) if is_there), about, within)


def left_at(place: Position, track: Sequence[Sample], about: float, within: float) -> float | None:
    """Return when the vehicle set out from a stop at a place, nearest to a time; None: it is not seen to."""
    return _nearest((one.time for one, _, is_there in _stops(place, track) if not is_there), about, within)


def _stops(place: Position, track: Sequence[Sample]) -> Iterator[tuple[Sample, Sample, bool]]:
    """Yield the samples between which a vehicle comes to a stop at a place, or leaves it."""
    near = [
        each.speed <= STILL
        and hypot(each.place[0] - place[0], each.place[1] - place[1]) <= NEAR
        and abs(each.place[2] - place[2]) <= NEAR
        for each in track
    ]
    for index, (one, two) in enumerate(pairwise(track)):
        if near[index] != near[index + 1]:
            yield one, two, near[index + 1]


def _nearest(times: Iterator[float], about: float, within: float) -> float | None:
    close = [time for time in times if abs(time - about) <= within]
    return min(close, key=lambda time: abs(time - about), default=None)
