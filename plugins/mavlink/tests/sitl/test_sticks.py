"""Manual control of an underwater vehicle, which disarms when it stops."""

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.commands import FULL_STICK, execute, take_sticks
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.simulation import advance

FULL_SPEED, _, FULL_CLIMB, FULL_TURN = FULL_STICK
ARM = mavlink.MAV_CMD_COMPONENT_ARM_DISARM


def sub(mode="alt_hold", *, located=False):
    pilot = SimulatedAutopilot(Settings(kind="sub", ready=0.0, boot=0.0))
    pilot.located = located
    pilot.enter(mode)
    advance(pilot, 0.1)
    return pilot


def drive(pilot, seconds, x=0, y=0, z=500, r=0):
    for _ in range(round(seconds / 0.1)):
        take_sticks(pilot, mavlink.MAVLink_manual_control_message(1, x, y, z, r, 0))
        advance(pilot, 0.1)


def armed(**options):
    pilot = sub(**options)
    assert execute(pilot, ARM, (1.0, *[0.0] * 6)) == mavlink.MAV_RESULT_ACCEPTED
    return pilot


@pytest.mark.parametrize(
    ("mode", "result"), [("alt_hold", "ACCEPTED"), ("manual", "ACCEPTED"), ("guided", "FAILED")]
)
def test_only_manual_modes_arm_without_a_position(mode, result):
    pilot = sub(mode, located=True)
    pilot.located = False
    assert execute(pilot, ARM, (1.0, *[0.0] * 6)) == getattr(mavlink, f"MAV_RESULT_{result}")


@pytest.mark.parametrize(("heading", "x", "y", "share"), [(90.0, 500, 0, 0.5), (0.0, 0, 1000, 1.0)])
def test_sticks_move_a_vehicle_forward_and_to_the_right(heading, x, y, share):
    pilot = armed()
    pilot.body.heading = heading
    drive(pilot, 10.0, x=x, y=y)
    north, east, up = pilot.body.position
    speed = share * FULL_SPEED
    assert 8.0 * speed < east < 10.0 * speed
    assert (north, up) == pytest.approx((0.0, 0.0), abs=1e-6)


def test_a_vehicle_dives_and_holds_its_depth_at_neutral_sticks():
    pilot = armed()
    drive(pilot, 8.0, z=0)
    depth = -pilot.body.position[2]
    assert depth == pytest.approx(8.0 * FULL_CLIMB, abs=0.8)
    drive(pilot, 10.0)
    assert -pilot.body.position[2] == pytest.approx(depth, abs=0.7)


def test_a_vehicle_does_not_leave_the_water():
    pilot = armed()
    drive(pilot, 4.0, z=0)
    drive(pilot, 60.0, z=1000)
    assert -0.3 <= pilot.body.position[2] <= 1e-6


def test_a_turn_is_proportional_to_its_stick():
    pilot = armed()
    drive(pilot, 2.0, r=-500)
    assert pilot.body.heading == pytest.approx(360.0 - FULL_TURN, abs=3.0)


def test_a_vehicle_disarms_without_manual_control():
    pilot = armed()
    drive(pilot, 2.0, x=1000)
    advance(pilot, 2.5)
    assert pilot.armed
    advance(pilot, 1.0)
    assert not pilot.armed


def test_other_kinds_ignore_sticks():
    pilot = SimulatedAutopilot(Settings(kind="rover", ready=0.0, boot=0.0))
    pilot.arm()
    drive(pilot, 5.0, x=1000)
    assert pilot.body.position == (0.0, 0.0, 0.0)
