"""What goes wrong with a vehicle that is driven by hand is told, and nobody is driven on."""

import pytest
from dives_by_hand import DEVICE_ACTION, sub
from mavlink_peer import linked
from patience import until
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.behaviour.program import Action
from mmrs_core.scene import Policy
from mmrs_mavlink.plugin.manual.autopilot import DEPTH_HOLD, TOLD, StickAutopilot
from mmrs_mavlink.plugin.manual.troubles import LINK_PATIENCE
from mmrs_mavlink.services.commands import command

pytestmark = pytest.mark.real_time("vessels")


@pytest.mark.parametrize("number", TOLD)
def test_nobody_is_driven_by_a_heading_or_a_depth_of_the_past(number):
    with sub() as driven:
        driven.set_out()
        command(driven.backend._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, float(number), -1.0)
        until(lambda: driven.fault)
        assert driven.fault.which == "POSITION_LOST"
        here = driven.truth
        driven.pass_by(5.0)
        assert driven.truth == pytest.approx(here, abs=0.2)
    assert not driven.vehicle.autopilot.armed


def test_a_vehicle_that_was_disarmed_has_not_reached_anything():
    with sub() as driven:
        driven.set_out()
        command(driven.backend._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0.0)
        until(lambda: driven.fault or driven.done)
        assert driven.fault.which == "MOTORS_OFF"


def test_a_vehicle_that_hears_no_sticks_any_more_stops():
    with sub() as driven:
        driven.set_out()
        driven.backend._ended.set()
        driven.backend._released = True
        until(lambda: not driven.vehicle.autopilot.armed)
        assert any("manual control" in text for _, _, text in driven.vehicle.autopilot.said)


def test_who_takes_the_stick_has_the_vehicle():
    with sub() as driven:
        driven.set_out()
        driven.vehicle.faults.begin("stick", "manual")
        until(lambda: driven.fault is not None)
        assert driven.fault.which == "TAKEN_OVER"
        driven.stop("NOTHING")
        assert driven.fault is None
        assert driven.vehicle.autopilot.armed


def test_a_link_that_is_lost_is_told():
    with sub() as driven:
        driven.begin("out")
        driven.vehicle.faults.begin("link-down")
        until(lambda: driven.fault is not None)
        assert driven.fault.which == "LINK_LOST"


def test_a_stall_of_this_program_is_no_silence_of_the_vehicle():
    with sub() as driven:
        driven.set_out()
        driven.clock._zero -= 20.0 * LINK_PATIENCE / driven.clock.speedup
        assert driven.backend._autopilot.trouble(LINK_PATIENCE) is None
        driven.pass_by(1.0)
        assert driven.fault is None


def test_a_vehicle_that_is_not_heard_stays_and_goes_on_when_it_is_heard_again_if_policies_bear_that():
    with sub() as driven:
        driven.set_out()
        driven.vehicle.radio.mute = True
        until(lambda: driven.fault)
        assert driven.backend.bear(driven.clock.now())
        assert driven.fault is None
        east = driven.truth[0]
        driven.pass_by(5.0)
        assert driven.truth[0] == pytest.approx(east, abs=0.2)
        driven.vehicle.radio.mute = False
        until(lambda: driven.backend.reachable(driven.clock.now()))
        driven.finish()
        assert driven.truth[0] == pytest.approx(6.0, abs=1.5)


def test_a_battery_that_gets_low_is_told_and_it_comes_up_by_itself():
    with sub() as driven:
        driven.go_down()
        driven.vehicle.faults.begin("battery", 0.15)
        until(lambda: driven.fault)
        assert driven.fault.which == "BATTERY_LOW"
        driven.stop("SURFACE")
        assert driven.vehicle.autopilot.mode_name == "surface"
        assert driven.truth[2] >= -0.4
        assert not driven.undone
        assert not driven.backend.watched(driven.clock.now())
        assert "its position is unknown" in driven.backend.hindrance((), "out", driven.clock.now())


def test_water_inside_brings_it_up():
    with sub() as driven:
        driven.go_down()
        driven.vehicle.autopilot.say(4, "Leak Detected")
        until(lambda: driven.fault)
        assert (driven.fault.which, driven.fault.instead) == ("CRASHED", "SURFACE")
        driven.stop("SURFACE")
        assert driven.truth[2] >= -0.4


def test_what_a_policy_bears_for_a_while_is_told_after_that():
    with sub(policies=(Policy("BATTERY_LOW", "SURFACE", 20.0),)) as driven:
        driven.go_down()
        driven.vehicle.faults.begin("battery", 0.15)
        begun = driven.clock.now()
        until(lambda: driven.fault)
        assert driven.clock.now() - begun >= 19.0


def test_a_low_battery_overtakes_a_vehicle_that_holds_until_it_is_answered():
    with sub() as driven:
        driven.go_down()
        driven.stop("HOLD")
        driven.vehicle.faults.begin("battery", 0.15)
        until(lambda: driven.fault)
        assert driven.fault.which == "BATTERY_LOW"
        driven.stop("SURFACE")
        assert driven.truth[2] >= -0.4
        assert driven.fault is None


def test_an_autopilot_that_begins_anew_is_told_and_not_taken_for_a_pilot():
    with sub() as driven:
        driven.begin("out")
        driven.pass_by(15.0)
        driven.vehicle.faults.begin("restart")
        until(lambda: driven.fault and driven.fault.which == "VEHICLE_RESTARTED")
        driven.stop("SURFACE")
        assert "it is disarmed" in driven.undone
        assert not driven.vehicle.autopilot.armed


def test_a_device_that_does_not_answer_is_told_while_the_vehicle_is_steered_on():
    with sub() as driven:
        driven.begin("out")
        driven.finish()
        driven.vehicle.faults.begin("silent", mavlink.MAV_CMD_DO_SET_RELAY)
        driven.backend.do(Action(DEVICE_ACTION, "on", "lamp"), driven.clock.now())
        until(lambda: driven.fault)
        assert driven.fault.which == "DEVICE_SILENT"
        assert driven.vehicle.autopilot.armed
        assert driven.backend.bear(driven.clock.now())
        driven.finish()


def test_a_goal_that_is_not_reached_in_time_ends_the_dive():
    with sub() as driven:
        driven.begin("out")
        driven.backend._route.late_at = driven.clock.now()
        until(lambda: driven.fault)
        assert (driven.fault.which, driven.fault.instead) == ("NO_PROGRESS", "SURFACE")


def test_a_link_that_falls_silent_is_no_lost_heading_whatever_was_told_last():
    with linked(speedup=4.0) as (link, wire):
        pilot = StickAutopilot(link, lambda: False, 0.2)
        wire.say(mavlink.MAVLink_attitude_message(0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0))
        wire.say(mavlink.MAVLink_global_position_int_message(0, 0, 0, -2000, -2000, 0, 0, 0, 0))
        link.wait(lambda: None, 0.5)
        wire.beat(mode=DEPTH_HOLD, armed=True)
        seen = []
        until(lambda: seen.append(pilot.trouble(LINK_PATIENCE)) or link.silent_for() > LINK_PATIENCE + 1.0)
    told = [fault.event for fault in seen if fault is not None]
    assert told
    assert set(told) == {"LINK_LOST"}
