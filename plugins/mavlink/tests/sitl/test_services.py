"""The link of a vehicle: parameters, requests, rates and detections."""

from collections import Counter

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.sights import Sight

LONG = "a float with a very long name"


def parameter(ground, name: str):
    return ground.receive("PARAM_VALUE", lambda message: message.param_id == name, 2.0)


def set_parameter(ground, name: str, value: float) -> None:
    ground.send(mavlink.MAVLink_param_set_message(1, 1, name.encode(), value, 9))


def test_a_parameter_is_read_by_name_and_by_index(ground):
    ground.switch_on()
    ground.send(mavlink.MAVLink_param_request_read_message(1, 1, b"RTL_ALT", -1))
    by_name = parameter(ground, "RTL_ALT")
    ground.send(mavlink.MAVLink_param_request_read_message(1, 1, b"", by_name.param_index))
    assert parameter(ground, "RTL_ALT").param_value == by_name.param_value == 1500.0


def test_a_parameter_is_set_and_returned_as_stored_and_outlives_a_restart(ground):
    vehicle = ground.switch_on()
    set_parameter(ground, "FS_GCS_ENABLE", 5.0)
    assert parameter(ground, "FS_GCS_ENABLE").param_value == 5.0
    vehicle.faults.begin("restart")
    assert vehicle.autopilot.parameters["FS_GCS_ENABLE"] == 5.0


def test_an_unknown_parameter_is_not_answered(ground):
    ground.switch_on()
    set_parameter(ground, "NO_SUCH", 1.0)
    assert ground.receive("PARAM_VALUE", seconds=5.0) is None


def test_all_parameters_are_listed_once(ground):
    number = len(ground.switch_on().autopilot.parameters)
    ground.send(mavlink.MAVLink_param_request_list_message(1, 1))
    listed = Counter()
    while (message := ground.receive("PARAM_VALUE", seconds=5.0)) is not None:
        assert message.param_count == number
        listed[message.param_id] += 1
    assert (len(listed), set(listed.values())) == (number, {1})


def test_the_gps_receiver_is_switched_by_the_parameter_of_ardupilots_simulation(ground):
    vehicle = ground.switch_on()
    for value in (0.0, 1.0):
        set_parameter(ground, "SIM_GPS1_ENABLE", value)
        assert parameter(ground, "SIM_GPS1_ENABLE").param_value == value
        assert vehicle.autopilot.located == bool(value)


def test_a_message_comes_at_the_requested_rate(ground):
    pilot = ground.switch_on().autopilot

    def rate() -> float:
        until, count = pilot.time + 10.0, 0
        while ground.receive("ATTITUDE", seconds=max(0.0, until - pilot.time)) is not None:
            count += 1
        return count / 10.0

    assert rate() == pytest.approx(4.0, abs=0.2)
    assert ground.command(511, 30, 1e6 / 15.0).result == 0
    assert rate() == pytest.approx(15.0, abs=0.5)
    assert ground.command(511, 30, -1).result == 0
    ground.wait(0.5)
    assert rate() == 0.0


def test_an_unknown_message_cannot_be_requested(ground):
    ground.switch_on()
    assert ground.command(511, 12_345, 1e5).result == 4
    assert ground.command(512, 12_345).result == 4


def test_messages_for_another_system_are_ignored(ground):
    vehicle = ground.switch_on(system=7)
    ground.send(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0))
    ground.send(mavlink.MAVLink_mission_count_message(8, 1, 3, 0))
    assert ground.receive("COMMAND_ACK", seconds=5.0) is None
    assert vehicle.received == []


def test_an_unknown_command_is_refused(ground):
    ground.switch_on(refuse=frozenset({2000}))
    assert ground.command(2000).result == mavlink.MAV_RESULT_UNSUPPORTED
    assert ground.command(31_999).result == mavlink.MAV_RESULT_UNSUPPORTED


def test_a_mode_change_is_reported_at_once(ground):
    pilot = ground.switch_on().autopilot
    assert ground.receive("HEARTBEAT")
    began = pilot.time
    assert ground.command(176, 1, 5).result == 0
    assert ground.receive("HEARTBEAT", lambda m: m.custom_mode == 5)
    assert pilot.time - began < 0.5


def test_a_command_int_carries_coordinates(ground):
    vehicle = ground.switch_on()
    place = (423_750_000, 133_500_000, 20.0)
    ground.send(mavlink.MAVLink_command_int_message(1, 1, 3, 179, 0, 0, 0, 0, 0, 0, *place))
    assert ground.receive("COMMAND_ACK").result == 0
    assert vehicle.autopilot.home == pytest.approx((42.375, 13.35, 20.0))


def test_a_battery_that_is_not_measured_is_unknown(ground):
    ground.switch_on(tells_battery=False)
    status = ground.receive("SYS_STATUS")
    assert (status.battery_remaining, status.voltage_battery, status.current_battery) == (-1, 65_535, -1)
    assert ground.receive("BATTERY_STATUS", seconds=5.0) is None


def test_wind_is_reported_by_its_origin(ground):
    ground.switch_on(wind=(6.0, 225.0))
    wind = ground.receive("WIND")
    assert (wind.direction, wind.speed) == (pytest.approx(225.0), pytest.approx(6.0))


def test_detected_objects_are_reported_with_their_position_if_that_fits(ground):
    sights = (Sight("float", 0.0, 0.0, 1.0), Sight(LONG, 0.0, 0.0, 1.0), Sight("wreck", 0.0, 0.0, 20.0))
    ground.switch_on(sights=sights)
    assert ground.command(203, 0, 0, 0, 0, 1).result == 0
    texts = [ground.receive("STATUSTEXT", lambda m: m.text.startswith("detected"), 5.0) for _ in range(3)]
    assert [text and text.text for text in texts] == [
        "detected float at 42.370000,13.350000",
        f"detected {LONG}",
        None,
    ]
