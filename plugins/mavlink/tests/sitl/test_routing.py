"""Messages that a vehicle routes between its radios."""

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from simulated.ground import Ground

from mmrs_mavlink.sitl import Settings, SimulatedVehicle

STATION = mavlink.MAVLink_heartbeat_message(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3)
SOON = 5.0


def ids(station) -> tuple[int, int]:
    return station.mav.srcSystem, station.mav.srcComponent


@pytest.fixture
def both(ground):
    """Return a controller and a ground station of one vehicle, both of which have sent a heartbeat."""
    station = Ground()
    ground.mav.srcComponent, station.mav.srcSystem = 191, 254
    station.vehicle = ground.switch_on(ground=station.address)
    for each in (ground, station):
        assert each.receive("HEARTBEAT")
        each.send(STATION)
    yield ground, station
    station.close()


def from_other(other):
    return lambda message: (message.get_srcSystem(), message.get_srcComponent()) == ids(other)


def test_heartbeats_are_forwarded(both):
    controller, station = both
    assert controller.receive("HEARTBEAT", from_other(station))
    assert station.receive("HEARTBEAT", from_other(controller))


def test_a_broadcast_is_forwarded(both):
    controller, station = both
    station.send(mavlink.MAVLink_statustext_message(6, b"good morning"))
    assert controller.receive("STATUSTEXT", lambda m: m.text == "good morning")


def test_a_ground_station_can_be_cut_off_and_restored(both):
    controller, station = both
    station.vehicle.faults.begin("ground-down")
    controller.wait(0.2)
    station.send(STATION)
    assert controller.receive(None, from_other(station), SOON) is None
    station.vehicle.faults.end("ground-down")
    station.send(STATION)
    assert controller.receive(None, from_other(station)) is not None


def test_a_vehicle_without_a_ground_station_cannot_lose_it():
    vehicle = SimulatedVehicle(9, Settings())
    with pytest.raises(ValueError, match="ground-down: the vehicle has no link to a ground station"):
        vehicle.faults.begin("ground-down")
    vehicle.close()
