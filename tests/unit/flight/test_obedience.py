"""Orders, obeyed by a robot in the middle of what it waits for, with a simulated vehicle."""

from __future__ import annotations

import threading
import time

import pytest
from flight_crew import NORTH, in_background, manned
from patience import until

from mmrs_mavlink.orders.obedience import Obedience, Ordered
from mmrs_mavlink.places import distance
from mmrs_mavlink.services.uploads import Uploads
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import Fault, Stopped
from mmrs_runtime.orders.orders import Inbox, Order

ARM = (400, 1.0)
"""MAV_CMD_COMPONENT_ARM_DISARM, and its first parameter."""


@pytest.fixture
def robot(in_the_air):
    """Return a robot ten metres above its home."""
    return in_the_air()


def go_north(made):
    """Have the robot fly north in a thread of its own, as its program does."""
    vehicle = made.crew.vehicle
    return in_background(lambda: made.crew.obedience.repeat(lambda: vehicle.go_to(NORTH, 5.0, None, False)))


def under_way(made):
    return lambda: made.simulated.autopilot.body.position[0] > 5.0


def test_a_held_robot_halts_and_then_comes_to_where_it_was_going(robot):
    done = go_north(robot)
    until(under_way(robot))
    held = robot.inbox.give(Order("hold"))
    until(lambda: held.confirmed)
    assert robot.mode == "brake"
    until(lambda: robot.said[-1:] == ["is held; waits for an order"])
    place = robot.simulated.autopilot.body.position
    again = robot.inbox.give(Order("hold"))
    until(lambda: again.confirmed)
    assert again.why == "it was held already"
    assert robot.simulated.autopilot.body.position == pytest.approx(place, abs=0.3)
    resumed = robot.inbox.give(Order("resume"))
    done.result(20.0)
    assert resumed.confirmed
    assert distance(robot.crew.vehicle.state().place, NORTH) < 1.0


def test_a_hold_after_a_stop_lasts_until_the_next_order(robot):
    robot.crew.desk.stop.set()
    robot.crew.watch.relax({"STOPPED"}, "LAND")
    done = in_background(lambda: robot.crew.obedience.repeat(robot.crew.vehicle.land))
    held = robot.inbox.give(Order("hold"))
    until(lambda: held.confirmed)
    until(lambda: robot.said[-1:] == ["is held; waits for an order"])
    assert not done.done()
    robot.inbox.give(Order("resume"))
    done.result(20.0)
    assert not robot.simulated.autopilot.armed


def test_a_landing_that_was_held_is_begun_again(robot):
    done = in_background(lambda: robot.crew.obedience.repeat(robot.crew.vehicle.land))
    until(lambda: robot.simulated.autopilot.body.position[2] < 9.0)
    held = robot.inbox.give(Order("hold"))
    until(lambda: held.confirmed)
    assert robot.simulated.autopilot.airborne
    robot.inbox.give(Order("resume"))
    done.result(20.0)
    assert not robot.simulated.autopilot.armed


def test_a_hold_before_the_vehicle_is_known_is_confirmed_by_motors_that_are_off(robot):
    seen = []
    robot.crew.obedience.begin(None, lambda: bool(seen))
    held = robot.inbox.give(Order("hold"))
    for _ in range(2):
        robot.crew.obedience.check()
    assert held.confirmed is None
    seen.append("motors off")
    robot.crew.obedience.check()
    assert (held.confirmed, held.why) == (True, "its motors are off, and stay so")
    robot.crew.obedience.begin(robot.crew.vehicle)
    done = in_background(robot.crew.obedience.check)
    until(lambda: robot.said[-1:] == ["is held; waits for an order"])
    robot.inbox.give(Order("resume"))
    done.result(20.0)


def test_a_hold_while_the_motors_start_is_confirmed_when_they_are_seen_to_be_off(tmp_path):
    with manned(tmp_path) as made:
        crew, seen = made.crew, []

        def arms(message, outgoing):
            if outgoing and message.get_type() == "COMMAND_LONG" and (message.command, message.param1) == ARM:
                seen or seen.append(made.inbox.give(Order("hold")))

        crew.vehicle.prepare(Uploads())
        crew.link.observe(arms)
        done = in_background(lambda: crew.obedience.repeat(lambda: crew.vehicle.take_off(10.0)))
        until(lambda: seen and seen[0].confirmed is not None)
        assert seen[0].confirmed
        until(lambda: any(number == ARM[0] for _, number, _ in made.simulated.autopilot.history))
        time.sleep(0.2)
        assert not made.simulated.autopilot.armed
        resumed = made.inbox.give(Order("resume"))
        done.result(20.0)
        assert resumed.confirmed
        assert made.simulated.autopilot.body.position[2] == pytest.approx(10.0, abs=0.6)


def test_a_hold_of_a_robot_that_is_just_leaving_the_ground_keeps_it_in_the_air(robot):
    told = robot.crew.vehicle.telemetry
    told.grounded = lambda: True
    held = robot.inbox.give(Order("hold"))
    done = in_background(lambda: robot.crew.vehicle.rest(1.0))
    until(lambda: held.confirmed is not None)
    assert (held.confirmed, robot.mode) == (True, "brake")
    assert robot.simulated.autopilot.armed
    robot.inbox.give(Order("resume"))
    done.result(20.0)


@pytest.mark.parametrize("name", ["return", "land"])
def test_an_order_that_ends_the_program_ends_a_hold_too(robot, name):
    done = go_north(robot)
    until(under_way(robot))
    held = robot.inbox.give(Order("hold"))
    until(lambda: held.confirmed)
    ending = robot.inbox.give(Order(name))
    with pytest.raises(Ordered) as ordered:
        done.result(20.0)
    assert (ordered.value.event, ordered.value.response) == ("ORDERED", name.upper())
    assert ending.confirmed is None, "only who carries it out knows that it is obeyed"


def test_a_stop_ends_a_hold(robot):
    done = go_north(robot)
    until(under_way(robot))
    held = robot.inbox.give(Order("hold"))
    until(lambda: held.confirmed)
    robot.stop.set()
    with pytest.raises(Stopped):
        done.result(20.0)


def test_a_robot_that_is_not_held_has_nothing_to_resume(robot):
    resumed = robot.inbox.give(Order("resume"))
    robot.crew.vehicle.rest(1.0)
    assert (resumed.confirmed, resumed.why) == (False, "it is not held")


def test_a_hold_in_a_wait_needs_no_movement_again(robot):
    rested = in_background(lambda: robot.crew.vehicle.rest(10.0))
    held = robot.inbox.give(Order("hold"))
    until(lambda: held.confirmed)
    resumed = robot.inbox.give(Order("resume"))
    rested.result(20.0)
    assert resumed.confirmed
    assert robot.mode == "guided"


def test_a_robot_whose_program_has_ended_holds_and_cannot_go_on(robot):
    robot.crew.obedience.ended = True
    held = robot.inbox.give(Order("hold"))
    resumed = robot.inbox.give(Order("resume"))
    robot.crew.vehicle.rest(5.0)
    assert held.confirmed
    assert robot.mode == "brake"
    assert (resumed.confirmed, resumed.why) == (False, "its program has ended")


def test_nothing_is_obeyed_while_somebody_else_has_the_vehicle(robot):
    robot.crew.obedience.hands_off = True
    held = robot.inbox.give(Order("hold"))
    robot.crew.vehicle.rest(5.0)
    assert held.confirmed is None
    robot.crew.obedience.refuse_all("a pilot has it")
    assert (held.confirmed, held.why) == (False, "a pilot has it")


def test_what_was_expected_and_never_seen_is_refused_with_the_reason(robot):
    receipt = robot.inbox.give(Order("land"))
    assert robot.inbox.take() is receipt
    robot.crew.obedience.expect(receipt, lambda: False)
    robot.crew.obedience.check()
    assert receipt.confirmed is None
    robot.crew.obedience.overtake(Fault("LINK_LOST", "the link is lost"))
    assert (receipt.confirmed, receipt.why) == (False, "the link is lost")


def test_an_order_is_refused_when_another_one_comes_before_it_was_seen_to_be_obeyed(alone):
    obedience, inbox = alone
    given = [inbox.give(Order(name)) for name in ("return", "land")]
    for _ in given:
        with pytest.raises(Ordered):
            obedience.check()
    assert (given[0].confirmed, given[0].why) == (False, "something else was ordered since")
    assert given[1].confirmed is None


def test_an_order_that_nobody_has_carried_out_is_refused_at_the_end(alone):
    obedience, inbox = alone
    given = inbox.give(Order("land"))
    with pytest.raises(Ordered):
        obedience.check()
    obedience.close("its program has ended")
    assert (given.confirmed, given.why) == (False, "its program has ended")


@pytest.fixture
def alone():
    """Return the obedience of a robot without a vehicle, and its inbox."""
    inbox = Inbox("alpha")
    return Obedience(inbox, Clock(), threading.Event(), lambda line: None), inbox


def test_a_hold_before_there_is_a_vehicle_is_obeyed_and_confirmed_once_there_is_one(robot):
    obedience, vehicle = robot.crew.obedience, robot.crew.vehicle
    obedience.begin(None)
    held, again = robot.inbox.give(Order("hold")), robot.inbox.give(Order("hold"))
    obedience.check()
    obedience.check()
    assert (held.confirmed, again.confirmed) == (None, None)
    obedience.begin(vehicle)
    waits = in_background(lambda: vehicle.rest(1.0))
    until(lambda: held.confirmed and again.confirmed)
    assert robot.mode == "brake"
    assert not waits.done()
    robot.inbox.give(Order("resume"))
    waits.result(20.0)


def test_a_hold_before_there_is_a_vehicle_can_be_taken_back(alone):
    obedience, inbox = alone
    held, resumed = inbox.give(Order("hold")), inbox.give(Order("resume"))
    obedience.check()
    obedience.check()
    assert (held.confirmed, resumed.confirmed) == (False, True)


def test_a_hold_before_there_is_a_vehicle_is_refused_where_none_comes(alone):
    obedience, inbox = alone
    held = inbox.give(Order("hold"))
    obedience.check()
    obedience.close("its program has ended")
    assert (held.confirmed, held.why) == (False, "its program has ended")


def test_a_robot_waits_for_its_battery_until_it_is_told_to_go_on(alone):
    obedience, inbox = alone
    assert obedience.awaits_resume(lambda order: "") is None
    early, landed = inbox.give(Order("resume")), inbox.give(Order("land"))
    assert obedience.awaits_resume(lambda order: "the battery is still at 10%") is None
    assert (early.confirmed, early.why) == (False, "the battery is still at 10%")
    assert obedience.awaits_resume(lambda order: "") is None
    assert (landed.confirmed, landed.why) == (True, "it stands on the ground")
    late = inbox.give(Order("resume"))
    assert obedience.awaits_resume(lambda order: "") is late
    assert late.confirmed is None, "only the vehicle shows that it goes on"


def test_a_robot_that_waits_for_its_battery_can_be_stopped(alone):
    obedience, inbox = alone
    inbox.give(Order("stop"))
    with pytest.raises(Ordered) as ordered:
        obedience.awaits_resume(lambda order: "")
    assert ordered.value.event == "STOPPED"
