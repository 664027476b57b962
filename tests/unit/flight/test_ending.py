"""What a robot does when its program ends early, with a simulated vehicle that has to do it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import pytest
from flight_crew import HOME, NORTH, in_background
from patience import until

from mmrs_core.flight.faults import Fault, Stopped, Strange
from mmrs_core.flight.orders.obedience import Ordered
from mmrs_core.flight.orders.orders import Order, Receipt
from mmrs_core.flight.places import distance
from mmrs_core.flight.program import Geographic, Policy

FAR = Geographic(42.3710, 13.35, 0.0)
"""111 metres north of home."""

MODES = {"land": "land", "return": "return", "brake": "hold"}
"""What the runtime calls modes of the vehicle."""


@pytest.fixture
def robot(in_the_air):
    """Return a function that gives a robot with policies, 22 metres north of its home and ten above it."""
    return partial(in_the_air, out=True)


def away(made, place) -> float:
    """Return how far the vehicle is from a place, metres."""
    return distance(made.crew.vehicle.state().place, place)


def ordered(made, name: str) -> tuple[Ordered, Receipt]:
    receipt = made.inbox.give(Order(name))
    assert made.inbox.take() is receipt
    return Ordered(receipt), receipt


def test_a_robot_returns_by_the_way_it_came_and_says_so_in_its_log(robot):
    made = robot(Policy("DEVICE_SILENT", "RETURN"))
    assert made.ending().end(Fault("DEVICE_SILENT", "no answer")) == 1
    assert not made.simulated.autopilot.armed
    assert away(made, HOME) < 1.5
    assert made.events() == ["DEVICE_SILENT"]
    assert made.left == 1
    assert made.said[0] == "'alpha': DEVICE_SILENT: no answer; response: RETURN"


def test_a_robot_that_lands_comes_down_where_it_is(robot):
    made = robot(Policy("PEER_LOST", "LAND"))
    assert made.ending().end(Fault("PEER_LOST", "nobody there")) == 1
    assert not made.simulated.autopilot.armed
    assert away(made, NORTH) < 12.0
    assert away(made, HOME) > 15.0


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
    assert away(made, NORTH) < 3.0


def test_a_low_battery_brings_down_who_holds(robot):
    made = robot(Policy("DEVICE_SILENT", "HOLD"), Policy("BATTERY_LOW", "LAND"))
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: "'alpha': holds; interrupt to end" in made.said)
    made.simulated.faults.set_battery(0.05)
    assert code.result(20.0) == 1
    assert not made.simulated.autopilot.armed


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
    assert away(made, HOME) > 5.0


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


@pytest.mark.parametrize("name", ["return", "land", "hold"])
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
    assert (away(made, HOME) < 1.5) is (name == "return")


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
    assert away(made, HOME) < 1.5


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
    assert away(made, HOME) == pytest.approx(away_from_home, abs=1.5)
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
    assert away(made, NORTH) < 12.0


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
    ("told", "mode"),
    [("RETURN", "loiter"), ("RETURN", "alt_hold"), ("RETURN", "brake"), ("LAND", "return")],
)
def test_a_pilot_who_takes_a_vehicle_while_nobody_hears_it_is_left_alone(robot, told, mode):
    made = robot(Policy("LINK_LOST", told, 5.0))
    made.crew.pilot.waits.tell_vehicle()
    made.simulated.mute()
    code = in_background(lambda: made.ending().end(made.caught()))
    until(lambda: made.events() == ["LINK_LOST"] and made.mode != "guided")
    made.simulated.faults.take_stick(mode)
    made.simulated.unmute()
    until(lambda: any("hands off until its motors are off" in line for line in made.said))
    order = made.inbox.give(Order("land"))
    until(lambda: order.confirmed is not None)
    assert (order.confirmed, order.why) == (False, "somebody else has the vehicle")
    made.crew.desk.abandon.set()
    assert code.result(20.0) != 0
    assert made.mode == mode


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


class Unseen:
    """Shows nothing, as a vehicle that tells no target."""

    def in_mode(self, mode):
        return False

    def bound_for(self, place, speed):
        return False


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


def test_nothing_is_sent_to_a_vehicle_that_a_pilot_has_until_its_motors_are_off(robot):
    made = robot()
    made.simulated.faults.take_stick("loiter")
    fault = made.caught()
    heard = len(made.simulated.received)
    code = in_background(lambda: made.ending().end(fault))
    until(lambda: any("hands off until its motors are off" in line for line in made.said))
    order = made.inbox.give(Order("land"))
    until(lambda: order.confirmed is not None)
    assert (order.confirmed, order.why) == (False, "somebody else has the vehicle")
    assert not code.done()
    with made.simulated.lock:
        made.simulated.autopilot.disarm()
    assert code.result(20.0) == 1
    assert made.simulated.received[heard:] == []
    assert made.events() == ["TAKEN_OVER"]


def test_a_pilot_who_takes_over_on_the_way_back_is_left_alone(robot):
    made = robot(Policy("DEVICE_SILENT", "RETURN"), cruise=1.0)
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: made.simulated.autopilot.body.pace > 0.5)
    made.simulated.faults.take_stick("loiter")
    until(lambda: any("hands off" in line for line in made.said))
    made.stop.set()
    until(lambda: any("interrupted again, they end" in line for line in made.said))
    assert not code.done()
    made.crew.desk.abandon.set()
    assert code.result(20.0) == 1
    assert made.mode == "loiter"


def test_a_vehicle_that_a_pilot_has_hears_the_program_also_while_nobody_hears_it(robot):
    made = robot(Policy("LINK_LOST", "RETURN", 5.0))
    made.simulated.faults.take_stick("loiter")
    until(lambda: made.mode == "loiter")
    code = in_background(lambda: made.ending().end(Fault("TAKEN_OVER", "somebody has it")))
    until(lambda: any("hands off" in line for line in made.said))
    made.simulated.faults.fall_dumb()
    until(lambda: any("heartbeats go on" in line for line in made.said))
    silent_since = made.simulated.autopilot.time
    until(lambda: made.simulated.autopilot.heard > silent_since + 10.0)
    assert not code.done()
    assert made.simulated.autopilot.mode_name == "loiter"
    made.simulated.faults.speak()
    with made.simulated.lock:
        made.simulated.autopilot.disarm()
    assert code.result(20.0) == 1


PILOTED = pytest.mark.parametrize(
    "mode",
    [
        "loiter",
        "return",
        "alt_hold",
        *(pytest.param(mode, marks=pytest.mark.thorough) for mode in ("stabilize", "land", "brake")),
    ],
)


@PILOTED
def test_a_pilot_who_takes_over_before_the_response_begins_is_left_alone(robot, mode):
    made = robot(Policy("DEVICE_SILENT", "RETURN"))
    made.simulated.faults.take_stick(mode)
    until(lambda: made.crew.vehicle.state().mode != "guided")
    heard = len(made.simulated.received)
    made.crew.desk.abandon.set()
    assert made.ending().end(Fault("DEVICE_SILENT", "no answer")) == 1
    assert made.simulated.received[heard:] == []
    assert made.mode == mode
    assert made.events() == ["DEVICE_SILENT"]


@PILOTED
def test_a_pilot_who_takes_over_right_before_a_stop_is_left_alone(robot, mode):
    made = robot(on_stop="land" if mode != "land" else "hold")
    made.simulated.faults.take_stick(mode)
    until(lambda: made.crew.vehicle.state().mode != "guided")
    heard = len(made.simulated.received)
    made.stop.set()
    made.crew.desk.abandon.set()
    fault = made.caught()
    assert fault.event == "TAKEN_OVER"
    assert made.ending().end(fault) == 1
    assert made.simulated.received[heard:] == []
    assert made.mode == mode


def land_for_the_battery(made) -> None:
    """Have the vehicle land by itself since it finds its battery low."""
    found = {"BATT_FS_LOW_ACT": 1.0, "BATT_LOW_TIMER": 0.0, "BATT_LOW_VOLT": 99.0}
    with made.simulated.lock:
        made.simulated.autopilot.parameters |= found
    until(lambda: made.crew.vehicle.state().mode == "land")


def test_a_landing_that_the_vehicle_began_itself_does_not_keep_it_from_its_way_home(robot):
    made = robot(Policy("PEER_LOST", "RETURN"))
    land_for_the_battery(made)
    assert made.ending().end(Fault("PEER_LOST", "nobody there")) == 1
    assert away(made, HOME) < 1.5


def test_a_stop_goes_before_what_the_vehicle_does_by_itself(robot):
    made = robot(Policy("BATTERY_LOW", "CONTINUE"), on_stop="return")
    land_for_the_battery(made)
    made.stop.set()
    fault = made.caught()
    assert fault.event == "STOPPED"
    assert made.ending().end(fault) == 130
    assert away(made, HOME) < 1.5


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


@pytest.mark.parametrize("begun", [False, True])
def test_a_vehicle_that_is_not_the_robots_is_told_nothing_and_a_log_that_was_begun_is_left(robot, begun):
    made = robot()
    if begun:
        made.crew.pilot.journal.write("begin")
    heard = len(made.simulated.received)
    ending = made.ending()
    assert ending.refuse(Strange("somebody else has it")) == 1
    assert ending.suspended is begun
    assert made.events() == ([] if begun else ["REFUSED"])
    assert made.simulated.received[heard:] == []
    assert made.simulated.autopilot.armed


SET_MODE = 176


@pytest.fixture
def halted(robot):
    """Return a function that gives a robot that stands still in the air, out of the mode it is steered in."""

    def fly(*policies, **more):
        made = robot(*policies, **more)
        made.crew.vehicle.hold()
        return made

    return fly


def test_a_return_that_cannot_be_steered_ends_on_the_ground_where_it_is(halted):
    made = halted(Policy("DEVICE_SILENT", "RETURN"), Policy("POSITION_LOST", "CONTINUE"))
    with made.simulated.lock:
        made.simulated.autopilot.parameters["FS_EKF_ACTION"] = 0.0
    made.simulated.faults.lose_position()
    assert made.ending().end(Fault("DEVICE_SILENT", "no answer")) == 1
    assert not made.simulated.autopilot.armed
    assert away(made, HOME) > 15.0
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
    assert away(made, HOME) < 1.5


def test_a_return_that_gets_nowhere_with_a_low_battery_is_a_landing(halted):
    made = halted(Policy("BATTERY_LOW", "RETURN"), Policy("POSITION_LOST", "CONTINUE"))
    with made.simulated.lock:
        made.simulated.autopilot.parameters["FS_EKF_ACTION"] = 0.0
    made.simulated.faults.lose_position()
    assert made.ending().end(Fault("BATTERY_LOW", "too little is left")) == 1
    assert not made.simulated.autopilot.armed
    assert not any("cannot carry out HOLD" in line for line in made.said)


def test_a_vehicle_that_obeys_nothing_is_stayed_with_where_it_would_not_come_down_by_itself(halted):
    made = halted(Policy("DEVICE_SILENT", "RETURN"), Policy("LINK_LOST", "CONTINUE"))
    made.simulated.faults.silence(SET_MODE)
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: any("interrupt to end" in line for line in made.said), 60.0)
    made.simulated.faults.silence()
    order = made.inbox.give(Order("land"))
    assert code.result(20.0) == 1
    assert order.confirmed, order.why
    assert not made.simulated.autopilot.armed


def test_a_vehicle_that_obeys_nothing_is_left_to_what_it_does_about_a_lost_link(halted):
    made = halted(Policy("DEVICE_SILENT", "RETURN"), Policy("LINK_LOST", "LAND"))
    made.simulated.faults.silence(SET_MODE)
    assert made.ending().end(Fault("DEVICE_SILENT", "no answer")) == 1
    assert made.said[-1].endswith("heartbeats end now: the vehicle does what it does about a lost link")


@pytest.mark.parametrize("on_stop", ["land", pytest.param("return", marks=pytest.mark.thorough)])
def test_a_stop_stops_a_robot_that_responds_to_something(robot, on_stop):
    made = robot(Policy("DEVICE_SILENT", "EMERGENCY_AREA"), on_stop=on_stop, cruise=1.0)
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: made.simulated.autopilot.body.pace > 0.5)
    made.stop.set()
    assert code.result(40.0) == 1
    assert not made.simulated.autopilot.armed
    assert (away(made, HOME) < 1.5) is (on_stop == "return")


def test_a_stop_stops_a_robot_that_holds_as_it_was_started(robot):
    made = robot(Policy("DEVICE_SILENT", "HOLD"), on_stop="land")
    code = in_background(lambda: made.ending().end(Fault("DEVICE_SILENT", "no answer")))
    until(lambda: "'alpha': holds; interrupt to end" in made.said)
    made.stop.set()
    assert code.result(20.0) == 1
    assert not made.simulated.autopilot.armed


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
    assert away(made, HOME) < 1.5
    names = {name for _, name in made.simulated.received[told:]}
    assert not names & {"COMMAND_LONG", "SET_POSITION_TARGET_GLOBAL_INT"}


def test_a_stop_that_is_not_obeyed_is_told_by_the_exit_code(halted):
    made = halted(Policy("LINK_LOST", "LAND"), on_stop="land")
    made.simulated.faults.silence(SET_MODE)
    assert made.ending().end(Stopped()) == 5
