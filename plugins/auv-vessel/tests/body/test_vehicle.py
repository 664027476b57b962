"""A simulated vehicle on its bus, told what to do by frames only."""

from dataclasses import replace

import pytest
from at_sea import QUIET, at_sea
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_vessels import pool_sheet

from auv_vessel.body.rotation import to_world
from auv_vessel.body.vehicle import DEVICE_COMMAND, Vehicle
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame

POOL = Codec(pool_sheet())


def test_it_goes_where_its_thrusters_push():
    vehicle, _, water = at_sea(thrusts=(10.0, 10.0, 10.0, 10.0, 0.0, 0.0))

    water.run(10.0)

    assert vehicle.truth.north > 3.0
    assert vehicle.truth.east == pytest.approx(0.0, abs=1e-9)
    assert vehicle.truth.heading == pytest.approx(0.0, abs=1e-9)


def test_it_begins_at_home_or_where_it_is_put():
    sheet = replace(pool_sheet(), home=(5.0, -6.0, 2.0), heading=120.0)

    home, elsewhere = (
        Vehicle(sheet, Codec(sheet), QUIET, place=place, heading=heading).truth
        for place, heading in ((None, None), ((1.0, 2.0, 3.0), 10.0))
    )

    assert (home.north, home.east, home.depth) == (5.0, -6.0, 2.0)
    assert home.heading == pytest.approx(120.0)
    assert (elsewhere.north, elsewhere.east, elsewhere.depth) == (1.0, 2.0, 3.0)
    assert elsewhere.heading == pytest.approx(10.0)


@pytest.mark.parametrize(("depth", "begins"), [(-1.0, 0.035), (0.0, 0.035), (99.0, 10.0 - 0.175)])
def test_it_begins_neither_in_the_air_nor_in_the_ground(depth, begins):
    sheet = replace(pool_sheet(), weight_in_water=-19.0)

    assert Vehicle(sheet, Codec(sheet), QUIET, place=(0.0, 0.0, depth)).truth.depth == pytest.approx(begins)


def test_acceleration_is_how_velocity_changes_in_the_world():
    vehicle, _, water = at_sea(thrusts=(18.0, 6.0, 2.0, 18.0, 9.0, 4.0))
    water.run(3.0)
    before = vehicle.truth.velocity
    water.run(0.05)
    truth = vehicle.truth
    water.run(0.05)
    after = vehicle.truth.velocity

    assert abs(truth.rates[2]) > 20.0
    assert abs(truth.speeds[1]) > 0.05
    changes = [(one - other) / 0.1 for one, other in zip(after, before, strict=True)]
    assert to_world(truth.axes, truth.acceleration) == pytest.approx(changes, abs=5e-3)


def test_messages_come_as_often_as_the_catalogue_says():
    _, helm, water = at_sea(place=(0.0, 0.0, 0.0))

    water.run(9.95)

    counts = {
        name: len(helm.times(name))
        for name in ("Pressure", "GroundSpeed", "Fix", "VehicleBeat", "Thruster3Status")
    }
    assert counts == {
        "Pressure": 200,
        "GroundSpeed": 50,
        "Fix": 10,
        "VehicleBeat": 20,
        "Thruster3Status": 100,
    }


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 0x7FF), st.binary(max_size=8), st.booleans()), max_size=20))
def test_no_frame_of_chance_moves_or_harms_it(frames):
    vehicle = Vehicle(pool_sheet(), POOL, QUIET, place=(0.0, 0.0, 3.0))
    for id, data, extended in frames:
        for number in (id, 0x100, 0x010, 0x014, 0x500):
            vehicle.hear(Frame(number, data, extended), 0.0)
    vehicle.tick(0.5)

    assert all(drive.thrust == 0.0 for drive in vehicle.drives)
    assert vehicle.truth.north == 0.0


def test_the_battery_pays_for_thrust_and_hotel():
    vehicle, helm, water = at_sea(thrusts=(18.0,) * 6)

    water.run(10.0)

    spent = 799_200.0 - vehicle.charge
    assert spent == pytest.approx((6 * 90.0 + 20.0) * 10.0, rel=0.01)
    assert helm.last("Health")["Power"] == pytest.approx(560.0)


def test_a_device_does_a_request_once_and_says_when_it_is_done():
    vehicle, helm, water = at_sea()
    command = {"Device": 1, "Action": 2, "Parameter": 1.5, "Request": 7}

    for _ in range(10):
        water.post(helm.codec.encode("DeviceCommand", **command))
        water.run(0.1)

    states = [said.values["State"] for _, said in helm.heard if said.name == "DeviceStatus"]
    assert [(each.device, each.action, each.parameter) for each in vehicle.devices.operations] == [
        (1, 2, 1.5)
    ]
    assert states[0] == "ACTIVE"
    assert states[-1] == "REACHED"
    assert states == sorted(states)


def test_a_device_that_is_not_there_fails():
    _, helm, water = at_sea()

    water.post(helm.codec.encode("DeviceCommand", Device=9, Action=0, Parameter=0.0, Request=3))
    water.run(0.2)

    assert helm.last("DeviceStatus") == {"Device": 9.0, "Request": 3.0, "State": "FAILED"}


def test_identifier_of_device_commands_is_that_of_the_catalogue():
    assert (
        Codec(pool_sheet()).encode("DeviceCommand", Device=0, Action=0, Parameter=0.0, Request=0).id
        == DEVICE_COMMAND
    )
