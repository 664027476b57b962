"""What a flight was planned to be, and how near to that its vehicles kept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, dist, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
from example_flight.mission import margins
from firmware import Fix, Stand
from pyproj import Geod

from mmrs_core import pipeline
from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.behaviour.program import Program
from mmrs_core.cli.behaviours import load_behaviour
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.rules import robot_kind_of
from mmrs_core.contributions.timing import as_uploaded
from mmrs_core.simulation.run import simulate
from mmrs_core.testing.programs import installed

WGS84 = Geod(ellps="WGS84")
Line = Sequence[tuple[float, float, float]]
"""Metres east, north, up, in the frame of the program."""


@dataclass(frozen=True, slots=True)
class Planned:
    """What is to be flown, read back from its files.

    Attributes:
        program: of all robots. place: with their types. line: by robot, its path. seconds: by robot.
    """

    program: Program
    place: pipeline.BehaviourContext
    line: Mapping[str, Line]
    seconds: Mapping[str, float]

    def vehicle(self, robot: str) -> str:
        """Return the class of vehicle of a robot; what only drives is a rover."""
        type = self.place.types[self._robot(robot).type_name]
        kind = robot_kind_of(type, installed().robot_kinds)
        vehicle = kind.vehicle if kind is not None else ""
        return "rover" if vehicle == "ground" else vehicle

    def turns_on_the_spot(self, robot: str) -> bool:
        """Return whether a robot drives, and has no turning circle."""
        kind = robot_kind_of(self.place.types[self._robot(robot).type_name], installed().robot_kinds)
        return kind is not None and kind.vehicle == "ground"

    def dives(self, robot: str) -> bool:
        """Return whether a robot is under water, so that heights count from the surface."""
        kind = robot_kind_of(self.place.types[self._robot(robot).type_name], installed().robot_kinds)
        return kind is not None and kind.medium == "water"

    def stand(self, robot: str) -> Stand:
        """Return where a robot's vehicle stands at first."""
        east, north, up = self._robot(robot).home
        ((latitude, longitude),) = degrees_of([(east, north)], self.program.frame)
        altitude = self.program.frame.altitude + up
        return Stand(latitude, longitude, 0.0 if self.dives(robot) else altitude)

    def placed(self, robot: str, track: Sequence[Fix]) -> np.ndarray[Any, Any]:
        """Return where a track was in the frame of the program: rows of east, north, up."""
        stand, (east, north, up) = self.stand(robot), self._robot(robot).home
        zero = self.program.frame.surface if self.dives(robot) else up
        count = len(track)
        azimuths, _, lengths = WGS84.inv(
            [stand.longitude] * count,
            [stand.latitude] * count,
            [fix.lon for fix in track],
            [fix.lat for fix in track],
        )
        return np.array(
            [
                (east + length * sin(radians(a)), north + length * cos(radians(a)), zero + fix.rel)
                for a, length, fix in zip(azimuths, lengths, track, strict=True)
            ]
        )

    def margin(self, robot: str, track: Sequence[Fix]) -> float | None:
        """Return how much farther than required a track keeps from the nearest area; None: there is none."""
        if not self.place.areas:
            return None
        east, north, up = self._robot(robot).home
        zero = self.program.frame.surface if self.dives(robot) else up
        rows = self.placed(robot, track)
        near = [(fix.t, y - north, x - east, z - zero) for fix, (x, y, z) in zip(track, rows, strict=True)]
        return min(margins(self.program, self.place, robot, near).values(), default=None)

    def _robot(self, robot: str) -> Any:
        return next(each for each in self.program.robots if each.id == robot)


def planned(folder: Path, *, uploaded: bool = False) -> Planned:
    """Return what is to be flown: a behaviour in a folder, simulated by the core.

    Args:
        folder: of the behaviour.
        uploaded: whether vehicles fly it as missions of their own, which take longer than steps.
    """
    contributions = installed()
    loaded = load_behaviour(Session(Settings()), folder / "behaviour.xmi")
    program, place = loaded.program, loaded.place
    given = pipeline.input_of(program, place, contributions)
    if uploaded:
        given = replace(given, robot_kinds=as_uploaded(contributions.robot_kinds))
    backend = pipeline.backend_for(program, contributions, "simulation", {})
    conditions = pipeline.conditions_for(program, contributions, {}, asks=False)
    run = simulate(given, backend, conditions=conditions)
    lines = {
        robot: [(sample.east, sample.north, sample.up) for sample in track]
        for robot, track in run.tracks.items()
    }
    seconds = {robot: track[-1].time for robot, track in run.tracks.items() if track}
    return Planned(program, place, lines, seconds)


def distances(rows: np.ndarray[Any, Any], line: Line, *, plane: bool) -> np.ndarray[Any, Any]:
    """Return how far each place is from a line, metres; in the `plane`, without heights."""
    axes = 2 if plane else 3
    points, corners = rows[:, :axes], np.array(line)[:, :axes]
    least = np.full(len(points), np.inf)
    for begin, end in pairwise(corners):
        along = end - begin
        square = float(along @ along)
        part = np.clip((points - begin) @ along / square, 0.0, 1.0) if square else np.zeros(len(points))
        least = np.minimum(least, np.linalg.norm(points - begin - part[:, None] * along, axis=1))
    return least


def landing(rows: np.ndarray[Any, Any], line: Line) -> float:
    """Return how far from the line's end a track ends, metres, in the plane."""
    return dist(tuple(rows[-1][:2]), line[-1][:2])
