"""What the parts of a vehicle say is what the database declares: as often as that, and no more."""

from collections import Counter

import pytest
from sample_vessels import pool_sheet

from auv_vessel.api import Craft
from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.hosting import Rehearsal
from auv_vessel.movement.movement import Movement
from auv_vessel.wire.catalogue import messages_of
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.load import load_of, measured_load

pytestmark = pytest.mark.real_time("vessels")

SHEET = pool_sheet()
SECONDS = 20.0
SOMETIMES = {"Fix": "at the surface only", "Clock": "said by hosts"}


@pytest.fixture(scope="module")
def heard() -> list[tuple[float, Frame]]:
    """Return all that is said while a vehicle dives and goes to a place."""
    frames: list[tuple[float, Frame]] = []
    craft = Craft(SHEET, Codec(SHEET))
    parts = [part(SHEET, Codec(SHEET)) for part in (Sensors, Actuators, Movement)]
    body = Vehicle(SHEET, Codec(SHEET), Surroundings(current=(0.1, 0.0), bottom=10.0), 3)
    run = Rehearsal([body, *parts, craft], watch=lambda now, frame: frames.append((now, frame)))
    run.run(2.0)
    craft.go_to(4.0, 1.0, 2.0)
    run.run(SECONDS - 2.0)
    return frames


def test_every_message_is_said_as_often_as_declared(heard: list[tuple[float, Frame]]) -> None:
    counts = Counter(frame.id for _, frame in heard)
    for message in messages_of(SHEET):
        if message.period is None or message.name in SOMETIMES:
            continue
        expected = SECONDS / message.period
        assert 0.85 * expected - 1 <= counts[message.id] <= 1.05 * expected + 1, message.name
    assert counts.keys() <= {message.id for message in messages_of(SHEET)}


def test_the_bus_is_no_busier_than_designed(heard: list[tuple[float, Frame]]) -> None:
    designed, found = load_of(SHEET), measured_load(heard, SHEET.bit_rate)
    assert found is not None
    assert 0.85 * designed.least <= found.mean <= designed.most
    assert found.peak <= 1.5 * designed.most


def test_every_frame_is_believed_and_its_counter_goes_on(heard: list[tuple[float, Frame]]) -> None:
    codec, last = Codec(SHEET), {}
    for _, frame in heard:
        said = codec.decode(frame)
        assert said is not None
        if said.sequence is not None:
            assert said.name not in last or said.sequence == (last[said.name] + 1) % 256
            last[said.name] = said.sequence
    assert not codec.faults


def test_the_same_vehicle_says_the_same_again_to_the_bit(heard: list[tuple[float, Frame]]) -> None:
    frames: list[tuple[float, Frame]] = []
    craft = Craft(SHEET, Codec(SHEET))
    parts = [part(SHEET, Codec(SHEET)) for part in (Sensors, Actuators, Movement)]
    body = Vehicle(SHEET, Codec(SHEET), Surroundings(current=(0.1, 0.0), bottom=10.0), 3)
    run = Rehearsal([body, *parts, craft], watch=lambda now, frame: frames.append((now, frame)))
    run.run(2.0)
    craft.go_to(4.0, 1.0, 2.0)
    run.run(3.0)
    assert frames == heard[: len(frames)]
