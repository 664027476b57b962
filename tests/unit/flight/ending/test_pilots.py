"""What a robot does when a pilot takes its vehicle: nothing, until the motors are off."""

from __future__ import annotations

import pytest
from flight_crew import in_background
from patience import until

from mmrs_mavlink.program import Policy
from mmrs_runtime.faults import Fault
from mmrs_runtime.orders.orders import Order


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


@pytest.mark.parametrize(
    ("told", "mode"),
    [
        ("RETURN", "loiter"),
        pytest.param("RETURN", "alt_hold", marks=pytest.mark.thorough),
        ("RETURN", "brake"),
        ("LAND", "return"),
    ],
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
        *(
            pytest.param(mode, marks=pytest.mark.thorough)
            for mode in ("alt_hold", "stabilize", "land", "brake")
        ),
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
