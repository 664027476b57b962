"""Flights made by hand: steps, tracks and entries of a drone or two."""

from functools import partial

import pytest
from flights_by_hand import flight_as, track_of

from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_runtime.records.entries import Entry
from mmrs_runtime.records.steps import StepRecord


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


@pytest.fixture
def as_run(run, behaviour):
    """Return a function: a flight that went as simulated; keywords by robot replace what it did."""
    return partial(flight_as, run, behaviour)
