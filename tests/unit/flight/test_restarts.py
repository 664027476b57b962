"""Autopilots that start anew, where policies say that the robot carries on."""

from __future__ import annotations

import pytest
from flight_crew import HOME, SPEEDUP, in_background, manned, robot_of
from patience import until

from mmrs_mavlink.places import distance
from mmrs_mavlink.program import Policy
from mmrs_runtime.faults import Fault

CARRIES_ON = Policy("VEHICLE_RESTARTED", "CONTINUE")
PATIENT = Policy("LINK_LOST", "RETURN", 60.0)


def grow_old(made) -> None:
    """Wait until what the vehicle tells of its age after a restart cannot have been late on its way."""
    until(lambda: made.simulated.autopilot.uptime > 1.5 * SPEEDUP)


def restart(made, *, armed: bool) -> None:
    grow_old(made)
    made.simulated.faults.restart(armed=armed)


def test_a_vehicle_whose_motors_go_on_is_landed_since_it_has_forgotten_what_it_did(in_the_air):
    made = in_the_air(CARRIES_ON, PATIENT)
    restart(made, armed=True)
    fault = made.caught()
    assert (fault.event, fault.instead) == ("VEHICLE_RESTARTED", "LAND")
    assert "on its way, with its motors on: nothing can be carried on" in str(fault)
    assert made.ending().end(fault) == 1
    assert not made.simulated.autopilot.armed
    assert made.events() == ["VEHICLE_RESTARTED"]


def test_a_vehicle_that_starts_anew_while_it_comes_home_is_landed(in_the_air):
    made = in_the_air(Policy("DEVICE_SILENT", "RETURN"), CARRIES_ON, PATIENT, out=True, cruise=1.0)
    grow_old(made)
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: made.simulated.autopilot.body.pace > 0.5)
    made.simulated.faults.restart(armed=True)
    assert code.result(30.0) == 1
    assert not made.simulated.autopilot.armed
    assert distance(made.crew.vehicle.state().place, HOME) > 5.0


def test_a_pilot_who_takes_a_vehicle_after_it_has_started_anew_has_it(in_the_air):
    made = in_the_air(Policy("VEHICLE_RESTARTED", "RETURN"), PATIENT, out=True, cruise=1.0)
    restart(made, armed=True)
    fault = made.caught()
    code = in_background(lambda: made.ending().end(fault))
    until(lambda: made.simulated.autopilot.body.pace > 0.5)
    made.simulated.faults.take_stick("stabilize")
    until(lambda: any("hands off" in line for line in made.said))
    made.crew.desk.abandon.set()
    assert code.result(20.0) == 1
    assert made.mode == "stabilize"


def test_a_vehicle_whose_motors_have_stopped_on_its_way_ends_the_program_in_words(in_the_air):
    made = in_the_air(CARRIES_ON, PATIENT)
    made.quiet(2.0)
    restart(made, armed=False)
    fault = made.caught()
    assert (fault.event, fault.instead) == ("VEHICLE_RESTARTED", "HOLD")
    assert "with its motors off: nothing can be carried on" in str(fault)
    assert made.ending().end(fault) == 1
    assert not made.simulated.autopilot.armed
    assert made.events() == ["VEHICLE_RESTARTED"]


@pytest.fixture
def on_the_ground(tmp_path):
    """Return a robot that is set up, and stands at its home."""
    with manned(tmp_path, robot_of(CARRIES_ON, PATIENT)) as made:
        made.crew.pilot._prepare()
        yield made


def test_a_vehicle_that_starts_anew_before_its_take_off_is_set_up_again_and_takes_off(on_the_ground):
    made = on_the_ground
    restart(made, armed=False)
    until(lambda: made.crew.watch.restarted)
    told = len(made.simulated.received)
    made.crew.pilot._take_off(10.0)
    assert made.simulated.autopilot.airborne
    assert "PARAM_SET" in [name for _, name in made.simulated.received[told:]]


def test_a_vehicle_that_starts_anew_as_it_is_to_take_off_begins_anew(on_the_ground):
    made = on_the_ground
    crew, take_off = made.crew, made.crew.vehicle.take_off
    tries = []

    def begun_and_restarted(height: float) -> None:
        tries.append(height)
        if len(tries) == 1:
            crew.vehicle._helm.enter("guided")
            made.simulated.faults.restart()
        take_off(height)

    grow_old(made)
    crew.vehicle.take_off = begun_and_restarted
    crew.pilot._take_off(10.0)
    assert made.simulated.autopilot.airborne
    assert len(tries) > 1


def test_a_rover_that_is_being_charged_may_start_anew(on_the_ground):
    made = on_the_ground
    made.crew.vehicle._helm.enter("guided")
    made.crew.watch.moving = False
    restart(made, armed=False)
    until(lambda: made.crew.watch.restarted)
    made.quiet(SPEEDUP)
    assert made.crew.watch.restarted


def test_people_are_told_before_that_carrying_on_counts_on_the_ground_only(on_the_ground):
    made = on_the_ground
    told = []
    made.crew.watch.say = told.append
    made.crew.watch.forewarn()
    assert told == [
        "carries on after VEHICLE_RESTARTED before it sets out only; on its way it does LAND then"
    ]
