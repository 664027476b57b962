"""One robot at work in this process, from the opening of its log to whatever end it comes to."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest
from flight_crew import SPEEDUP, in_background, robot_of
from patience import until
from ports import free_port
from sessions import labels, phase

from mmrs_core.sitl import Settings, SimulatedVehicle
from mmrs_mavlink.program import GoTo
from mmrs_mavlink.session import run_robot
from mmrs_mavlink.slots import LocalSlots
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_runtime.orders.orders import Order
from mmrs_runtime.phases import ENDED, HELD, HELD_EARLY, WAITS, WORKS

OTHER = robot_of(id="beta")
STEPS = robot_of().steps


def test_a_program_is_carried_out_and_the_others_are_told_that_it_has_ended(process, tmp_path, capsys):
    shared = process(robot_of())
    assert phase(shared) == WAITS
    assert run_robot(robot_of(), shared) == 0
    assert phase(shared) == ENDED
    assert shared.slots.lost(["alpha"]) == "alpha"
    assert labels(tmp_path).count("end") == len(STEPS)
    assert "'alpha': done" in capsys.readouterr().err


def test_names_of_what_was_detected_go_with_notifies():
    sender, receiver = robot_of(), replace(OTHER, slots=("go",), senders=(("go", ("alpha",)),))
    slots = LocalSlots([sender, receiver])
    slots.notify("alpha", [("beta", "go")], True, lambda lamport: None, lambda silent: None, {"buoy"})
    assert slots.found("beta") == {"buoy"}
    assert slots.found("alpha") == set()


def test_a_robot_flies_and_tells_where_it_is_and_what_it_does(process, vehicle, tmp_path):
    simulated, port = vehicle
    shared = process(robot_of(), port=port)
    code = in_background(lambda: run_robot(robot_of(), shared))
    until(lambda: shared.crews.status("alpha").get("move") == "stay")
    told = shared.crews.status("alpha")
    assert (told["phase"], told["mode"], told["armed"]) == (WORKS, "guided", True)
    assert told["place"]["height"] == pytest.approx(10.0, abs=1.0)
    assert code.result(30.0) == 0
    assert not simulated.autopilot.armed
    assert "fault" not in labels(tmp_path)


def test_a_level_leg_is_as_high_as_the_climb_before_it_was_to_be(process, vehicle, monkeypatch):
    _, port = vehicle
    told, go_to = [], MavlinkVehicle.go_to

    def noted(self, place, *more):
        told.append(place)
        go_to(self, place, *more)

    monkeypatch.setattr(MavlinkVehicle, "go_to", noted)
    aside = replace(robot_of().home, latitude=robot_of().home.latitude + 1e-4, height=14.0)
    way = GoTo(aside, legs="level first")
    steps = (replace(step, movement=way) if step.move == "out" else step for step in STEPS)
    robot = replace(robot_of(), steps=tuple(steps))
    assert run_robot(robot, process(robot, port=port)) == 0
    assert [place.height for place in told[:2]] == [10.0, 14.0]


def test_an_order_before_there_is_a_vehicle_ends_the_program_and_is_confirmed(process):
    shared = process(robot_of(), port=free_port())
    code = in_background(lambda: run_robot(robot_of(), shared))
    receipt = shared.crews.inboxes["alpha"].give(Order("land"))
    assert code.result(20.0) == 130
    assert (receipt.confirmed, receipt.why) == (True, "there was no vehicle yet")
    assert shared.slots.lost(["alpha"]) == "alpha"


def test_a_robot_that_is_held_before_its_vehicle_speaks_says_so_until_it_goes_on(process, vehicle):
    simulated, port = vehicle
    simulated.faults.cut_link()
    shared = process(robot_of(), port=port)
    code = in_background(lambda: run_robot(robot_of(), shared))
    give = shared.crews.inboxes["alpha"].give
    give(Order("hold"))
    until(lambda: phase(shared) == HELD_EARLY)
    simulated.faults.mend_link()
    until(lambda: phase(shared) == HELD)
    receipt = give(Order("resume"))
    until(lambda: receipt.confirmed is not None)
    until(lambda: phase(shared) == WORKS)
    assert code.result(30.0) == 0


def test_a_vehicle_that_never_speaks_is_a_lost_link(process, capsys):
    shared = process(robot_of(), port=free_port(), words=["--patience", "0.3"])
    assert run_robot(robot_of(), shared) == 5
    assert "'alpha': no vehicle at udpin" in capsys.readouterr().err
    assert shared.slots.lost(["alpha"]) == "alpha"


def test_what_has_ended_obeys_no_more(process):
    shared = process(robot_of())
    run_robot(robot_of(), shared)
    receipt = shared.crews.inboxes["alpha"].give(Order("hold"))
    assert (receipt.confirmed, receipt.why) == (False, "its program has ended")


def test_a_finished_program_is_not_flown_again(process, tmp_path, capsys):
    run_robot(robot_of(), process(robot_of()))
    before = labels(tmp_path)
    again = process(robot_of(), port=free_port(), words=["--resume"])
    assert run_robot(robot_of(), again) == 0
    assert labels(tmp_path) == before
    assert "it has come to its end" in capsys.readouterr().err


def test_a_program_that_ended_by_a_fault_does_not_go_on(process, tmp_path, capsys):
    shared = process(robot_of())
    shared.stop.set()
    assert run_robot(robot_of(), shared) == 130
    again = process(robot_of(), port=free_port(), words=["--resume"])
    assert run_robot(robot_of(), again) == 1
    assert "cannot go on: it has ended by STOPPED" in capsys.readouterr().err
    assert again.slots.lost(["alpha"]) == "alpha"


def test_a_hold_before_the_vehicle_speaks_keeps_the_robot_on_the_ground(process):
    port = free_port()
    shared = process(robot_of(), port=port)
    code = in_background(lambda: run_robot(robot_of(), shared))
    held = shared.crews.inboxes["alpha"].give(Order("hold"))
    with SimulatedVehicle(port, Settings(), speedup=SPEEDUP) as simulated:
        until(lambda: held.confirmed is not None)
        assert held.confirmed, held.why
        time.sleep(1.0)
        assert not simulated.autopilot.armed
        assert shared.crews.inboxes["alpha"].give(Order("resume"))
        assert code.result(30.0) == 0
