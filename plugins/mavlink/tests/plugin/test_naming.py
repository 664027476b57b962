from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, target_input

from mmrs_core.behaviour.program import Program
from mmrs_core.generation.render import render
from mmrs_core.scene import Device, DeviceAction
from mmrs_core.testing.programs import photo, program
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON, command_name, robot_of
from mmrs_mavlink.wiring import DeviceWiring, Wired

REEL = Device("reel", {"pull": DeviceAction("pull", 2.0)}, {"kites.reel": "9"})
REELS = DeviceWiring("kites.reel", "reels", lambda action, device: Wired(183, (9.0,), more=((31_999, ()),)))


@pytest.fixture
def reeling() -> Program:
    """Return a robot whose moves end where one way out is the same, and which pulls its reel in."""
    there, back = go_to("a", (0.0, 9.0, 5.0)), go_to("b", (0.0, 5.0, 5.0))
    moves = [take_off("up", 5.0), replace(there, after=(photo("reel", "pull"),)), back, LAND]
    return program(robot_program("alpha", moves))


def given(made: Program):
    return replace(
        target_input(made, [replace(quad(), devices={"reel": REEL})]),
        extensions={"device_actions": {"kites.reel": REELS}},
    )


def source(made: Program) -> str:
    return render(MAVLINK_PYTHON, given(made))[0].content.decode()


def test_a_way_out_that_moves_share_is_written_once(reeling):
    text = source(reeling)
    assert text.count("ESCAPE_1 = (Geographic(") == 1
    assert 'escapes=(("up", ESCAPE_1), ("a", ESCAPE_1), ("b", ESCAPE_1))' in text


def test_a_command_is_written_by_its_name_where_it_has_one(reeling):
    text = source(reeling)
    assert "\nMAV_CMD_DO_SET_SERVO = 183\n" in text
    assert 'Operate("reel", "pull", MAV_CMD_DO_SET_SERVO, (9.0,), 2.0, more=((31999, ()),))' in text


def test_the_program_is_the_same_with_names_as_without(reeling):
    scope: dict[str, object] = {"__name__": "written"}
    exec(source(reeling), scope)  # noqa: S102
    assert scope["ROBOT"] == robot_of(reeling.robots[0], given(reeling))


def test_what_ends_the_list_of_commands_is_no_name_of_one():
    from pymavlink.dialects.v20 import ardupilotmega as mavlink

    assert command_name(mavlink.MAV_CMD_ENUM_END) == ""
    assert command_name(203) == "MAV_CMD_DO_DIGICAM_CONTROL"
