"""A whole vehicle that goes by what it sees: cameras, control layer and body in simulated time."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import dist, hypot

import pytest
from sample_vessels import pool_sheet

from auv_vessel.api import Craft
from auv_vessel.body.surroundings import BUOY, GATE, Surroundings, Thing
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.decision.duties import OBJECT_NOT_FOUND, Duty, FailureError, Look, Seek, Travel
from auv_vessel.eyes import Detections, to_datagram
from auv_vessel.hosting import Rehearsal
from auv_vessel.movement.movement import Movement
from auv_vessel.sheet import Vector
from auv_vessel.wire.codec import Codec
from auv_vision.cameras import Pose
from auv_vision.detecting import Sought
from auv_vision.node import Eyes

STAND_OFF, LOOKS = 1.5, 0.5
"""Metres before an object at which the vehicle halts, and seconds between two looks."""

EXPECTED = Sought(BUOY, "red buoy", "red", 0.3, (6.0, 0.0, 1.6))
GATE_THERE = Thing(GATE, "gate", 7.5, 0.5, 0.9, 0.0, "orange", 2.0)


@dataclass
class Diver:
    """A vehicle that looks around twice a second."""

    vehicle: Vehicle
    craft: Craft
    rehearsal: Rehearsal
    eyes: Eyes
    detections: Detections
    looked: float = 0.0

    def advance(self) -> None:
        self.rehearsal.run(0.2)
        if self.rehearsal.now < self.looked:
            return
        self.looked = self.rehearsal.now + LOOKS
        truth, state = self.vehicle.truth, self.craft.state()
        pose = Pose(truth.north, truth.east, truth.depth, truth.roll, truth.pitch, truth.heading)
        believed = Pose(state.north, state.east, state.depth, state.roll, state.pitch, state.heading)
        for each in self.eyes.look(self.rehearsal.now, pose, believed):
            self.detections.take(to_datagram(each))

    def go(self, seconds: float) -> None:
        until = self.rehearsal.now + seconds
        while self.rehearsal.now < until:
            self.advance()

    def do(self, duty: Duty, seconds: float = 300.0) -> None:
        duty.begin(self.craft, self.rehearsal.now)
        until = self.rehearsal.now + seconds
        while not duty.done(self.craft, self.rehearsal.now):
            self.advance()
            assert self.rehearsal.now < until

    def way(self, place: Vector, found: bool) -> Duty:
        """Return the way to before a place, facing it."""
        here = self.craft.state()
        north, east = place[0] - here.north, place[1] - here.east
        left = max(0.0, 1.0 - STAND_OFF / max(STAND_OFF, hypot(north, east)))
        goal = (here.north + left * north, here.east + left * east, place[2])
        return Travel([goal], 0.5, Look(place[0], place[1]))


@contextmanager
def diver(*things: Thing, seed: int) -> Iterator[Diver]:
    sheet = pool_sheet()
    around = Surroundings(current=(0.03, -0.04), bottom=4.5, things=things)
    vehicle = Vehicle(sheet, Codec(sheet), around, seed)
    craft = Craft(sheet, Codec(sheet))
    nodes = (Sensors(sheet, Codec(sheet)), Actuators(sheet, Codec(sheet)), Movement(sheet, Codec(sheet)))
    rehearsal = Rehearsal([vehicle, *nodes, craft])
    eyes = Eyes(sheet, around, seed, sought=(EXPECTED, *_sought(GATE_THERE)))
    with Detections(lasting=3.0, clock=lambda: rehearsal.now) as detections:
        found = Diver(vehicle, craft, rehearsal, eyes, detections)
        found.go(3.0)
        yield found


def _sought(thing: Thing) -> tuple[Sought, ...]:
    return (Sought(thing.kind, thing.name, thing.colour, thing.size),)


@pytest.mark.parametrize(
    "seed", [1, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(2, 10))]
)
def test_a_buoy_that_is_not_where_it_is_expected_is_found_and_approached(seed: int) -> None:
    buoy = Thing(BUOY, "red buoy", 6.8, -1.3, 1.9, 0.0, "red", 0.3)
    with diver(buoy, GATE_THERE, seed=seed) as dive:
        expected = EXPECTED.place
        assert expected is not None
        dive.do(Seek("red buoy", expected, 3.0, dive.detections.place, dive.way))
        truth = dive.vehicle.truth
        assert dist((truth.north, truth.east), (buoy.north, buoy.east)) == pytest.approx(STAND_OFF, abs=0.5)
        assert truth.depth == pytest.approx(buoy.depth, abs=0.3)
        assert dive.detections.newest("red buoy") is not None


@pytest.mark.thorough
def test_a_buoy_that_is_behind_is_found_by_looking_around() -> None:
    buoy = Thing(BUOY, "red buoy", -3.5, 0.5, 1.6, 0.0, "red", 0.3)
    with diver(buoy, seed=4) as dive:
        dive.do(Travel([(0.5, 0.0, 1.5)], 0.5))
        here = dive.craft.state()
        dive.do(Seek("red buoy", (here.north, here.east, 1.5), None, dive.detections.place, dive.way))
        truth = dive.vehicle.truth
        assert dist((truth.north, truth.east), (buoy.north, buoy.east)) == pytest.approx(STAND_OFF, abs=0.5)


@pytest.mark.thorough
def test_what_is_not_there_is_not_found() -> None:
    green = Thing(BUOY, "green buoy", 6.0, 0.0, 1.6, 0.0, "green", 0.3)
    with diver(green, seed=5) as dive:
        expected = (4.0, 0.0, 1.6)
        with pytest.raises(FailureError) as caught:
            dive.do(Seek("red buoy", expected, 3.0, dive.detections.place, dive.way), 1200.0)
        assert caught.value.event == OBJECT_NOT_FOUND
