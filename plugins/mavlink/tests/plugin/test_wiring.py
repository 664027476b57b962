from dataclasses import replace

import pytest
from mmrs_multicopter.testing import quad

from mmrs_core.errors import PluginError
from mmrs_core.scene import Device, DeviceAction
from mmrs_core.testing.programs import photo
from mmrs_mavlink.plugin.wiring import wiring_of
from mmrs_mavlink.wiring import DeviceWiring, Sampled, Unwired, Wired


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
        ({}, "no wiring property"),
        ({"mavlink.camera": "front"}, "mavlink.camera is not a whole number"),
        ({"mavlink.servo": "9"}, "neither parameter pwm nor property"),
        ({"mavlink.command.takePhoto": "photo"}, "not a command number"),
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


@pytest.mark.parametrize("name", ["startVideo", "start", "stopRecording"])
def test_a_video_is_begun_and_ended_by_the_actions_name(name):
    found = wired(name, **{"mavlink.video": "0"})
    assert found == (Wired(2501, (0.0,), 2.0) if name.startswith("stop") else Wired(2500, (0.0, 0.0), 2.0))


def test_a_video_is_begun_by_an_action_of_any_name_where_the_property_says_so():
    assert wired("film", **{"mavlink.video": "1", "mavlink.video.film": "start"}) == Wired(
        2500, (1.0, 0.0), 2.0
    )


def test_a_video_that_is_neither_begun_nor_ended_is_not_wired():
    assert "start or stop" in wired("film", **{"mavlink.video": "0"}).reason


@pytest.mark.parametrize(
    ("name", "more", "metres"),
    [("start", {}, 12.0), ("survey", {"mavlink.trigger.survey": "7.5"}, 7.5), ("stop", {}, 0.0)],
)
def test_a_camera_is_triggered_by_distance(name, more, metres):
    found = wired(name, **{"mavlink.trigger": "12", **more})
    assert (found.command, found.params[0]) == (206, metres)


def triggered(distance: str):
    device = Device("d", {"trigger": DeviceAction("trigger", 0.0)}, {"mavlink.camera": "1"})
    action = replace(photo("d", "trigger"), parameters=(("distance", distance),))
    return wiring_of(action, replace(quad(), devices={"d": device}))


@pytest.mark.parametrize(("distance", "metres"), [("7.25", 7.25), ("0", 0.0)])
def test_a_camera_takes_images_in_passing_where_its_action_is_given_a_distance(distance, metres):
    assert triggered(distance) == Wired(206, (metres, 0.0, 1.0), 0.0)


@pytest.mark.parametrize("distance", ["-1", "nan", "far"])
def test_a_distance_that_is_none_is_not_wired(distance):
    assert f"distance of '{distance}'" in triggered(distance).reason


@pytest.mark.parametrize("metres", ["-3", "0", "nan", "wide"])
def test_a_trigger_by_no_distance_is_not_wired(metres):
    assert isinstance(wired("on", **{"mavlink.trigger": "2", "mavlink.trigger.on": metres}), Unwired)


@pytest.mark.parametrize(
    ("words", "params"),
    [
        ("relax", (1.0, 0.0)),
        ("length 5", (1.0, 1.0, 5.0, 0.0)),
        ("length -5 rate 0.5", (1.0, 1.0, -5.0, 0.5)),
        ("rate 0.3", (1.0, 2.0, 0.0, 0.3)),
    ],
)
def test_a_winch_lets_out_line_or_winds_it_up(words, params):
    found = wired("move", **{"mavlink.winch": "1", "mavlink.winch.move": words})
    assert found == Wired(42600, params, 2.0)


def test_a_winch_takes_its_length_from_the_actions_parameters():
    device = Device("d", {}, {"mavlink.winch": "1"})
    action = replace(photo("d", "lower"), parameters=(("length", "4"), ("rate", "0.2")))
    assert wiring_of(action, replace(quad(), devices={"d": device})).params == (1.0, 1.0, 4.0, 0.2)


@pytest.mark.parametrize("words", ["", "length", "length far", "speed 3", "length 3 rate"])
def test_a_winch_that_is_told_nothing_sensible_is_not_wired(words):
    assert isinstance(wired("move", **{"mavlink.winch": "1", "mavlink.winch.move": words}), Unwired)


@pytest.mark.parametrize(("words", "lock"), [("-90 0", 0.0), ("-45 180 north", 16.0)])
def test_a_gimbal_is_pointed(words, lock):
    found = wired("lookDown", **{"mavlink.gimbal": "2", "mavlink.gimbal.lookDown": words})
    pitch, yaw = map(float, words.split()[:2])
    assert found == Wired(1000, (pitch, yaw, 0.0, 0.0, lock, 0.0, 2.0), 2.0)


def test_a_camera_on_a_gimbal_still_takes_photos():
    found = wired("takePhoto", **{"mavlink.gimbal": "1", "mavlink.camera": "0"})
    assert found.command == 2000


def test_a_camera_may_promise_to_tell_each_image():
    assert wired(**{"mavlink.camera": "1", "mavlink.camera.confirms": "yes"}).confirmed


def test_a_device_that_is_wired_twice_is_ambiguous():
    found = wired(**{"mavlink.camera": "1", "mavlink.relay": "0", "mavlink.relay.takePhoto": "on"})
    assert found == Wired(181, (0.0, 1.0), 2.0)
    reason = wired(**{"mavlink.camera": "1", "mavlink.value": "CO2"}).reason
    assert "wired by mavlink.camera and mavlink.value, which is ambiguous" in reason


def reel(action, device):
    return Wired(183, (9.0, 1900.0), more=((183, (10.0, 1500.0)),)) if action.name == "pull" else None


REEL = {"kites.reel": DeviceWiring("kites.reel", "reels", reel)}


def test_a_plugin_wires_devices_of_its_own():
    device = Device("d", {"pull": DeviceAction("pull", 3.0)}, {"kites.reel": "9"})
    found = wiring_of(photo("d", "pull"), replace(quad(), devices={"d": device}), REEL)
    assert found == Wired(183, (9.0, 1900.0), 3.0, ((183, (10.0, 1500.0)),))


def test_an_action_that_no_wiring_of_the_device_knows_is_not_wired():
    device = Device("d", {}, {"kites.reel": "9"})
    found = wiring_of(photo("d", "push"), replace(quad(), devices={"d": device}), REEL)
    assert found == Unwired("device 'd': kites.reel does not define action 'push'")


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ("70000 1", "is command 70000, and MAVLink's are 0 to 65535"),
        ("-5 1", "is command -5"),
        ("183 1e300", "not a number of single precision"),
        ("183 nan", "not a number of single precision"),
    ],
)
def test_a_command_whose_numbers_no_frame_holds_is_not_wired(words, why):
    found = wired("ping", **{"mavlink.command.ping": words})
    assert isinstance(found, Unwired)
    assert why in found.reason


@pytest.mark.parametrize(
    "found",
    [
        "photo",
        (183, (1.0,)),
        Wired("x", (1.0,)),
        Wired(183, ("1",)),
        Wired(183, 1.0),
        Wired(183, (), more=(184,)),
        Wired(183, (), seconds="1"),
        Sampled(5),
    ],
)
def test_a_plugin_that_returns_no_wiring_is_named(found):
    wirings = {"k.reel": DeviceWiring("k.reel", "wrong", lambda action, device: found)}
    device = Device("d", {}, {"k.reel": ""})
    with pytest.raises(
        PluginError, match=r"k.reel.*returns .* for action 'takePhoto', which is not a wiring"
    ):
        wiring_of(photo("d"), replace(quad(), devices={"d": device}), wirings)


@pytest.mark.parametrize(
    "found",
    [Wired(70_000, ()), Wired(183, (), more=((-1, ()),)), Wired(183, (), -1.0), Sampled("too long name")],
)
def test_a_plugins_wiring_that_no_vehicle_takes_is_not_wired(found):
    wirings = {"k": DeviceWiring("k", "wrong", lambda action, device: found)}
    device = Device("d", {}, {"k": ""})
    assert isinstance(wiring_of(photo("d"), replace(quad(), devices={"d": device}), wirings), Unwired)


@pytest.mark.parametrize("params", [(float("nan"),), (float("inf"),), (0.0,) * 8])
def test_a_plugins_wiring_with_parameters_that_no_vehicle_takes_is_not_wired(params):
    wirings = {"k": DeviceWiring("k", "wrong", lambda action, device: Wired(183, params))}
    device = Device("d", {}, {"k": ""})
    assert isinstance(wiring_of(photo("d"), replace(quad(), devices={"d": device}), wirings), Unwired)


@pytest.mark.parametrize(("named", "trial"), [("takePhoto zoom", True), ("zoom", False), ("", False)])
def test_an_action_may_be_tried_on_the_ground_where_the_device_says_so(named, trial):
    found = wired(**{"mavlink.camera": "1", "mavlink.trial": named})
    assert isinstance(found, Wired)
    assert found.trial is trial
