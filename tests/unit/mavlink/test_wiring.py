from __future__ import annotations

from dataclasses import replace

import pytest

from mmrs_core.mavlink.wiring import Sampled, Unwired, Wired, wiring_of
from mmrs_core.scene import Device, DeviceAction
from mmrs_core.testing.programs import photo, quad


def wired(action: str = "takePhoto", **properties: str):
    device = Device("d", {action: DeviceAction(action, 2.0)}, properties)
    return wiring_of(photo("d", action), replace(quad(), devices={"d": device}))


def test_a_camera_takes_one_image():
    assert wired(**{"mavlink.camera": "1"}) == Wired(2000, (1.0, 0.0, 1.0), 2.0)


def test_a_camera_may_be_triggered_by_the_autopilot():
    found = wired(**{"mavlink.camera": "1", "mavlink.camera.command": "digicam"})
    assert found == Wired(203, (0.0, 0.0, 0.0, 0.0, 1.0), 2.0)


def test_a_servo_is_set_to_the_pulse_width_of_the_action():
    found = wired("drop", **{"mavlink.servo": "9", "mavlink.servo.drop": "1900"})
    assert found == Wired(183, (9.0, 1900.0), 2.0)


def test_a_parameter_of_the_action_goes_before_the_property():
    device = Device("d", {}, {"mavlink.servo": "9", "mavlink.servo.drop": "1900"})
    action = replace(photo("d", "drop"), parameters=(("pwm", "1100"),))
    assert wiring_of(action, replace(quad(), devices={"d": device})) == Wired(183, (9.0, 1100.0), 0.0)


@pytest.mark.parametrize(("state", "value"), [("on", 1.0), ("off", 0.0)])
def test_a_relay_is_switched(state, value):
    found = wired("light", **{"mavlink.relay": "0", "mavlink.relay.light": state})
    assert found == Wired(181, (0.0, value), 2.0)


def test_a_relay_that_nothing_says_more_about_is_on_for_the_action():
    assert wired("sample", **{"mavlink.relay": "0"}) == Wired(182, (0.0, 1.0, 4.0), 2.0)


def test_a_relay_with_a_word_that_is_none_is_not_wired():
    assert isinstance(wired("light", **{"mavlink.relay": "0", "mavlink.relay.light": "dim"}), Unwired)


def test_a_gripper_understands_its_own_words():
    assert wired("grab", **{"mavlink.gripper": "1"}) == Wired(211, (1.0, 1.0), 2.0)


def test_any_command_can_be_given_whole():
    assert wired("ping", **{"mavlink.command.ping": "42600 1 2.5"}) == Wired(42600, (1.0, 2.5), 2.0)


def test_a_value_is_sampled_by_its_name():
    assert wired("sample", **{"mavlink.value": "CO2"}) == Sampled("CO2", 2.0)


@pytest.mark.parametrize(
    ("properties", "reason"),
    [
        ({}, "no property that says how it is wired"),
        ({"mavlink.camera": "front"}, "mavlink.camera is no whole number"),
        ({"mavlink.servo": "9"}, "neither parameter pwm nor property"),
        ({"mavlink.command.takePhoto": "photo"}, "no command number"),
        ({"mavlink.command.takePhoto": "1 2 3 4 5 6 7 8 9"}, "more than seven"),
        ({"mavlink.value": "much too long"}, "not one to ten"),
    ],
)
def test_what_is_not_wired_has_a_reason(properties, reason):
    found = wired(**properties)
    assert isinstance(found, Unwired)
    assert reason in found.reason


def test_without_a_robot_type_nothing_is_wired():
    assert wiring_of(photo(), None) == Unwired("the robot's type is not given")


def test_a_device_that_the_type_does_not_have_is_not_wired():
    assert wiring_of(photo("nose"), quad()) == Unwired("type 'Quad' has no device 'nose'")
