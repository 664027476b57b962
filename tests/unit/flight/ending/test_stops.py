"""What a robot does when somebody stops its program."""

from __future__ import annotations

import pytest
from flight_crew import HOME, in_background
from patience import until

from mmrs_mavlink.program import Policy
from mmrs_runtime.faults import Fault, Stopped
from mmrs_runtime.orders.orders import Order


@pytest.mark.parametrize(("on_stop", "down"), [("hold", False), ("land", True), ("return", True)])
def test_a_stop_ends_as_the_robot_was_started(robot, on_stop, down):
    made = robot(on_stop=on_stop)
    assert made.ending().end(Stopped()) == 130
    assert made.simulated.autopilot.armed is not down
    assert made.said[-1] == "'alpha': stopped"
    assert made.events() == ["STOPPED"]
    if not down:
        assert made.mode == "brake"
        assert made.simulated.autopilot.parameters["FS_GCS_ENABLE"] == 7.0


def test_a_stop_goes_before_what_the_vehicle_does_by_itself(robot):
    made = robot(Policy("BATTERY_LOW", "CONTINUE"), on_stop="return")
    made.land_for_the_battery()
    made.stop.set()
    fault = made.caught()
    assert fault.event == "STOPPED"
    assert made.ending().end(fault) == 130
    assert made.away(HOME) < 1.5


def say_nothing_of_lost_links(made) -> None:
    """Have the vehicle give no answer when it is told what to do about a lost link."""
    with made.simulated.lock:
        del made.simulated.autopilot.parameters["FS_GCS_ENABLE"]


def test_an_order_to_a_vehicle_that_is_told_to_stay_after_a_stop_is_obeyed(robot):
    made = robot()
    say_nothing_of_lost_links(made)
    code = in_background(lambda: made.ending().end(Stopped()))
    until(lambda: "PARAM_SET" in [name for _, name in made.simulated.received])
    order = made.inbox.give(Order("land"))
    assert code.result(20.0) == 130
    assert order.confirmed, order.why
    assert not made.simulated.autopilot.armed


def test_a_battery_that_gets_low_while_a_stopped_vehicle_is_told_to_stay_is_answered(robot):
    made = robot(Policy("BATTERY_LOW", "LAND"))
    say_nothing_of_lost_links(made)
    code = in_background(lambda: made.ending().end(Stopped()))
    until(lambda: "PARAM_SET" in [name for _, name in made.simulated.received])
    made.simulated.faults.set_battery(0.05)
    assert code.result(20.0) == 130
    assert not made.simulated.autopilot.armed


def test_a_stopped_vehicle_that_may_not_stay_is_told_of(robot):
    made = robot()
    say_nothing_of_lost_links(made)
    assert made.ending().end(Stopped()) == 130
    assert any("it may not stay where it is when this program has ended" in line for line in made.said)


@pytest.mark.parametrize("on_stop", ["land", pytest.param("return", marks=pytest.mark.thorough)])
def test_a_stop_stops_a_robot_that_responds_to_something(robot, on_stop):
    made = robot(Policy("DEVICE_SILENT", "EMERGENCY_AREA"), on_stop=on_stop, cruise=1.0)
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: made.simulated.autopilot.body.pace > 0.5)
    made.stop.set()
    assert code.result(40.0) == 1
    assert not made.simulated.autopilot.armed
    assert (made.away(HOME) < 1.5) is (on_stop == "return")


def test_a_stop_stops_a_robot_that_holds_as_it_was_started(robot):
    made = robot(Policy("DEVICE_SILENT", "HOLD"), on_stop="land")
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: "'alpha': holds; interrupt to end" in made.said)
    made.stop.set()
    assert code.result(20.0) == 1
    assert not made.simulated.autopilot.armed
