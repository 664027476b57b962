"""One robot at work in this process, from the opening of its log to whatever end it comes to."""

from __future__ import annotations

import json
import re
import threading
import time
from dataclasses import replace
from math import nan

import pytest
from flight_crew import SPEEDUP, SteadyClock, in_background, robot_of
from patience import until
from ports import free_port

from mmrs_core.flight.crews import Crews
from mmrs_core.flight.injection import Rehearsal
from mmrs_core.flight.judgement import Judgement
from mmrs_core.flight.links.radios import Radios
from mmrs_core.flight.options import options_of, parser_for
from mmrs_core.flight.orders.orders import Order
from mmrs_core.flight.phases import ENDED, HELD, HELD_EARLY, SUSPENDED, WAITS, WORKS
from mmrs_core.flight.program import Geographic, GoTo, Hold, Policy
from mmrs_core.flight.records.log import read
from mmrs_core.flight.session import Shared, run_robot
from mmrs_core.flight.slots import LocalSlots
from mmrs_core.flight.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_core.sitl import Settings, SimulatedVehicle

OTHER = robot_of(id="beta")
STEPS = robot_of().steps


@pytest.fixture
def process(tmp_path):
    """Return a function that gives what robots share, alpha's vehicle being at that port, or made up."""

    def share(*robots, port: int = 0, words=()):
        vehicle = ["--connect", f"alpha=udpin:127.0.0.1:{port}@1", "--speedup", str(SPEEDUP)]
        arguments = [*(vehicle if port else ["--dry-run"]), "--log", str(tmp_path), *words]
        options = options_of(parser_for(robots), robots, arguments)
        if port:
            options = replace(options, clock=SteadyClock(SPEEDUP, options.clock.now()))
        judgement = Judgement({}, {})
        return Shared(
            options=options,
            slots=LocalSlots(robots),
            judgement=judgement,
            decides=judgement.decides(robots),
            rehearsal=Rehearsal(options.inject, options.clock, print),
            radios=Radios(options.clock, retries=options.reach.retries),
            crews=Crews([robot.id for robot in robots]),
            stop=threading.Event(),
            abandon=threading.Event(),
        )

    return share


@pytest.fixture
def vehicle():
    """Return a simulated vehicle at alpha's home, and its port."""
    port = free_port()
    with SimulatedVehicle(port, Settings(), speedup=SPEEDUP) as simulated:
        yield simulated, port


def phase(shared, robot="alpha"):
    return shared.crews.status(robot)["phase"]


def labels(folder):
    return [line["label"] for line in read(folder / "alpha.jsonl")]


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


def test_a_program_that_fails_itself_leaves_a_fault_in_the_log(process, tmp_path, capsys):
    unsound = (replace(step, movement=Hold("long")) if step.move == "stay" else step for step in STEPS)
    broken = replace(robot_of(), steps=tuple(unsound))
    assert run_robot(broken, process(broken)) == 1
    assert [line["detail"] for line in read(tmp_path / "alpha.jsonl") if line["label"] == "fault"] == [
        "CRASHED"
    ]
    assert "TypeError: " in capsys.readouterr().err


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
    assert [line["detail"] for line in read(tmp_path / "alpha.jsonl") if line["label"] == "fault"] == [
        "OBSTACLE"
    ]
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
