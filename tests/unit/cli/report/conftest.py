"""Flights made by hand: steps, tracks and entries of a drone or two."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmrs_core.behaviour.blackbox import Entry
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.cli.flights.values import Flight, Flown, Track
from mmrs_core.pipeline import Place, simulate
from mmrs_core.scene import Part
from mmrs_core.testing.programs import MULTICOPTER, areas, quad, two_drones


def track_of(points, energies=None, broken=()):
    """Return a track of (time, east, north, up) rows."""
    rows = np.array(points, dtype=float).reshape(-1, 4)
    flags = np.zeros(len(rows), dtype=bool)
    flags[list(broken)] = True
    levels = np.full(len(rows), np.nan) if energies is None else np.array(energies, dtype=float)
    return Track(rows[:, 0], rows[:, 1:], levels, flags)


def entry_of(time, kind, robot="alpha", **content):
    return Entry("r", robot, time, "", kind, content)


def records_of(robot, *steps):
    """Return the log of (time, label, move, detail, slot) steps; what is left out is empty."""
    return tuple(StepRecord("r", robot, i, i, *step) for i, step in enumerate(steps))


@pytest.fixture(scope="session")
def make():
    """Return what makes flights: `track`, `entry` and `records`."""

    class Make:
        track = staticmethod(track_of)
        entry = staticmethod(entry_of)
        records = staticmethod(records_of)
        flown = Flown

        @staticmethod
        def flight(*robots, **more):
            return Flight("r", {flown.robot: flown for flown in robots}, **more)

    return Make


@pytest.fixture(scope="session")
def place():
    kind = replace(quad(), part=Part(((MULTICOPTER, "Drone"),), {"maxAltitude": 120.0}))
    return Place({"Quad": kind}, areas(), {})


@pytest.fixture(scope="session")
def behaviour():
    return two_drones()


@pytest.fixture(scope="session")
def run(behaviour, place, contributions):
    return simulate(behaviour, place, contributions)


@pytest.fixture
def as_run(run, behaviour):
    """Return a flight that went as simulated; keywords by robot replace what it did."""

    def flight(**changed):
        robots = {
            robot.id: Flown(
                robot.id,
                tuple(record for record in run.records if record.robot == robot.id),
                track_of([(s.time, *s.position) for s in run.tracks[robot.id]]),
            )
            for robot in behaviour.robots
        }
        return Flight("r", {id: replace(flown, **changed.get(id, {})) for id, flown in robots.items()})

    return flight
