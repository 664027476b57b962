"""What a robot does when its link is lost, and once it is heard again."""

from __future__ import annotations

import pytest
from flight_crew import HOME, NORTH, in_background
from patience import until

from mmrs_mavlink.program import Policy
from mmrs_runtime.faults import Fault
from mmrs_runtime.orders.orders import Order

MODES = {"land": "land", "return": "return", "brake": "hold"}
"""What the runtime calls modes of the vehicle."""


def test_a_robot_with_a_lost_link_is_left_to_what_its_vehicle_does(robot):
    made = robot()
    made.simulated.mute()
    assert made.ending().end(Fault("LINK_LOST", "silent")) == 5
    assert made.events() == ["LINK_LOST"]
    assert made.simulated.autopilot.armed


def test_a_link_that_is_lost_on_the_way_back_is_told_with_what_was_not_done(robot):
    made = robot(Policy("DEVICE_SILENT", "RETURN"), Policy("LINK_LOST", "RETURN", 5.0))
    made.simulated.mute()
    assert made.ending().end(Fault("DEVICE_SILENT", "no answer")) == 5
    assert any("cannot carry out RETURN: the vehicle has been silent" in line for line in made.said)


@pytest.mark.parametrize("name", ["return", pytest.param("land", marks=pytest.mark.thorough), "hold"])
def test_a_robot_whose_link_comes_back_obeys_again(robot, name):
    made = robot(Policy("LINK_LOST", "RETURN", 5.0), cruise=1.0)
    made.simulated.mute()
    code = in_background(lambda: made.ending().end(made.caught()))
    until(lambda: made.events() == ["LINK_LOST"])
    early = made.inbox.give(Order("land"))
    until(lambda: early.confirmed is not None)
    assert (early.confirmed, early.why) == (False, "its link is lost")
    made.simulated.unmute()
    until(lambda: any("is heard again" in line for line in made.said))
    later = made.inbox.give(Order(name))
    until(lambda: later.confirmed is not None)
    assert later.confirmed, later.why
    if name == "hold":
        assert made.mode == "brake"
        assert not code.done()
        made.inbox.give(Order("land"))
    assert code.result(30.0) == 5
    assert not made.simulated.autopilot.armed
    assert (made.away(HOME) < 1.5) is (name == "return")


def test_a_robot_whose_link_comes_back_is_listened_to_until_its_motors_are_off(robot):
    made = robot(Policy("LINK_LOST", "RETURN", 5.0))
    made.crew.vehicle.answer_lost_link("RETURN", 5.0)
    made.simulated.faults.cut_link()
    code = in_background(lambda: made.ending().end(made.caught()))
    until(lambda: made.events() == ["LINK_LOST"] and made.mode not in ("guided", "brake"))
    made.simulated.faults.mend_link()
    until(lambda: any("is heard again, in mode" in line for line in made.said))
    assert code.result(30.0) == 5
    assert not made.simulated.autopilot.armed
    assert made.said[-1] == "'alpha': ended early"


def test_a_stop_from_before_a_link_was_lost_does_not_end_the_listening(robot):
    made = robot(Policy("LINK_LOST", "RETURN", 5.0), on_stop="return", cruise=1.0)
    made.stop.set()
    code = in_background(lambda: made.ending().end(made.caught()))
    until(lambda: made.simulated.autopilot.body.pace > 0.5)
    made.simulated.mute()
    until(lambda: any("cannot carry out RETURN" in line for line in made.said))
    made.simulated.unmute()
    until(lambda: any("is heard again" in line for line in made.said))
    later = made.inbox.give(Order("land"))
    assert code.result(30.0) == 5
    assert later.confirmed, later.why
    assert not made.simulated.autopilot.armed


def test_a_vehicle_that_hears_us_all_the_time_misses_us_once_its_link_is_lost(robot):
    made = robot(Policy("LINK_LOST", "RETURN", 5.0))
    made.crew.pilot.waits.tell_vehicle()
    made.ears.deaf = True
    ending = made.ending()
    ending._lose = lambda: True  # others work, so that it is listened to for as long as this takes
    code = in_background(lambda: ending.end(made.caught()))
    until(lambda: made.mode in ("return", "smart_return") and made.events() == ["LINK_LOST"])
    made.ears.deaf = False
    until(lambda: any("is heard again" in line for line in made.said))
    assert code.result(30.0) == 5
    assert not made.simulated.autopilot.armed
    assert made.away(HOME) < 1.5


@pytest.mark.parametrize(("response", "away_from_home"), [("RETURN", 0.0), ("LAND", 22.0)])
def test_what_a_vehicle_has_not_done_about_its_link_is_done_once_it_is_heard_again(
    robot, response, away_from_home
):
    made = robot(Policy("LINK_LOST", response, 5.0))
    made.ears.deaf = True
    code = in_background(lambda: made.ending().end(made.caught()))
    until(lambda: made.events() == ["LINK_LOST"])
    made.ears.deaf = False
    assert code.result(30.0) == 5
    assert not made.simulated.autopilot.armed
    assert made.away(HOME) == pytest.approx(away_from_home, abs=1.5)
    assert made.events() == ["LINK_LOST"]


def test_a_stop_once_a_lost_vehicle_is_heard_again_stops_it(robot):
    made = robot(Policy("LINK_LOST", "HOLD", 5.0), on_stop="land")
    made.crew.pilot.waits.tell_vehicle()
    made.simulated.mute()
    code = in_background(lambda: made.ending().end(made.caught()))
    until(lambda: made.mode == "brake" and made.events() == ["LINK_LOST"])
    made.simulated.unmute()
    until(lambda: any("is heard again" in line for line in made.said))
    made.stop.set()
    assert code.result(30.0) == 5
    assert not made.simulated.autopilot.armed
    assert made.away(NORTH) < 12.0


def test_a_stop_ends_the_listening_for_a_vehicle_that_is_not_heard(robot):
    made = robot(Policy("LINK_LOST", "RETURN", 5.0))
    made.simulated.mute()
    ending = made.ending()
    ending._lose = lambda: True
    code = in_background(lambda: ending.end(made.caught()))
    until(lambda: made.crew.obedience.hands_off)
    made.stop.set()
    assert code.result(20.0) == 5
    assert made.simulated.autopilot.armed


@pytest.mark.parametrize(
    ("told", "mode"), [("LAND", "land"), ("EMERGENCY_AREA", "return"), ("HOLD", "brake")]
)
def test_what_a_vehicle_does_about_a_lost_link_as_it_was_told_is_no_pilots(robot, told, mode):
    made = robot(Policy("LINK_LOST", told, 5.0))
    made.crew.pilot.waits.tell_vehicle()
    made.simulated.faults.cut_link()
    code = in_background(lambda: made.ending().end(made.caught()))
    until(lambda: made.events() == ["LINK_LOST"] and made.mode == mode)
    made.simulated.faults.mend_link()
    until(lambda: any(f"is heard again, in mode {MODES[mode]}" in line for line in made.said))
    later = made.inbox.give(Order("land"))
    assert code.result(30.0) == 5
    assert later.confirmed, later.why
    assert not any("hands off" in line for line in made.said)


def test_a_vehicle_that_answers_a_link_before_the_program_notices_is_let_come_home_by_itself(robot):
    made = robot(Policy("LINK_LOST", "RETURN", 100.0))
    made.crew.vehicle.answer_lost_link("RETURN", 5.0)
    made.simulated.faults.cut_link()
    until(lambda: made.mode == "smart_return")
    made.simulated.faults.mend_link()
    fault = made.caught()
    assert fault.event == "LINK_LOST"
    told = len(made.simulated.received)
    assert made.ending().end(fault) == 5
    assert made.away(HOME) < 1.5
    names = {name for _, name in made.simulated.received[told:]}
    assert not names & {"COMMAND_LONG", "SET_POSITION_TARGET_GLOBAL_INT"}
