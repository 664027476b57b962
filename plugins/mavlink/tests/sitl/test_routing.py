"""What a simulated vehicle hands on between its radios, and by which it speaks."""

from __future__ import annotations

import socket

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from simulated.ground import Ground

from mmrs_mavlink.sitl import Settings, SimulatedVehicle

pytestmark = pytest.mark.real_time("parts of flights")

STATION = mavlink.MAVLink_heartbeat_message(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3)
SOON = 1.0


def ids(ground) -> tuple[int, int]:
    return ground.mav.srcSystem, ground.mav.srcComponent


@pytest.fixture
def both():
    """Return who steers a vehicle, who looks on, and the vehicle; both have spoken to it."""
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as steering,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as looking,
    ):
        ends = [Ground(steering), Ground(looking)]
        for each in ends:
            each.socket.bind(("127.0.0.1", 0))
            each.socket.settimeout(0.1)
        ends[0].mav.srcComponent, ends[1].mav.srcSystem = 191, 254
        port, second = (each.socket.getsockname() for each in ends)
        settings = Settings(boot=0.1, ready=0.1)
        with SimulatedVehicle(port[1], settings, speedup=5.0, ground=second) as vehicle:
            for each in ends:
                assert each.of("HEARTBEAT")
                each.send(STATION)
            yield *ends, vehicle


def from_other(other):
    return lambda message: (message.get_srcSystem(), message.get_srcComponent()) == ids(other)


def test_both_hear_the_vehicle_and_each_other(both):
    steering, looking, _ = both
    assert steering.hear(from_other(looking)).get_type() == "HEARTBEAT"
    assert looking.hear(from_other(steering)).get_type() == "HEARTBEAT"


def test_a_heartbeat_is_not_handed_on_to_where_the_same_ids_are_heard(both):
    steering, looking, _ = both
    steering.hear(from_other(looking))
    looking.mav.srcSystem, looking.mav.srcComponent = ids(steering)
    for _ in range(3):
        looking.send(STATION)
        assert steering.hear(from_other(looking), 0.3) is None


def test_a_command_for_the_vehicle_is_answered_to_who_gave_it(both):
    steering, looking, _ = both
    assert looking.command(mavlink.MAV_CMD_DO_SET_ROI_NONE) is not None
    assert steering.of("COMMAND_ACK", SOON) is None


def test_what_is_for_the_other_goes_there_and_nothing_for_somebody_else(both):
    steering, looking, _ = both
    steering.hear(from_other(looking))
    looking.send(mavlink.MAVLink_command_long_message(77, 1, 176, 0, 1, 4, 0, 0, 0, 0, 0))
    looking.send(mavlink.MAVLink_command_long_message(*ids(steering), 511, 0, 33, 0, 0, 0, 0, 0, 0))
    assert steering.of("COMMAND_LONG").command == 511


def test_a_broadcast_goes_on(both):
    steering, looking, _ = both
    looking.send(mavlink.MAVLink_statustext_message(6, b"good morning"))
    assert steering.hear(lambda m: m.get_type() == "STATUSTEXT" and m.text == "good morning")


def test_a_ground_station_can_be_cut_off_and_heard_again(both):
    steering, looking, vehicle = both
    vehicle.faults.begin("ground-down")
    steering.hear(lambda message: False, 0.2)
    looking.send(STATION)
    assert steering.hear(from_other(looking), SOON) is None
    vehicle.faults.end("ground-down")
    looking.send(STATION)
    assert steering.hear(from_other(looking)) is not None


def test_who_has_no_ground_station_cannot_lose_it():
    vehicle = SimulatedVehicle(9, Settings())
    try:
        with pytest.raises(ValueError, match="ground-down: the vehicle has no radio to a ground station"):
            vehicle.faults.begin("ground-down")
    finally:
        vehicle.stop()
