"""Autopilots that start anew, where policies say that the robot carries on."""

import pytest
from flight_crew import SPEEDUP, manned, robot_of
from patience import until
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from resets import reset

from mmrs_mavlink.program import Geographic, Policy
from mmrs_mavlink.services.uploads import Uploads
from mmrs_runtime.faults import FaultError

CARRIES_ON = Policy("VEHICLE_RESTARTED", "CONTINUE")
PATIENT = Policy("LINK_LOST", "RETURN", 60.0)


def grow_old(made) -> None:
    """Wait until what the vehicle tells of its age after a restart cannot have been late on its way."""
    until(lambda: made.simulated.autopilot.uptime > 1.5 * SPEEDUP)


def restart(made, *, armed: bool) -> None:
    grow_old(made)
    if armed:
        reset(made.simulated)
    else:
        made.simulated.faults.begin("restart")


def test_a_vehicle_whose_motors_go_on_is_landed_since_it_has_forgotten_what_it_did(in_the_air):
    made = in_the_air(CARRIES_ON, PATIENT)
    restart(made, armed=True)
    fault = made.caught()
    assert (fault.event, fault.instead) == ("VEHICLE_RESTARTED", "LAND")
    assert "in motion, armed: its program cannot be continued" in str(fault)


def test_a_vehicle_whose_motors_have_stopped_on_its_way_ends_the_program_in_words(in_the_air):
    made = in_the_air(CARRIES_ON, PATIENT)
    made.quiet(2.0)
    restart(made, armed=False)
    fault = made.caught()
    assert (fault.event, fault.instead) == ("VEHICLE_RESTARTED", "HOLD")
    assert "disarmed: its program cannot be continued" in str(fault)


@pytest.fixture
def on_the_ground():
    """Return a robot that is set up, and stands at its home."""
    with manned(robot_of(CARRIES_ON, PATIENT)) as made:
        made.vehicle.prepare(Uploads())
        made.watch.renew()
        yield made


def test_a_rover_that_is_being_charged_may_start_anew(on_the_ground):
    made = on_the_ground
    made.vehicle._mode_control.enter("guided")
    made.watch.moving = False
    restart(made, armed=False)
    made.quiet(2.0 * SPEEDUP)
    assert made.watch.restarted


def go_again_and_again(made) -> None:
    while True:
        made.vehicle.go_to(Geographic(42.3701, 13.35, 0.0), 1.0, None, False)


def test_a_rover_that_refuses_a_speed_since_it_has_restarted_counts_as_restarted():
    with manned(robot_of(PATIENT, vehicle="rover"), kind="rover") as made:
        made.vehicle.prepare(Uploads())
        made.watch.renew()
        made.watch.moving = True
        simulated, speeds = made.simulated, []
        hear = simulated._take

        def refuse_the_last_speed(message):
            if getattr(message, "command", 0) == mavlink.MAV_CMD_DO_CHANGE_SPEED:
                speeds.append(message)
            if len(speeds) < made.link.profile.speed_repeats:
                hear(message)
                return
            simulated.autopilot.aimed = False
            hear(message)
            simulated._take = hear
            reset(simulated)

        grow_old(made)
        simulated._take = refuse_the_last_speed
        with pytest.raises(FaultError) as fault:
            go_again_and_again(made)
        assert fault.value.event == "VEHICLE_RESTARTED"


def test_people_are_told_before_that_carrying_on_counts_on_the_ground_only(on_the_ground):
    made = on_the_ground
    told = []
    made.watch.say = told.append
    made.watch.forewarn()
    assert told == ["carries on after VEHICLE_RESTARTED before it sets out only; in motion it does LAND then"]


def test_a_vehicle_that_forgot_in_flight_what_it_was_to_report_has_restarted_and_reports_again(in_the_air):
    made = in_the_air(Policy("VEHICLE_RESTARTED", "LAND"), PATIENT)
    made.quiet(2.0)
    restart(made, armed=False)
    fault = made.caught()
    assert (fault.event, str(fault)) == ("VEHICLE_RESTARTED", "the vehicle has restarted, in mode stabilize")
    asked = made.clock.now()
    until(lambda: made.clock.now() - made.link.since("SYS_STATUS") > asked)


def test_a_vehicle_that_forgot_on_the_ground_what_it_was_to_report_is_asked_again(on_the_ground):
    made = on_the_ground
    made.watch.moving = False
    restart(made, armed=False)
    until(lambda: made.link.since("SYS_STATUS") > 2.0 * SPEEDUP)
    made.quiet(2.0 * SPEEDUP)
    assert made.link.since("SYS_STATUS") < SPEEDUP
