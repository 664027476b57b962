"""What ends a robot's program: seen by the watch on a real link to a simulated vehicle."""

import pytest
from flight_crew import OVERHEAD, SPEEDUP, in_background, robot_of
from patience import until
from resets import reset

from mmrs_mavlink.program import Policy
from mmrs_mavlink.steps.watch import Watch
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import FaultError


@pytest.mark.parametrize(
    ("policy", "escapes", "told"),
    [("EMERGENCY_AREA", (), True), ("EMERGENCY_AREA", (("out", (OVERHEAD,)),), False), ("RETURN", (), False)],
)
def test_a_robot_that_has_no_way_to_an_emergency_area_says_so_before_it_moves(policy, escapes, told):
    said = []
    watch = Watch(robot_of(Policy("OBSTACLE", policy), escapes=escapes), Clock())
    watch.say = said.append
    watch.forewarn()
    assert any("no clear path to an emergency area" in line for line in said) is told


def test_a_robot_that_is_well_is_let_alone(in_the_air):
    in_the_air().quiet(10.0)


def test_a_silent_link_is_lost_after_the_seconds_of_the_policy(in_the_air):
    made = in_the_air(Policy("LINK_LOST", "RETURN", 50.0))
    made.simulated.faults.begin("link-down")
    cut = made.clock.now()
    fault = made.caught()
    assert fault.event == "LINK_LOST"
    assert made.clock.now() - cut > 45.0


def test_a_silent_link_is_borne_by_who_carries_on_only(in_the_air):
    made = in_the_air(Policy("LINK_LOST", "CONTINUE"))
    made.simulated.faults.begin("link-down")
    until(lambda: made.link.silent_for() > 60.0)
    made.watch.check()
    bound = Policy("LINK_LOST", "LAND", 1.0)
    made.watch.current = lambda: (bound,)
    assert made.caught().event == "LINK_LOST"


def test_a_pilot_who_takes_the_stick_has_the_vehicle(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "CONTINUE"))
    made.simulated.faults.begin("stick", "loiter")
    assert made.caught().event == "TAKEN_OVER"
    assert made.watch.taken
    made.watch.let_go()
    made.quiet(5.0)


def test_a_pilot_goes_before_what_he_took_over_for(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "LAND"))
    made.simulated.faults.begin("gps-lost")
    made.simulated.faults.begin("stick", "stabilize")
    assert made.caught().event == "TAKEN_OVER"


def test_a_landing_that_the_vehicle_began_by_itself_is_told_with_its_cause(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "LAND", 1000.0))
    made.simulated.faults.begin("gps-lost")
    until(lambda: made.mode == "land")
    assert made.caught().event == "POSITION_LOST"
    assert not made.watch.taken


def test_a_cause_that_is_told_after_the_change_of_mode_is_waited_for(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "LAND", 1000.0))
    made.simulated.faults.begin("stick", "land")
    until(lambda: made.vehicle.state().mode == "land")
    caught = in_background(made.caught)
    until(lambda: made.watch.looking)
    made.simulated.faults.begin("gps-lost")
    assert caught.result(20.0).event == "POSITION_LOST"


def test_a_landing_for_which_no_cause_is_told_is_a_pilots(in_the_air):
    made = in_the_air()
    made.simulated.faults.begin("stick", "land")
    assert made.caught().event == "TAKEN_OVER"


def test_seconds_without_a_position_count_only_as_long_as_they_last(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "LAND", 20.0))
    made.vehicle.hold()
    with made.simulated.lock:
        made.simulated.autopilot.parameters["FS_EKF_ACTION"] = 0.0
    trouble = made.vehicle.telemetry.position_trouble
    for _ in range(2):
        made.simulated.faults.begin("gps-lost")
        until(trouble)
        made.quiet(12.0)
        made.simulated.faults.end("gps-lost")
        until(lambda: not trouble())
        made.quiet(1.0)
    made.simulated.faults.begin("gps-lost")
    assert made.caught().event == "POSITION_LOST"


def test_a_position_that_leaps_counts_at_once_whatever_seconds_are_borne(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "LAND", 1000.0))
    made.simulated.faults.begin("position-shift", 40.0, 90.0)
    fault = made.caught()
    assert fault.event == "POSITION_LOST"
    assert "its position has leapt by 40 m" in str(fault)
    made.watch.tighten()
    made.quiet(5.0)


def test_a_position_that_leaps_is_borne_by_who_carries_on(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "CONTINUE"))
    made.simulated.faults.begin("position-shift", 40.0)
    until(lambda: made.vehicle.telemetry.jumps.count)
    made.quiet(5.0)
    assert made.decided == [("POSITION_LOST", "CONTINUE")]


def test_what_a_policy_bears_is_told_once(in_the_air):
    made = in_the_air(Policy("OBSTACLE", "CONTINUE"))
    made.simulated.faults.begin("obstacle", 3.0)
    until(lambda: made.vehicle.telemetry.obstacle())
    made.quiet(5.0)
    assert made.decided == [("OBSTACLE", "CONTINUE")]


def test_the_policies_of_a_wait_go_before_those_of_the_robot(in_the_air):
    made = in_the_air(Policy("OBSTACLE", "CONTINUE"))
    made.watch.current = lambda: (Policy("OBSTACLE", "HOLD"),)
    made.simulated.faults.begin("obstacle", 3.0)
    assert made.caught().event == "OBSTACLE"


def test_a_battery_under_the_reserve_is_low(in_the_air):
    made = in_the_air()
    made.simulated.faults.begin("battery", 0.09)
    fault = made.caught()
    assert fault.event == "BATTERY_LOW"
    assert "less than 10%" in str(fault)


@pytest.mark.parametrize(
    ("handled", "response", "heeded"),
    [
        ({"DEVICE_SILENT"}, "HOLD", True),
        ({"DEVICE_SILENT"}, "RETURN", False),
        ({"BATTERY_LOW"}, "HOLD", False),
    ],
)
def test_a_low_battery_overtakes_only_responses_that_do_not_bring_the_robot_down(
    in_the_air, handled, response, heeded
):
    made = in_the_air()
    made.watch.relax(handled, response)
    made.simulated.faults.begin("battery", 0.05)
    until(lambda: (made.vehicle.state().energy or 1.0) < 0.06)
    if heeded:
        assert made.caught().event == "BATTERY_LOW"
    else:
        made.quiet(5.0)


def test_a_robot_that_goes_on_heeds_everything_again(in_the_air):
    made = in_the_air(Policy("OBSTACLE", "HOLD"))
    made.watch.relax({"OBSTACLE"}, "HOLD")
    made.simulated.faults.begin("obstacle", 3.0)
    until(lambda: made.vehicle.telemetry.obstacle())
    made.quiet(2.0)
    made.watch.tighten()
    assert made.caught().event == "OBSTACLE"


def test_motors_that_stop_in_the_air_are_a_crash(in_the_air):
    made = in_the_air()
    made.quiet(2.0)
    with made.simulated.lock:
        made.simulated.autopilot.disarm()
    assert made.caught().event == "MOTORS_OFF"


def test_motors_that_stop_after_a_landing_are_not(in_the_air):
    made = in_the_air()
    made.quiet(2.0)
    made.vehicle.land()
    assert not made.simulated.autopilot.armed
    made.quiet(5.0)


def grow_old(made):
    """Wait until what the vehicle tells of its age after a restart cannot have been late on its way."""
    until(lambda: made.simulated.autopilot.time > 1.5 * SPEEDUP)


def test_a_restart_in_the_air_is_a_fault(in_the_air):
    made = in_the_air()
    grow_old(made)
    reset(made.simulated)
    assert made.caught().event == "VEHICLE_RESTARTED"


def test_a_restart_on_the_ground_is_kept_for_later(in_the_air):
    made = in_the_air()
    made.vehicle.land()
    made.watch.moving = False
    grow_old(made)
    made.simulated.faults.begin("restart")
    made.quiet(2.0 * SPEEDUP)
    assert made.watch.restarted
    made.watch.renew()
    assert not made.watch.restarted


@pytest.fixture
def back(in_the_air):
    """Return a function that gives a robot whose link was lost, and is heard again in a mode."""

    def fly(mode: str):
        made = in_the_air(Policy("LINK_LOST", "HOLD", 5.0))
        made.vehicle.answer_lost_link("HOLD", 5.0)
        made.simulated.faults.begin("link-down")
        assert made.caught().event == "LINK_LOST"
        made.watch.relax({"LINK_LOST"}, "LAND")
        until(lambda: made.mode == "hold")
        made.simulated.faults.begin("stick", mode)
        made.simulated.faults.end("link-down")
        until(lambda: made.link.since("HEARTBEAT") < SPEEDUP)
        until(lambda: not made.vehicle.telemetry.announcements.recent())
        return made

    return fly


def test_a_vehicle_that_is_heard_again_in_the_mode_that_it_was_told_for_then_may_be_told_something(back):
    made = back("hold")
    made.watch.check_hands("LINK_LOST")
    made.vehicle.land()
    assert not made.simulated.autopilot.armed


def test_a_vehicle_that_is_heard_again_in_another_mode_is_a_pilots(back):
    made = back("return")
    with pytest.raises(FaultError, match="it is under external control"):
        made.watch.check_hands("LINK_LOST")


FALLING = 4.0
"""Speed-up at which telemetry shows a fall of 1.4 s, also on a busy machine."""


def test_a_failed_motor_is_answered_and_what_lies_on_the_ground_is_disarmed(in_the_air):
    made = in_the_air(Policy("MOTOR_FAILED", "LAND"), speedup=FALLING)
    made.simulated.faults.begin("motor-failed")
    fault = made.caught()
    assert (fault.event, fault.instead) == ("MOTOR_FAILED", "")
    made.watch.relax({"MOTOR_FAILED"}, "LAND")
    fault = made.caught()
    assert (fault.event, fault.instead) == ("MOTOR_FAILED", "STOP_THRUST")
    assert made.simulated.autopilot.body.position[2] == 0.0
    made.watch.relax({"MOTOR_FAILED"}, "STOP_THRUST")
    made.vehicle.disarm()
    made.quiet(2.0)


def test_a_crash_that_the_vehicle_reports_while_it_lands_is_no_landing(in_the_air):
    made = in_the_air()
    made.watch.relax({"MOTOR_FAILED"}, "LAND")
    landing = in_background(made.vehicle.land)
    until(lambda: made.mode == "land")
    with made.simulated.lock:
        made.simulated.autopilot.say(0, "Crash: Disarming: AngErr=37>30, Accel=1.3<3.0")
    until(made.vehicle.telemetry.crash)
    with made.simulated.lock:
        made.simulated.autopilot.disarm()
    with pytest.raises(FaultError, match="Crash: Disarming: AngErr=37>30") as crash:
        landing.result(20.0)
    assert crash.value.event == "MOTORS_OFF"
