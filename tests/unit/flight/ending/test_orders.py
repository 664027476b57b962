"""Orders that end a program, and vehicles that nobody may order."""

from __future__ import annotations

from dataclasses import replace

import pytest
from flight_crew import HOME, in_background
from patience import until
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.orders.obedience import Ordered
from mmrs_mavlink.program import Geographic, Policy
from mmrs_runtime.faults import Strange
from mmrs_runtime.orders.orders import Order, Receipt

FAR = Geographic(42.3710, 13.35, 0.0)
"""111 metres north of home."""


def ordered(made, name: str) -> tuple[Ordered, Receipt]:
    receipt = made.inbox.give(Order(name))
    assert made.inbox.take() is receipt
    return Ordered(receipt), receipt


def test_an_order_to_return_is_confirmed_as_soon_as_the_vehicle_is_bound_for_home(robot):
    made = robot()
    fault, receipt = ordered(made, "return")
    code = in_background(lambda: made.ending().end(fault))
    until(lambda: receipt.confirmed is not None)
    assert receipt.confirmed
    assert made.simulated.autopilot.body.target == pytest.approx((0.0, 0.0, 10.0), abs=1.0)
    assert not code.done()
    assert code.result(20.0) == 130
    assert made.events() == ["ORDERED"]


def test_another_order_on_the_way_takes_the_place_of_the_first(robot):
    made = robot()
    fault, receipt = ordered(made, "return")
    code = in_background(lambda: made.ending().end(fault))
    until(lambda: receipt.confirmed)
    later = made.inbox.give(Order("land"))
    assert code.result(20.0) == 130
    assert later.confirmed
    assert made.away(HOME) > 5.0


class Unseen:
    """Shows nothing, as a vehicle that tells no target."""

    def in_mode(self, mode):
        return False

    def bound_for(self, place, speed):
        return False


def test_an_order_that_another_fault_overtakes_before_it_is_seen_is_not_confirmed(robot):
    made = robot(Policy("POSITION_LOST", "LAND"), cruise=1.0)
    fault, receipt = ordered(made, "return")
    made.crew.vehicle.evidence = lambda: Unseen()
    code = in_background(lambda: made.ending().end(fault))
    until(lambda: made.said)
    made.simulated.faults.lose_position()
    assert code.result(20.0) == 130
    assert receipt.confirmed is False
    assert receipt.why


def test_a_return_from_where_it_has_landed_is_refused(robot):
    made = robot()
    made.crew.vehicle.land()
    fault, receipt = ordered(made, "return")
    made.crew.vehicle.state = lambda state=made.crew.vehicle.state: replace(state(), place=FAR)
    assert made.ending().end(fault) == 130
    assert receipt.confirmed is False
    assert receipt.why.endswith("m from its home")


@pytest.mark.parametrize("begun", [False, True])
def test_an_order_while_nobody_knows_whose_the_vehicle_is_tells_it_nothing(robot, begun):
    made = robot()
    if begun:
        made.crew.pilot.journal.write("begin")
    made.crew.obedience.begin(None)
    fault, receipt = ordered(made, "land")
    assert made.ending().end(fault) == 130
    assert receipt.confirmed is not begun
    assert made.simulated.autopilot.armed
    assert made.mode == "guided"


@pytest.mark.parametrize("begun", [False, True])
def test_a_vehicle_that_is_not_the_robots_is_told_nothing_and_a_log_that_was_begun_is_left(robot, begun):
    made = robot()
    if begun:
        made.crew.pilot.journal.write("begin")
    received = made.simulated.received
    made.crew.link.send(mavlink.MAVLink_ping_message(0, 0, 0, 0))
    until(lambda: received[-1][1] == "PING")
    heard = len(received)
    ending = made.ending()
    assert ending.refuse(Strange("somebody else has it")) == 1
    assert ending.suspended is begun
    assert made.events() == ([] if begun else ["REFUSED"])
    assert received[heard:] == []
    assert made.simulated.autopilot.armed
