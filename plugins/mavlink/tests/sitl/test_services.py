"""What the vehicle answers over its link: parameters, requests, rates; and what it does not hear."""

from __future__ import annotations

import time
from collections import Counter

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from stalls import Stalls

from mmrs_mavlink.sitl import Settings, SimulatedVehicle

pytestmark = pytest.mark.real_time("parts of flights")

SPEEDUP = 10.0


@pytest.fixture
def switch_on(ground):
    """Return a function that switches a vehicle on and waits until it is heard."""
    vehicles = []

    def make(speedup: float = SPEEDUP, heard: bool = True, **given):
        wires = {name: given.pop(name) for name in ("loss", "delay", "seed") if name in given}
        settings = Settings(**{"boot": 0.5, "ready": 0.5, **given})
        port = ground.socket.getsockname()[1]
        vehicles.append(SimulatedVehicle(port, settings, speedup=speedup, **wires))
        vehicles[-1].start()
        assert not heard or ground.of("GLOBAL_POSITION_INT")
        return vehicles[-1]

    yield make
    for vehicle in vehicles:
        vehicle.stop()


def parameter(ground, name: str):
    return ground.hear(lambda m: m.get_type() == "PARAM_VALUE" and m.param_id == name, 2.0)


def test_a_parameter_is_read_by_its_name_and_by_its_number(ground, switch_on):
    switch_on()
    ground.send(mavlink.MAVLink_param_request_read_message(1, 1, b"RTL_ALT", -1))
    by_name = parameter(ground, "RTL_ALT")
    ground.send(mavlink.MAVLink_param_request_read_message(1, 1, b"", by_name.param_index))
    assert parameter(ground, "RTL_ALT").param_value == by_name.param_value == 1500.0


def test_a_parameter_is_set_and_told_as_it_was_kept(ground, switch_on):
    vehicle = switch_on()
    ground.send(mavlink.MAVLink_param_set_message(1, 1, b"FS_GCS_ENABLE", 5.7, 9))
    assert parameter(ground, "FS_GCS_ENABLE").param_value == 5.0
    assert vehicle.autopilot.parameters["FS_GCS_ENABLE"] == 5.0


def test_a_parameter_that_it_does_not_have_is_not_answered(ground, switch_on):
    switch_on()
    ground.send(mavlink.MAVLink_param_set_message(1, 1, b"NO_SUCH", 1.0, 9))
    assert ground.of("PARAM_VALUE", 0.5) is None


def test_all_parameters_are_listed_once(ground, switch_on):
    vehicle = switch_on()
    ground.send(mavlink.MAVLink_param_request_list_message(1, 1))
    told = Counter()
    while len(told) < len(vehicle.autopilot.parameters):
        message = ground.of("PARAM_VALUE", 2.0)
        assert message is not None
        assert message.param_count == len(vehicle.autopilot.parameters)
        told[message.param_id] += 1
    assert set(told.values()) == {1}


def test_parameters_outlive_a_restart(ground, switch_on):
    vehicle = switch_on()
    vehicle.autopilot.parameters["RTL_ALT"] = 3000.0
    vehicle.faults.begin("restart")
    assert vehicle.autopilot.parameters["RTL_ALT"] == 3000.0


@pytest.mark.parametrize(("name", "value"), [("SIM_GPS1_ENABLE", 0.0), ("SIM_GPS1_ENABLE", 1.0)])
def test_its_satellites_are_switched_as_those_of_ardupilots_simulation(ground, switch_on, name, value):
    vehicle = switch_on()
    ground.send(mavlink.MAVLink_param_set_message(1, 1, name.encode(), value, 9))
    assert parameter(ground, name).param_value == value
    assert vehicle.autopilot.located == bool(value)


def rate_of(ground, kind: str, seconds: float = 1.2) -> float:
    until, count = time.monotonic() + seconds, 0
    while time.monotonic() < until:
        count += ground.of(kind, max(0.0, until - time.monotonic())) is not None
    return count / seconds


def test_a_message_comes_as_often_as_it_is_asked_for(ground, switch_on):
    switch_on(speedup=1.0)
    assert rate_of(ground, "ATTITUDE") == pytest.approx(4.0, abs=1.5)
    assert ground.command(511, 30, 1e6 / 15.0).result == 0
    assert rate_of(ground, "ATTITUDE") == pytest.approx(15.0, abs=4.0)
    assert ground.command(511, 30, -1).result == 0
    assert rate_of(ground, "ATTITUDE", 0.8) <= 1.3


def test_a_message_that_it_does_not_have_cannot_be_had(ground, switch_on):
    switch_on()
    assert ground.command(511, 12_345, 1e5).result == 4
    assert ground.command(512, 12_345).result == 4


def test_what_it_can_do_is_told_on_request(ground, switch_on):
    switch_on()
    assert ground.command(512, 148).result == 0
    assert ground.command(410).result == 0
    ground.send(mavlink.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0))
    assert ground.of("AUTOPILOT_VERSION").capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE


def test_what_is_for_another_system_is_not_heard(ground, switch_on):
    vehicle = switch_on(system=7)
    ground.send(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0))
    ground.send(mavlink.MAVLink_mission_count_message(8, 1, 3, 0))
    assert ground.of("COMMAND_ACK", 0.5) is None
    assert vehicle.received == []


def test_a_command_that_it_does_not_know_is_refused(ground, switch_on):
    switch_on(refuse=frozenset({2000}))
    assert ground.command(2000).result == mavlink.MAV_RESULT_UNSUPPORTED
    assert ground.command(31_999).result == mavlink.MAV_RESULT_UNSUPPORTED


def test_a_change_of_the_mode_is_told_at_once(ground, switch_on):
    switch_on(speedup=1.0)
    assert ground.of("HEARTBEAT")
    stalls, began = Stalls(), time.monotonic()
    assert ground.command(176, 1, 5).result == 0
    assert ground.hear(lambda m: m.get_type() == "HEARTBEAT" and m.custom_mode == 5)
    assert time.monotonic() - began < 0.5 + stalls.seconds


def test_a_command_with_whole_numbers_carries_places(ground, switch_on):
    vehicle = switch_on()
    place = (423_750_000, 133_500_000, 20.0)
    ground.send(mavlink.MAVLink_command_int_message(1, 1, 3, 195, 0, 0, 0, 0, 0, 0, *place))
    assert ground.of("COMMAND_ACK").result == 0
    assert vehicle.autopilot.roi[0] == pytest.approx(555.4, abs=0.2)


def test_time_is_answered_for_measuring_the_way(ground, switch_on):
    switch_on()
    ground.send(mavlink.MAVLink_timesync_message(0, 4_711))
    assert ground.hear(lambda m: m.get_type() == "TIMESYNC" and m.tc1 != 0).ts1 == 4_711


def test_what_is_lost_is_lost_by_its_seed(ground, switch_on):
    lost = switch_on(loss=0.5, seed=3, heard=False)
    time.sleep(1.0)
    sent = lost.radio.sent
    assert 20 < sent < 400


def test_a_slow_link_delays_what_is_said(ground, switch_on):
    switch_on(speedup=1.0, delay=0.4)
    began = time.monotonic()
    ground.send(mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 5, 0, 0, 0, 0, 0))
    assert ground.of("COMMAND_ACK") is not None
    assert time.monotonic() - began >= 0.75


def test_what_it_does_not_know_of_its_battery_is_told_so(ground, switch_on):
    switch_on(tells_battery=False)
    status = ground.of("SYS_STATUS")
    told = (status.battery_remaining, status.voltage_battery, status.current_battery)
    assert told == (-1, 65_535, -1)
    assert ground.of("BATTERY_STATUS", 0.5) is None


def test_wind_is_told_by_where_it_comes_from(ground, switch_on):
    switch_on(wind=(6.0, 225.0))
    wind = ground.of("WIND")
    assert (wind.direction, wind.speed) == (pytest.approx(225.0), pytest.approx(6.0))
