"""A robot that has come down for its battery waits for another, and goes on with it."""

from __future__ import annotations

import re

import pytest
from flight_crew import in_background, robot_of
from patience import until
from ports import free_port
from sessions import labels, phase

from mmrs_mavlink.program import Policy
from mmrs_mavlink.session import run_robot
from mmrs_runtime.orders.orders import Order
from mmrs_runtime.phases import SUSPENDED, WORKS

OTHER = robot_of(id="beta")
STEPS = robot_of().steps


def empty(shared, simulated):
    """Have the battery of a robot that stays be low, and it come home for another."""
    code = in_background(lambda: run_robot(robot_of(Policy("BATTERY_LOW", "RETURN")), shared))
    until(lambda: shared.crews.status("alpha").get("move") == "stay")
    simulated.faults.set_battery(0.05)
    return code


def test_a_robot_that_came_home_for_its_battery_is_not_told_to_have_ended(process, vehicle, tmp_path):
    simulated, port = vehicle
    shared = process(robot_of(), port=port)
    assert empty(shared, simulated).result(30.0) == 1
    assert not simulated.autopilot.armed
    assert shared.slots.lost(["alpha"]) is None
    assert "fault" not in labels(tmp_path)


def waits_for_a_battery(process, vehicle):
    """Return a process whose robot waits for a battery while another works, and what it will come to."""
    simulated, port = vehicle
    shared = process(robot_of(), OTHER, port=port, words=["--connect", "beta=udpin:127.0.0.1:1"])
    code = empty(shared, simulated)
    until(lambda: phase(shared) == SUSPENDED)
    return shared, code


@pytest.mark.parametrize("left_alone", [True, False])
def test_another_battery_lets_it_go_on_and_be_watched_as_before(process, vehicle, tmp_path, left_alone):
    shared, code = waits_for_a_battery(process, vehicle)
    simulated, _ = vehicle
    early = shared.crews.inboxes["alpha"].give(Order("resume"))
    until(lambda: early.confirmed is not None)
    assert not early.confirmed
    assert re.fullmatch(r"its battery is still at [345]%", early.why)
    simulated.faults.set_battery(1.0)
    until(lambda: shared.crews.inboxes["alpha"].give(Order("resume")).confirmed or phase(shared) == WORKS)
    if left_alone:
        assert code.result(30.0) == 0
        assert labels(tmp_path).count("end") == len(STEPS)
        return
    until(lambda: simulated.autopilot.body.position[2] > 5.0)
    simulated.faults.take_stick("loiter")
    shared.abandon.set()
    assert code.result(30.0) == 1
    assert labels(tmp_path)[-1] == "fault"


def test_a_robot_that_came_down_elsewhere_goes_on_only_once_it_stands_at_home(process, vehicle, capsys):
    simulated, port = vehicle
    shared = process(robot_of(), OTHER, port=port, words=["--connect", "beta=udpin:127.0.0.1:1"])
    inbox = shared.crews.inboxes["alpha"]
    code = in_background(lambda: run_robot(robot_of(Policy("BATTERY_LOW", "LAND")), shared))
    until(lambda: shared.crews.status("alpha").get("move") == "stay")
    simulated.faults.set_battery(0.05)
    until(lambda: phase(shared) == SUSPENDED)
    assert "m from its home: carry it home; change it, then order resume" in capsys.readouterr().err
    simulated.faults.set_battery(1.0)
    for order in ("resume", "return"):
        refused = inbox.give(Order(order))
        until(lambda: refused.confirmed is not None)  # noqa: B023
        assert not refused.confirmed
        assert re.fullmatch(r"it stands 2\d m from its home: carry it home", refused.why)
    with simulated.lock:
        simulated.autopilot.body.position = (0.0, 0.0, 0.0)

    def resumed():
        again = inbox.give(Order("resume"))
        until(lambda: again.confirmed is not None)
        return again.confirmed

    until(resumed)
    assert simulated.autopilot.armed
    assert code.result(30.0) == 0


def test_an_order_to_a_resumed_robot_whose_vehicle_is_not_heard_is_not_confirmed(process, vehicle, tmp_path):
    simulated, port = vehicle
    shared = process(robot_of(), port=port)
    assert empty(shared, simulated).result(30.0) == 1
    again = process(robot_of(), port=free_port(), words=["--resume"])
    code = in_background(lambda: run_robot(robot_of(), again))
    receipt = again.crews.inboxes["alpha"].give(Order("land"))
    assert code.result(20.0) == 130
    assert (receipt.confirmed, receipt.why) == (False, "its vehicle was not heard, and was told nothing")


def test_a_robot_that_cannot_take_off_again_may_be_resumed_once_more(process, vehicle, tmp_path, capsys):
    simulated, port = vehicle
    assert empty(process(robot_of(), port=port), simulated).result(30.0) == 1
    simulated.faults.set_battery(1.0)
    simulated.faults.refuse_arming("Compass not calibrated")
    assert run_robot(robot_of(), process(robot_of(), port=port, words=["--resume"])) == 1
    said = capsys.readouterr().err
    assert "Compass not calibrated" in said
    assert "'alpha': has not gone on; --resume tries again" in said
    assert "fault" not in labels(tmp_path)
    simulated.faults.refuse_arming("")
    assert run_robot(robot_of(), process(robot_of(), port=port, words=["--resume"])) == 0


@pytest.mark.parametrize("name", ["hold", "land", "resume"])
def test_who_waits_for_a_battery_obeys_nothing_while_somebody_else_flies_its_vehicle(process, vehicle, name):
    shared, code = waits_for_a_battery(process, vehicle)
    simulated, _ = vehicle
    simulated.faults.set_battery(1.0)
    simulated.faults.take_stick("stabilize")
    with simulated.lock:
        simulated.autopilot.parameters["DISARM_DELAY"] = 0.0
        simulated.autopilot.arm()
    until(lambda: shared.crews.status("alpha")["armed"])
    refused = shared.crews.inboxes["alpha"].give(Order(name))
    until(lambda: refused.confirmed is not None)
    assert (refused.confirmed, refused.why) == (False, "its motors run: somebody else has it")
    assert simulated.autopilot.armed
    shared.stop.set()
    assert code.result(20.0) == 1


@pytest.mark.parametrize("by", ["order", "signal", "others"])
def test_who_waits_for_a_battery_ends_when_somebody_says_so_or_nobody_works_any_more(process, vehicle, by):
    shared, code = waits_for_a_battery(process, vehicle)
    receipt = None
    if by == "order":
        receipt = shared.crews.inboxes["alpha"].give(Order("stop"))
    elif by == "signal":
        shared.stop.set()
    else:
        shared.crews.dismiss("beta")
    assert code.result(20.0) == 1
    assert shared.slots.lost(["alpha"]) is None
    assert receipt is None or receipt.confirmed
