"""What a robot does as its policies say when its program ends early."""

from __future__ import annotations

from flight_crew import HOME, NORTH, in_background
from patience import until

from mmrs_mavlink.program import Policy
from mmrs_runtime.faults import Fault


def test_a_robot_returns_by_the_way_it_came_and_says_so_in_its_log(robot):
    made = robot(Policy("DEVICE_SILENT", "RETURN"))
    assert made.ending().end(Fault("DEVICE_SILENT", "no answer")) == 1
    assert not made.simulated.autopilot.armed
    assert made.away(HOME) < 1.5
    assert made.events() == ["DEVICE_SILENT"]
    assert made.left == 1
    assert made.said[0] == "'alpha': DEVICE_SILENT: no answer; response: RETURN"


def test_a_robot_that_lands_comes_down_where_it_is(robot):
    made = robot(Policy("PEER_LOST", "LAND"))
    assert made.ending().end(Fault("PEER_LOST", "nobody there")) == 1
    assert not made.simulated.autopilot.armed
    assert made.away(NORTH) < 12.0
    assert made.away(HOME) > 15.0


def test_what_brings_a_robot_down_for_its_battery_is_no_fault_and_nobody_is_told_that_it_ended(robot):
    made = robot()
    ending = made.ending()
    assert ending.end(Fault("BATTERY_LOW", "too little is left")) == 1
    assert (ending.suspended, ending.down) == (True, True)
    assert made.events() == []
    assert made.left == 0


def test_a_battery_that_is_answered_in_the_air_is_a_fault(robot):
    made = robot(Policy("BATTERY_LOW", "HOLD"))
    ending = made.ending()
    code = in_background(lambda: ending.end(Fault("BATTERY_LOW", "too little is left")))
    until(lambda: made.mode == "brake")
    made.stop.set()
    assert code.result(20.0) == 1
    assert not ending.suspended
    assert made.events() == ["BATTERY_LOW"]


def test_a_fault_on_the_way_home_for_the_battery_ends_the_program_after_all(robot):
    made = robot(Policy("POSITION_LOST", "LAND"), cruise=1.0)
    ending = made.ending()
    code = in_background(lambda: ending.end(Fault("BATTERY_LOW", "too little is left")))
    until(lambda: made.said)
    made.simulated.faults.lose_position()
    assert code.result(20.0) == 1
    assert not ending.suspended
    assert made.events() == ["POSITION_LOST"]
    assert made.left == 1


def test_a_robot_that_holds_is_watched_until_somebody_stops_it(robot):
    made = robot(Policy("DEVICE_SILENT", "HOLD"))
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: "'alpha': holds; interrupt to end" in made.said)
    assert made.mode == "brake"
    assert not code.done()
    made.stop.set()
    assert code.result(20.0) == 1
    assert made.away(NORTH) < 3.0


def test_a_low_battery_brings_down_who_holds(robot):
    made = robot(Policy("DEVICE_SILENT", "HOLD"), Policy("BATTERY_LOW", "LAND"))
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: "'alpha': holds; interrupt to end" in made.said)
    made.simulated.faults.set_battery(0.05)
    assert code.result(20.0) == 1
    assert not made.simulated.autopilot.armed


def test_a_landing_that_the_vehicle_began_itself_does_not_keep_it_from_its_way_home(robot):
    made = robot(Policy("PEER_LOST", "RETURN"))
    made.land_for_the_battery()
    assert made.ending().end(Fault("PEER_LOST", "nobody there")) == 1
    assert made.away(HOME) < 1.5
