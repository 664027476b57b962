"""Wirings of devices: the commands that a simulated vehicle gets from a generated controller."""

from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, target_input

from mmrs_core.generation.render import render
from mmrs_core.scene import Device, DeviceAction, Policy
from mmrs_core.testing.programs import photo, program
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.wiring import DeviceWiring, Wired

pytestmark = pytest.mark.real_time("controllers")

ACTS = replace(go_to("a", (0.0, 12.0, 5.0)), after=(photo("device", "act"),))
MADE = program(robot_program("alpha", [take_off("up", 5.0), ACTS, LAND]))
REEL = DeviceWiring(
    "kites.reel",
    "reels in, and brakes",
    lambda action, device: Wired(183, (9.0, 1900.0), more=((183, (8.0, 1500.0)),)),
)


WIRED = {
    "video": ({"mavlink.video": "0", "mavlink.video.act": "start"}, (2500, (0.0, 0.0))),
    "trigger": ({"mavlink.trigger": "5", "mavlink.trigger.act": "7.5"}, (206, (7.5, 0.0, 1.0))),
    "winch": (
        {"mavlink.winch": "1", "mavlink.winch.act": "length 3 rate 0.5"},
        (42600, (1.0, 1.0, 3.0, 0.5)),
    ),
    "gimbal": (
        {"mavlink.gimbal": "2", "mavlink.gimbal.act": "-90 0"},
        (1000, (-90.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0)),
    ),
    "camera": ({"mavlink.camera": "0", "mavlink.camera.confirms": "yes"}, (2000, (0.0, 0.0, 1.0))),
    "reel": ({"kites.reel": "9"}, (183, (9.0, 1900.0))),
    "brake": ({"kites.reel": "9"}, (183, (8.0, 1500.0))),
}
"""Properties of a device, and a command that the vehicle gets for its action."""


@pytest.fixture(scope="module")
def heard(new_controllers, new_hangar, tmp_path_factory):
    """Return the commands that a vehicle has carried out for a robot whose devices all act once."""
    devices = {
        name: Device(name, {"act": DeviceAction("act", 1.0)}, properties)
        for name, (properties, _) in WIRED.items()
    }
    acts = replace(ACTS, after=tuple(photo(name, "act") for name in WIRED))
    made = program(robot_program("alpha", [take_off("up", 5.0), acts, LAND]))
    given = target_input(made, [replace(quad(), devices=devices)])
    files = render(MAVLINK_PYTHON, replace(given, extensions={"device_actions": {"kites.reel": REEL}}))
    controllers = new_controllers(tmp_path_factory.mktemp("devices"), made, files=files)
    with new_hangar() as hangar:
        vehicles, links = hangar(made)
        code, said = controllers.run("fleet.py", *links)
    assert code == 0, said
    return [(command, tuple(params)) for _, command, params in vehicles["alpha"].autopilot.history]


@pytest.mark.parametrize("name", WIRED)
def test_a_device_is_driven_by_its_command(heard, name):
    _, (number, params) = WIRED[name]
    assert (number, (*params, *[0.0] * (7 - len(params)))) in heard


def test_a_wiring_of_a_plugin_sends_its_commands_one_after_the_other(heard):
    commands = [params[:2] for number, params in heard if number == 183]
    assert commands[:2] == [(9.0, 1900.0), (8.0, 1500.0)]


def test_a_camera_that_promises_to_tell_each_image_and_does_not_is_silent(new_controllers, hangar, tmp_path):
    properties, _ = WIRED["camera"]
    device = Device("device", {"act": DeviceAction("act", 1.0)}, properties)
    (drone,) = MADE.robots
    lands = replace(MADE, robots=(replace(drone, policies=(Policy("DEVICE_SILENT", "LAND", 0.0),)),))
    given = target_input(lands, [replace(quad(), devices={"device": device})])
    made = new_controllers(tmp_path / "code", lands, files=render(MAVLINK_PYTHON, given))
    vehicles, links = hangar(lands)
    vehicles["alpha"].autopilot.takes_photos = False
    code, said = made.run("fleet.py", *links)
    assert code == 1
    assert "DEVICE_SILENT" in said
