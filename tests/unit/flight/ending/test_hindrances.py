"""What a robot does when its vehicle cannot do, or does not, what it is told."""

from __future__ import annotations

import pytest
from flight_crew import HOME, in_background
from patience import until

from mmrs_mavlink.links.retries import Retries
from mmrs_mavlink.program import Policy
from mmrs_runtime.faults import Fault, Stopped
from mmrs_runtime.orders.orders import Order

SET_MODE = 176


@pytest.fixture
def halted(robot):
    """Return a function that gives a robot that stands still in the air, out of the mode it is steered in."""

    def fly(*policies, **more):
        made = robot(*policies, **more)
        made.crew.vehicle.hold()
        return made

    return fly


def lose_position_unanswered(made) -> None:
    """Have the vehicle lose its position, and do nothing about that."""
    with made.simulated.lock:
        made.simulated.autopilot.parameters["FS_EKF_ACTION"] = 0.0
    made.simulated.faults.lose_position()


def heed_no_modes(made) -> None:
    """Have the vehicle neither take nor answer any other mode, which it is then told only twice."""
    made.simulated.faults.silence(SET_MODE)
    made.crew.link.retries = Retries(tries=2)


def test_a_return_that_cannot_be_steered_ends_on_the_ground_where_it_is(halted):
    made = halted(Policy("DEVICE_SILENT", "RETURN"), Policy("POSITION_LOST", "CONTINUE"))
    lose_position_unanswered(made)
    assert made.ending().end(Fault("DEVICE_SILENT", "no answer")) == 1
    assert not made.simulated.autopilot.armed
    assert made.away(HOME) > 15.0
    tried = [line.partition(": ")[2].partition(":")[0] for line in made.said if "cannot carry out" in line]
    assert tried == ["cannot carry out RETURN", "cannot carry out HOLD"]
    assert made.said[-2].endswith("response: LAND")


@pytest.mark.thorough
def test_a_return_that_gets_nowhere_ends_in_a_hold_that_is_watched(robot):
    made = robot(Policy("DEVICE_SILENT", "RETURN"), Policy("BATTERY_LOW", "CONTINUE"), cruise=2.0)
    made.simulated.faults.change_wind(30.0, 180.0)
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: any("cannot carry out RETURN" in line and "HOLD" in line for line in made.said), 40.0)
    made.simulated.faults.change_wind(0.0, 0.0)
    until(lambda: "'alpha': holds; interrupt to end" in made.said)
    order = made.inbox.give(Order("return"))
    assert code.result(40.0) == 1
    assert order.confirmed, order.why
    assert made.away(HOME) < 1.5


def test_a_return_that_gets_nowhere_with_a_low_battery_is_a_landing(halted):
    made = halted(Policy("BATTERY_LOW", "RETURN"), Policy("POSITION_LOST", "CONTINUE"))
    lose_position_unanswered(made)
    assert made.ending().end(Fault("BATTERY_LOW", "too little is left")) == 1
    assert not made.simulated.autopilot.armed
    assert not any("cannot carry out HOLD" in line for line in made.said)


def test_a_vehicle_that_obeys_nothing_is_stayed_with_where_it_would_not_come_down_by_itself(halted):
    made = halted(Policy("DEVICE_SILENT", "RETURN"), Policy("LINK_LOST", "CONTINUE"))
    heed_no_modes(made)
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: any("interrupt to end" in line for line in made.said), 60.0)
    made.simulated.faults.silence()
    order = made.inbox.give(Order("land"))
    assert code.result(20.0) == 1
    assert order.confirmed, order.why
    assert not made.simulated.autopilot.armed


def test_a_vehicle_that_obeys_nothing_is_left_to_what_it_does_about_a_lost_link(halted):
    made = halted(Policy("DEVICE_SILENT", "RETURN"), Policy("LINK_LOST", "LAND"))
    heed_no_modes(made)
    assert made.ending().end(Fault("DEVICE_SILENT", "no answer")) == 5
    assert made.said[-1].endswith("heartbeats end now: the vehicle does what it does about a lost link")


def test_a_stop_that_is_not_obeyed_is_told_by_the_exit_code(halted):
    made = halted(Policy("LINK_LOST", "LAND"), on_stop="land")
    heed_no_modes(made)
    assert made.ending().end(Stopped()) == 5
