"""Flights made by hand: tracks of robots, and what they did when all went as simulated."""

from dataclasses import replace

import numpy as np

from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_core.pictures.flights.tracks import Track


def track_of(points, energies=None, broken=()) -> Track:
    """Return a track of (time, east, north, up) rows."""
    rows = np.array(points, dtype=float).reshape(-1, 4)
    flags = np.zeros(len(rows), dtype=bool)
    flags[list(broken)] = True
    levels = np.full(len(rows), np.nan) if energies is None else np.array(energies, dtype=float)
    return Track(rows[:, 0], rows[:, 1:], levels, flags)


def flight_as(run, behaviour, **changed) -> Flight:
    """Return a flight that went as simulated; keywords by robot replace what it did."""
    robots = {
        robot.id: Flown(
            robot.id,
            tuple(record for record in run.records if record.robot == robot.id),
            track_of([(s.time, *s.position) for s in run.tracks[robot.id]]),
        )
        for robot in behaviour.robots
    }
    return Flight("r", {id: replace(flown, **changed.get(id, {})) for id, flown in robots.items()})
