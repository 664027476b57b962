"""A program that fails itself, before and after something has gone wrong."""

from __future__ import annotations

import json
from dataclasses import replace
from math import nan

from flight_crew import in_background, robot_of
from patience import until
from sessions import labels

from mmrs_mavlink.program import Geographic, Hold, Policy
from mmrs_mavlink.session import run_robot
from mmrs_runtime.orders.orders import Order
from mmrs_runtime.records.log import read

STEPS = robot_of().steps


def test_a_program_that_fails_itself_leaves_a_fault_in_the_log(process, tmp_path, capsys):
    unsound = (replace(step, movement=Hold("long")) if step.move == "stay" else step for step in STEPS)
    broken = replace(robot_of(), steps=tuple(unsound))
    assert run_robot(broken, process(broken)) == 1
    assert [line.detail for line in read(tmp_path / "alpha.jsonl") if line.label == "fault"] == ["CRASHED"]
    assert "TypeError: " in capsys.readouterr().err


LONG = tuple(replace(step, movement=Hold(200.0)) if step.move == "stay" else step for step in STEPS)


NOWHERE = tuple((move, (Geographic(nan, nan, nan),)) for move in ("up", "out"))


def fails_to_respond(*policies):
    """Return a robot whose way to an emergency area the program itself cannot make out."""
    robot = robot_of(Policy("OBSTACLE", "EMERGENCY_AREA"), *policies, escapes=NOWHERE)
    return replace(robot, steps=LONG)


def meet_obstacle(shared, simulated, robot):
    """Have a robot that stays answer an obstacle; return what it will come to."""
    code = in_background(lambda: run_robot(robot, shared))
    until(lambda: shared.crews.status("alpha").get("move") == "stay")
    simulated.faults.meet_obstacle(1.0)
    return code


def test_a_response_that_fails_itself_leaves_a_robot_that_holds_and_obeys(process, vehicle, tmp_path):
    simulated, port = vehicle
    robot = fails_to_respond()
    shared = process(robot, port=port)
    code = meet_obstacle(shared, simulated, robot)
    until(lambda: simulated.autopilot.mode_name == "brake")
    landed = shared.crews.inboxes["alpha"].give(Order("land"))
    assert code.result(30.0) == 1
    assert landed.confirmed
    assert not simulated.autopilot.armed
    assert [line.detail for line in read(tmp_path / "alpha.jsonl") if line.label == "fault"] == ["OBSTACLE"]
    box = map(json.loads, (tmp_path / "alpha.blackbox.ndjson").read_text("ascii").splitlines())
    (failed,) = (line for line in box if line["kind"] == "failed")
    assert "cannot convert float NaN" in failed["error"]
    assert "in go_to" in failed["trace"]


def test_a_robot_that_can_do_nothing_about_its_own_failure_keeps_its_link_until_it_is_down(
    process, vehicle, tmp_path, capsys
):
    simulated, port = vehicle
    robot = fails_to_respond(Policy("CRASHED", "EMERGENCY_AREA"))
    shared = process(robot, port=port)
    code = meet_obstacle(shared, simulated, robot)
    until(lambda: "is told nothing any more" in capsys.readouterr().err)
    order = shared.crews.inboxes["alpha"].give(Order("land"))
    until(lambda: order.confirmed is not None)
    assert (order.confirmed, order.why) == (False, "its program itself has failed")
    assert not code.done()
    simulated.faults.take_stick("land")
    assert code.result(30.0) == 1
    assert not simulated.autopilot.armed
    assert labels(tmp_path).count("fault") == 1
    assert shared.slots.lost(["alpha"]) == "alpha"


def test_what_fails_before_there_is_a_vehicle_ends_the_robot_for_the_others_too(process, capsys):
    shared = process(robot_of())
    broken = replace(robot_of(), log=None)
    assert run_robot(broken, shared) == 1
    assert shared.slots.lost(["alpha"]) == "alpha"
    assert "the program itself fails: " in capsys.readouterr().err
