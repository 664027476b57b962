"""Plans for robots whose type says that a PX4 flies them."""

import json
from dataclasses import replace
from math import isnan

import pytest
from mmrs_multicopter.testing import MULTICOPTER, go_to, quad, robot_program, take_off, target_input
from pymavlink import mavwp

from mmrs_core.behaviour.program import Heading, MoveTarget
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.scene import Device, DeviceAction
from mmrs_core.testing.programs import move, photo, program
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.wpl import WPL

PX4 = {"mavlink.autopilot": "px4"}
UP, LAND = take_off("up", 20.0), move("down", "Land", uri=MULTICOPTER)
AHEAD = Heading(MoveTarget((0.0, 90.0, 0.0)), "camera")
HERE = go_to("a", (0.0, 30.0, 25.0))


def given(*moves, properties=PX4, mode="NORMAL", devices=()):
    robot = replace(robot_program("alpha", [UP, *moves, LAND]), travel_mode=mode)
    type = quad(**properties)
    more = {device.id: device for device in devices}
    return target_input(program(robot), [replace(type, devices={**type.devices, **more})])


def plan(*moves, allow_lossy=False, **options):
    (file,) = (
        f for f in render(QGC_PLAN, given(*moves, **options), allow_lossy=allow_lossy) if "alpha" in f.path
    )
    return json.loads(file.content)["mission"]


def items(*moves, **options):
    return [(item["command"], item["params"]) for item in plan(*moves, **options)["items"]]


def test_a_plan_says_that_it_is_for_a_px4():
    found = plan(HERE)
    assert (found["firmwareType"], found["vehicleType"]) == (12, 2)


@pytest.mark.parametrize("properties", [{}, {"mavlink.autopilot": "ardupilot"}])
def test_a_plan_is_for_an_ardupilot_unless_a_device_says_otherwise(properties):
    found = plan(HERE, properties=properties)
    assert (found["firmwareType"], found["vehicleType"]) == (3, 2)
    assert [each["params"][1:4] for each in found["items"] if each["command"] == 16] == [[0.0, 0.0, 0.0]]


def test_headings_are_left_to_the_vehicle_since_nought_would_be_north():
    stay = move("stay", "HoldPosition", duration=5.0)
    headings = {command: params[3] for command, params in items(HERE, stay) if command != 178}
    assert headings == {22: None, 16: None, 19: None, 21: None}


@pytest.mark.parametrize(("mode", "radius"), [("SAFE", 1.0), ("NORMAL", 2.0), ("AGGRESSIVE", 2.0)])
def test_every_waypoint_has_its_radius_since_nought_would_be_ten_metres(mode, radius):
    assert [params[1] for command, params in items(HERE, mode=mode) if command == 16] == [radius]


def test_a_turn_on_the_spot_is_a_waypoint_with_a_heading():
    turn = replace(move("turn", "HeadTo"), heading=replace(AHEAD, angle_degrees=90.0))
    commands = items(HERE, turn)
    assert 115 not in [command for command, _ in commands]
    (there, turned) = [params for command, params in commands if command == 16]
    assert turned[:4] == [1.0, 2.0, 0.0, 270.0]
    assert turned[4:] == there[4:]


def test_a_photo_is_taken_as_on_any_vehicle():
    assert 2000 in [command for command, _ in items(replace(HERE, after=(photo(),)))]


def test_what_no_mission_of_a_px4_may_hold_is_refused_and_left_out():
    hatch = Device(
        "hatch", {"open": DeviceAction("open", 0.0)}, {"mavlink.servo": "9", "mavlink.servo.open": "1900"}
    )
    opens = replace(HERE, after=(replace(photo(), device="hatch", name="open"),))
    with pytest.raises(UnsupportedError) as error:
        plan(opens, devices=[hatch])
    assert error.value.elements == (
        "robot 'alpha', move 'a': action 'open': no mission of a PX4 has command 183",
    )
    left = items(opens, devices=[hatch], allow_lossy=True)
    assert 183 not in [command for command, _ in left]
    assert 183 in [command for command, _ in items(opens, devices=[hatch], properties={})]


@pytest.mark.parametrize(
    ("devices", "words"),
    [
        ((), "mavlink.autopilot is 'inav'; known are ardupilot and px4"),
        ((Device("brain", {}, PX4),), "mavlink.autopilot is 'inav', 'px4': it is ambiguous"),
    ],
)
def test_an_autopilot_that_nobody_knows_is_refused(devices, words):
    with pytest.raises(UnsupportedError) as error:
        plan(HERE, properties={"mavlink.autopilot": "inav"}, devices=devices)
    assert error.value.elements == (f"robot 'alpha': {words}",)


def test_a_list_of_waypoints_leaves_headings_free_too(tmp_path):
    (file,) = (f for f in render(WPL, given(HERE)) if f.path == "alpha.waypoints")
    (tmp_path / file.path).write_bytes(file.content)
    loader = mavwp.MAVWPLoader()
    assert loader.load(str(tmp_path / file.path)) == 5
    home, *rest = [loader.wp(number) for number in range(5)]
    assert home.param4 == 0.0
    assert [(each.command, isnan(each.param4)) for each in rest] == [
        (22, True),
        (178, False),
        (16, True),
        (21, True),
    ]


def test_a_px4_stays_for_fractions_of_seconds_as_it_is_told():
    hold = move("hold", "HoldPosition", duration=1.5)
    assert [item[1][0] for item in items(hold) if item[0] == 19] == [1.5]
