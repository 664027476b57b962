"""Wirings of devices: the commands that a simulated vehicle gets from a generated controller."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mmrs_core.contributions.wiring import DeviceWiring, Wired
from mmrs_core.generation.render import render
from mmrs_core.mavlink.controllers import MAVLINK_PYTHON
from mmrs_core.scene import Device, DeviceAction
from mmrs_core.testing.programs import (
    MULTICOPTER,
    go_to,
    move,
    photo,
    program,
    quad,
    robot_program,
    take_off,
    target_input,
)

LAND = move("down", "Land", uri=MULTICOPTER)
ACTS = replace(go_to("a", (0.0, 12.0, 5.0)), after=(photo("device", "act"),))
MADE = program(robot_program("alpha", [take_off("up", 5.0), ACTS, LAND]))
REEL = DeviceWiring(
    "kites.reel",
    "reels in, and brakes",
    lambda action, device: Wired(183, (9.0, 1900.0), more=((183, (10.0, 1500.0)),)),
)


@pytest.fixture
def heard(new_controllers, hangar, tmp_path):
    """Return a function that flies a device, and gives the commands that the vehicle carried out for it."""

    def flown(**properties):
        named = {name.replace("__", "."): value for name, value in properties.items()}
        device = Device("device", {"act": DeviceAction("act", 1.0)}, named)
        given = target_input(MADE, [replace(quad(), devices={"device": device})])
        given = replace(given, device_actions={"kites.reel": REEL})
        made = new_controllers(tmp_path / "code", MADE, files=render(MAVLINK_PYTHON, given))
        vehicles, links = hangar(MADE)
        code, said = made.run("fleet.py", *links)
        assert code == 0, said
        return [(command, tuple(params)) for _, command, params in vehicles["alpha"].autopilot.history]

    return flown


@pytest.mark.parametrize(
    ("properties", "command"),
    [
        ({"mavlink__video": "0", "mavlink__video__act": "start"}, (2500, (0.0, 0.0))),
        ({"mavlink__trigger": "5", "mavlink__trigger__act": "7.5"}, (206, (7.5, 0.0, 1.0))),
        ({"mavlink__winch": "1", "mavlink__winch__act": "length 3 rate 0.5"}, (42600, (1.0, 1.0, 3.0, 0.5))),
        (
            {"mavlink__gimbal": "2", "mavlink__gimbal__act": "-90 0"},
            (1000, (-90.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0)),
        ),
    ],
)
def test_a_device_is_driven_by_its_command(heard, properties, command):
    number, params = command
    padded = (*params, *[0.0] * (7 - len(params)))
    assert (number, padded) in heard(**properties)


def test_a_wiring_of_a_plugin_sends_its_commands_one_after_the_other(heard):
    commands = [params[:2] for number, params in heard(kites__reel="9") if number == 183]
    assert commands == [(9.0, 1900.0), (10.0, 1500.0)]
