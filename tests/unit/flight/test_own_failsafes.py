"""What a vehicle does by itself while its robot does something else: no pilot, and taken back."""

from __future__ import annotations

from functools import partial

import pytest
from flight_crew import NORTH, in_background
from patience import until

from mmrs_mavlink.places import distance
from mmrs_mavlink.program import Policy
from mmrs_runtime.faults import Fault

ON = "BATT_FS_LOW_ACT"


def set_parameter(made, name: str, value: float) -> None:
    with made.simulated.lock:
        made.simulated.autopilot.parameters[name] = value


def say_low(made) -> None:
    """Have the vehicle find its battery low by its own measure, at once, whatever is left in it."""
    with made.simulated.lock:
        made.simulated.autopilot.parameters |= {ON: 2.0, "BATT_LOW_TIMER": 0.0, "BATT_LOW_VOLT": 99.0}


def say_critical(made) -> None:
    """Have it find its battery critical."""
    with made.simulated.lock:
        found = {"BATT_FS_CRT_ACT": 2.0, "BATT_LOW_TIMER": 0.0, "BATT_CRT_VOLT": 99.0}
        made.simulated.autopilot.parameters |= found


def said(made, words: str) -> bool:
    return any(words in line for line in made.said)


def is_taken_back(made, mode: str) -> None:
    """Wait until the program has taken its vehicle back, and sees it in a mode again."""
    until(lambda: said(made, "takes its vehicle back"))
    until(lambda: made.crew.vehicle.state().mode == mode)


@pytest.fixture
def heard(in_the_air):
    """Return a function that gives a robot in the air that tells people what its watch says."""

    def fly(*policies, **more):
        made = in_the_air(*policies, **more)
        made.crew.watch.say = made.said.append
        return made

    return fly


def test_a_failsafe_during_the_response_to_the_same_event_is_taken_back(heard):
    made = heard(Policy("BATTERY_LOW", "RETURN"), out=True, cruise=1.0)
    made.simulated.faults.set_battery(0.5)
    code = in_background(lambda: made.ending().end(Fault("BATTERY_LOW", "less than 60% is left")))
    until(lambda: made.simulated.autopilot.body.pace > 0.5)
    say_low(made)
    is_taken_back(made, "guided")
    assert code.result(40.0) == 1
    assert not made.simulated.autopilot.armed
    assert said(made, "takes its vehicle back, RETURN goes on: BATTERY_LOW: Battery 1 is low")
    assert not said(made, "somebody else")
    assert made.decided == [("BATTERY_LOW", "RETURN")]


def test_a_movement_is_begun_again_where_what_the_vehicle_answered_is_borne(heard):
    made = heard(Policy("BATTERY_LOW", "CONTINUE"))
    crew = made.crew
    gone = in_background(
        lambda: crew.obedience.repeat(partial(crew.vehicle.go_to, NORTH, 1.0, None, through=False))
    )
    until(lambda: made.simulated.autopilot.body.pace > 0.5)
    say_low(made)
    gone.result(40.0)
    assert distance(crew.vehicle.state().place, NORTH) < 2.0
    assert ("BATTERY_LOW", "CONTINUE") in made.decided


def test_a_robot_that_stands_still_stays_in_the_mode_that_it_was_in(heard):
    made = heard(Policy("BATTERY_LOW", "CONTINUE"))
    made.crew.vehicle.hold()
    say_low(made)
    resting = in_background(lambda: made.crew.vehicle.rest(60.0))
    is_taken_back(made, "hold")
    resting.result(20.0)


def test_a_pilot_who_returns_after_the_vehicle_was_taken_back_has_it(heard):
    made = heard(Policy("BATTERY_LOW", "CONTINUE"))
    say_low(made)
    resting = in_background(lambda: made.crew.vehicle.rest(600.0))
    is_taken_back(made, "guided")
    made.simulated.faults.take_stick("return")
    with pytest.raises(Fault, match="somebody else has taken over"):
        resting.result(20.0)
    assert made.crew.watch.taken


def test_a_battery_that_does_not_last_for_the_way_back_is_landed_with(heard):
    made = heard(Policy("BATTERY_LOW", "RETURN"), out=True, cruise=0.2)
    made.crew.watch.check()
    made.simulated.faults.set_battery(0.06)
    until(lambda: (made.crew.vehicle.state().energy or 1.0) < 0.07)
    code = in_background(lambda: made.ending().end(Fault("BATTERY_LOW", "less than 10% is left")))
    until(lambda: made.simulated.autopilot.body.pace > 0.1)
    say_critical(made)
    assert code.result(40.0) == 1
    assert not made.simulated.autopilot.armed
    assert said(made, "of the energy is left, and RETURN takes")
    assert said(made, "response: LAND")
    assert made.simulated.autopilot.body.position[0] > 10.0


def test_an_altitude_hold_that_the_vehicle_names_is_its_own(heard):
    made = heard(Policy("POSITION_LOST", "RETURN", 1000.0))
    set_parameter(made, "FS_EKF_ACTION", 2.0)
    made.simulated.faults.lose_position()
    fault = made.caught()
    assert fault.event == "POSITION_LOST"
    assert made.mode == "alt_hold"
    assert made.ending().end(fault) == 1
    assert not made.simulated.autopilot.armed
    assert said(made, "response: LAND")


def test_an_altitude_hold_that_a_pilot_chose_is_not(heard):
    made = heard(Policy("POSITION_LOST", "LAND", 1000.0))
    set_parameter(made, "FS_EKF_ACTION", 0.0)
    made.simulated.faults.lose_position()
    made.simulated.faults.take_stick("alt_hold")
    assert made.caught().event == "TAKEN_OVER"


def test_a_robot_that_is_to_go_on_without_a_position_is_landed_where_the_vehicle_gives_up(heard):
    made = heard(Policy("POSITION_LOST", "CONTINUE"))
    made.simulated.faults.lose_position()
    fault = made.caught()
    assert (fault.event, fault.instead) == ("POSITION_LOST", "LAND")
    assert "without a position it cannot be taken back" in str(fault)
    assert made.ending().end(fault) == 1
    assert not made.simulated.autopilot.armed
