"""`mmrs run` as a process: missions, orders, interrupts, resumption, several processes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from math import dist
from pathlib import Path

import pytest
from fault_table.fleet import free_port, wait_for
from fault_table.project import OUT, TOUR, Pad, home_of

from mmrs_core.behaviour.replay import Outcome
from mmrs_core.cli import run
from mmrs_core.flight.orders.ordering import give
from mmrs_core.sitl import Settings, SimulatedVehicle
from mmrs_core.sitl.commands import obey

PATIENCE = 60.0
UNHURRIED = 15.0
"""Speed-up that leaves real time for orders on the way."""
AT_HOME = 0.6
"""Metres from home at which a vehicle may land: the radius in which places count as reached, and a little."""
FULL = Path("/dev/full")
TAKE_OFF = 22
HOLDING = 17
"""ArduPilot's number of BRAKE."""

SYNCHRONISED = (Pad("a", "wait"), Pad("b", "give", stay=8.0, gives="a"))


def control(fleet, order):
    """Give an order to all robots by `mmrs control`; return its answer by robot."""
    command = [sys.executable, "-m", "mmrs_core", "control", order, "--log", str(fleet.logs), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    assert done.stdout, done.stderr
    return {reply["robot"]: reply for reply in json.loads(done.stdout)["robots"]}


def ordered(fleet, order, robot="a", **options):
    """Give an order to a robot as `mmrs control` does; return its answer."""
    (reply,) = give(fleet.logs, order, [robot], **options)
    return reply


@pytest.fixture
def told(capsys):
    """Return a function that gives robots an `mmrs run` which refuses: its exit code, and its last words."""

    def call(fleet, *arguments, robot=""):
        code = run(fleet.command(*arguments, robot=robot)[2:])
        return code, capsys.readouterr().err.splitlines()[-1]

    return call


def begun(fleet, robot, move):
    """Wait until a robot has begun a move."""

    def found():
        return any(s["label"] == "begin" and s["move"] == move for s in fleet.steps(robot))

    assert wait_for(found, PATIENCE), fleet.process.said
    return fleet.vehicles[robot]


def judged(fleet):
    """Return the outcome of a replay without complaints."""
    result = fleet.replayed()
    assert result.complaints == ()
    return result.outcome


def landed(fleet):
    return not any(vehicle.autopilot.armed for vehicle in fleet.vehicles.values())


def least_distance(vehicle, place):
    return min(
        sum((a - b) ** 2 for a, b in zip(point[1:], place, strict=True)) ** 0.5
        for point in vehicle.autopilot.track
    )


def test_robots_of_one_process_wait_for_each_other_and_their_logs_replay(fleet):
    flown = fleet(*SYNCHRONISED, Pad("c", stay=2.0))
    assert flown.start().end(PATIENCE) == 0, flown.process.said
    assert judged(flown) is Outcome.SUCCESS
    assert landed(flown)
    assert all(least_distance(flown.vehicles["c"], place) < 2.0 for place in (OUT, *TOUR))


def test_robots_fly_on_where_nobody_reads_or_what_is_said_cannot_be_written(fleet):
    flown = fleet(Pad("a"))
    reading, writing = os.pipe()
    with os.fdopen(writing, "w") as into:
        process = flown.start(into=into)
    begun(flown, "a", "out")
    os.close(reading)
    process.signal(signal.SIGHUP)
    assert process.end(PATIENCE) == 0
    assert judged(flown) is Outcome.SUCCESS


@pytest.mark.skipif(not FULL.exists(), reason="needs a device that is full")
def test_robots_fly_where_nothing_that_is_said_can_be_written(fleet):
    flown = fleet(Pad("a"))
    with FULL.open("w") as into:
        assert flown.start(into=into).end(PATIENCE) == 0
    assert judged(flown) is Outcome.SUCCESS


def test_a_full_disk_ends_a_robot_by_its_policy_also_where_what_is_said_goes_there(fleet, tmp_path):
    flown = fleet(Pad("a"), speedup=8.0)
    with (tmp_path / "said.txt").open("w") as into:
        process = flown.start("--inject", "disk-full@35+400", into=into)
        assert process.end(PATIENCE) == 1
    moves = {step["move"] for step in flown.steps("a")}
    assert "start" in moves
    assert "stop" not in moves
    assert landed(flown)


def test_robots_of_two_processes_meet_on_the_bus_and_begin_together(fleet):
    flown = fleet(*SYNCHRONISED)
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    first = flown.start("--bus-listen", endpoint, "--sync", robot="a")
    second = flown.start("--bus-connect", endpoint, "--sync", robot="b")
    assert (first.end(PATIENCE), second.end(PATIENCE)) == (0, 0), first.said + second.said
    assert judged(flown) is Outcome.SUCCESS
    assert any("begins together" in line for line in first.said)
    for robot in "ab":
        (begun,) = [line for line in flown.box(robot) if line.get("what") == "TOGETHER"]
        assert begun["response"] == "begins"
        assert "ms apart, known to" in begun["why"]


def test_nothing_begins_where_robots_of_other_processes_do_not_come(fleet):
    flown = fleet(*SYNCHRONISED)
    listens = ("--bus-listen", f"tcp/127.0.0.1:{free_port()}")
    process = flown.start(*listens, "--sync", "--sync-patience", "1", robot="a")
    assert process.end(PATIENCE) == 5, process.said
    assert "after 1 s 'b' is not ready; never seen on the bus: 'b'" in process.said[-1]
    assert any("1 of 2 are ready: 'a'; not yet: 'b'" in line for line in process.said)
    assert not any(number == 400 for _, number, _ in flown.vehicles["a"].autopilot.history)
    assert flown.steps("a") == []


def test_a_robot_whose_peers_run_elsewhere_needs_the_bus(fleet, told):
    code, said = told(fleet(*SYNCHRONISED), robot="a")
    assert code == 2
    assert "say --bus" in said


def test_orders_are_obeyed_and_confirmed_by_the_vehicles(fleet):
    flown = fleet(Pad("a", stay=60.0), Pad("b", stay=60.0), speedup=UNHURRIED)
    process = flown.start()
    vehicle, other = begun(flown, "a", "out"), begun(flown, "b", "out")
    held = control(flown, "hold")
    assert all(reply["confirmed"] for reply in held.values()), held
    assert all(reply["seconds"] < 1.0 for reply in held.values()), held
    assert (vehicle.autopilot.mode, other.autopilot.mode) == (HOLDING, HOLDING)
    assert wait_for(lambda: vehicle.autopilot.body.pace < 0.1, PATIENCE)
    place = vehicle.autopilot.body.position
    time.sleep(1.0)
    assert vehicle.autopilot.body.position == pytest.approx(place, abs=0.3)
    assert ordered(flown, "resume")["confirmed"]
    begun(flown, "a", "stay")
    landing = ordered(flown, "land", "b")
    assert landing["confirmed"]
    assert landing["seconds"] < 1.0
    assert wait_for(lambda: not other.autopilot.armed, PATIENCE)
    assert ordered(flown, "return")["confirmed"]
    assert process.end(PATIENCE) == 130, process.said
    assert vehicle.autopilot.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)
    assert {s["detail"] for r in "ab" for s in flown.steps(r) if s["label"] == "fault"} == {"ORDERED"}
    assert judged(flown) is Outcome.FAILED


def test_a_vehicle_that_hears_nothing_confirms_nothing(fleet):
    flown = fleet(Pad("a"))
    process = flown.start()
    vehicle = begun(flown, "a", "out")
    vehicle.faults.cut_link()
    assert not ordered(flown, "return", seconds=1.0)["confirmed"]
    assert process.end(PATIENCE) == 5, process.said


def test_a_robot_whose_link_comes_back_is_heard_again_and_lands_where_it_is_told_to(fleet):
    flown = fleet(Pad("a", policies=(("LINK_LOST", "RETURN", 5.0),)), speedup=8.0)
    process = flown.start()
    vehicle = begun(flown, "a", "tour 1")
    vehicle.faults.cut_link()
    assert wait_for(lambda: any(s["detail"] == "LINK_LOST" for s in flown.steps("a")), PATIENCE)
    assert ordered(flown, "land")["why"] == "its link is lost"
    vehicle.faults.mend_link()
    assert wait_for(lambda: any("is heard again" in line for line in process.said), PATIENCE)
    assert ordered(flown, "hold")["confirmed"]
    assert vehicle.autopilot.mode == HOLDING
    assert ordered(flown, "land")["confirmed"]
    assert process.end(PATIENCE) == 5, process.said
    assert landed(flown)


def test_a_robot_that_came_down_elsewhere_for_its_battery_is_not_resumed_before_it_stands_at_home(fleet):
    flown = fleet(Pad("a", policies=(("BATTERY_LOW", "LAND", None),)))
    process = flown.start("--battery-patience", "600")
    vehicle = begun(flown, "a", "tour 1")
    vehicle.faults.set_battery(0.15)
    assert wait_for(lambda: any("carry it home" in line for line in process.said), PATIENCE)
    vehicle.faults.set_battery(1.0)
    for order in ("resume", "return"):
        assert ordered(flown, order)["why"].endswith("m from its home: carry it home")
    with vehicle.lock:
        vehicle.autopilot.body.position = (0.0, 0.0, 0.0)
    assert wait_for(lambda: ordered(flown, "resume")["confirmed"], PATIENCE)
    assert vehicle.autopilot.armed
    assert process.end(PATIENCE) == 0, process.said
    assert judged(flown) is Outcome.SUCCESS


def test_a_battery_that_was_not_changed_is_not_flown_with_by_a_new_process_either(fleet):
    flown = fleet(Pad("a", policies=(("BATTERY_LOW", "RETURN", None),)))
    process = flown.start()
    vehicle = begun(flown, "a", "tour 1")
    vehicle.faults.set_battery(0.15)
    assert process.end(PATIENCE) == 1, process.said
    assert any("came home for its battery" in line for line in process.said), process.said
    take_offs = sum(number == TAKE_OFF for _, number, _ in vehicle.autopilot.history)
    again = flown.start("--resume")
    assert again.end(PATIENCE) == 1, again.said
    assert any("its battery is still at 1" in line for line in again.said), again.said
    assert sum(number == TAKE_OFF for _, number, _ in vehicle.autopilot.history) == take_offs


def test_a_hold_before_the_vehicles_speak_keeps_them_on_the_ground(fleet):
    flown = fleet(Pad("a"))
    flown.vehicles["a"].faults.cut_link()
    process = flown.start()
    assert wait_for(lambda: any("waits for a vehicle" in line for line in process.said), PATIENCE)
    assert not ordered(flown, "hold", seconds=0.5)["confirmed"]
    flown.vehicles["a"].faults.mend_link()
    assert ordered(flown, "hold")["confirmed"]
    time.sleep(1.0)
    assert not flown.vehicles["a"].autopilot.armed
    assert ordered(flown, "land")["confirmed"]
    assert process.end(PATIENCE) == 130, process.said
    assert not any(number == 400 for _, number, _ in flown.vehicles["a"].autopilot.history)


def test_an_interrupt_stops_every_robot_and_each_confirms(fleet):
    flown = fleet(Pad("a"), Pad("b", "wait"), Pad("g", "give", stay=100.0, gives="b"))
    process = flown.start()
    begun(flown, "a", "tour 0")
    process.signal(signal.SIGINT)
    assert process.end(PATIENCE) == 130, process.said
    assert all(vehicle.autopilot.mode == HOLDING for vehicle in flown.vehicles.values())
    assert {f"'{robot}': has done HOLD" for robot in "abg"} <= set(process.said)
    assert judged(flown) is Outcome.FAILED


@pytest.mark.parametrize("move", [pytest.param("out", marks=pytest.mark.thorough), "tour 0"])
def test_a_killed_run_is_resumed_where_its_log_ends(fleet, move):
    flown = fleet(
        Pad("a", stay=2.0), *(Pad(p.robot + "2", p.program, (), 8.0, p.gives and "a2") for p in SYNCHRONISED)
    )
    killed = flown.start()
    begun(flown, "a", move)
    killed.signal(signal.SIGKILL)
    killed.end(PATIENCE)
    resumed = flown.start("--resume")
    assert resumed.end(PATIENCE) == 0, resumed.said
    assert judged(flown) is Outcome.SUCCESS
    assert landed(flown)


def test_a_robot_in_the_air_waits_for_one_whose_battery_is_changed_and_then_goes_on(fleet):
    low = (("BATTERY_LOW", "RETURN", None),)
    flown = fleet(Pad("a", "give", low, stay=30.0, gives="b"), Pad("b", "wait"))
    process = flown.start()
    vehicle = begun(flown, "a", "stay")
    assert wait_for(
        lambda: any(s["move"] == "out" and s["label"] == "end" for s in flown.steps("b")), PATIENCE
    )
    vehicle.faults.set_battery(0.15)
    words = "nothing goes on until somebody orders something: 'b' waits after 'out'"
    assert wait_for(lambda: any(words in line for line in process.said), PATIENCE), process.said
    assert not vehicle.autopilot.armed
    assert flown.vehicles["b"].autopilot.armed
    vehicle.faults.set_battery(1.0)
    assert wait_for(lambda: ordered(flown, "resume")["confirmed"], PATIENCE)
    assert process.end(PATIENCE) == 0, process.said
    assert judged(flown) is Outcome.SUCCESS


def test_a_return_that_is_held_is_watched_until_it_goes_on(fleet):
    flown = fleet(Pad("a"), speedup=UNHURRIED)
    process = flown.start()
    vehicle = begun(flown, "a", "tour 1").autopilot
    assert ordered(flown, "return")["confirmed"]
    assert ordered(flown, "hold")["confirmed"]
    assert wait_for(lambda: "'a': has done HOLD" in process.said, PATIENCE)
    time.sleep(1.0)
    assert process.running()
    assert vehicle.mode == HOLDING
    assert ordered(flown, "resume")["confirmed"]
    assert process.end(PATIENCE) == 130, process.said
    assert vehicle.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)


STAYS = ("LINK_LOST", "HOLD", 5.0)
"""Has a vehicle be in the air still when its run is resumed, however long that takes on a busy machine."""


def broken_off(flown, **moves):
    """Kill a run once its robots have begun these moves; nobody hears `b` from then on."""
    killed = flown.start()
    for robot, move in moves.items():
        begun(flown, robot, move)
    killed.signal(signal.SIGKILL)
    killed.end(PATIENCE)
    flown.vehicles["b"].faults.cut_link()


def test_a_robot_in_the_air_obeys_before_another_is_heard_that_then_goes_on_too(fleet):
    flown = fleet(Pad("a", policies=(STAYS,)), Pad("b", stay=2.0), speedup=UNHURRIED)
    broken_off(flown, a="out", b="out")
    resumed = flown.start("--resume", "--backend-option", "patience=120")
    vehicle = flown.vehicles["a"].autopilot
    assert wait_for(lambda: any("waits for a vehicle" in line for line in resumed.said), PATIENCE)
    assert ordered(flown, "hold")["confirmed"], resumed.said
    assert wait_for(lambda: vehicle.mode == HOLDING, PATIENCE), resumed.said
    landing = ordered(flown, "land")
    assert landing["confirmed"]
    assert landing["seconds"] < 1.0
    assert wait_for(lambda: not vehicle.armed, PATIENCE)
    flown.vehicles["b"].faults.mend_link()
    assert resumed.end(PATIENCE) == 130, resumed.said
    assert flown.steps("b")[-1]["move"] == "stop"
    assert judged(flown) is Outcome.FAILED


def test_a_robot_in_the_air_comes_home_by_its_policy_where_another_is_never_heard_again(fleet):
    flown = fleet(
        Pad("a", "wait", (STAYS, ("PEER_LOST", "RETURN", 2.0))), Pad("b", "give", stay=100.0, gives="a")
    )
    broken_off(flown, a="out", b="stay")
    before = flown.steps("b")
    resumed = flown.start("--resume", "--backend-option", "patience=3")
    assert resumed.end(PATIENCE) == 5, resumed.said
    assert any("'b': does not get ready" in line for line in resumed.said)
    assert flown.steps("a")[-1]["detail"] == "PEER_LOST"
    vehicle = flown.vehicles["a"].autopilot
    assert not vehicle.armed
    assert vehicle.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)
    assert flown.steps("b") == before


def test_a_robot_whose_run_is_killed_on_its_way_home_for_its_battery_comes_home_in_the_resumed_run(fleet):
    low = (STAYS, ("BATTERY_LOW", "RETURN", None))
    flown = fleet(Pad("a", policies=low, stay=2.0), Pad("b", stay=2.0), speedup=UNHURRIED)
    killed = flown.start()
    vehicle = begun(flown, "a", "tour 3")
    vehicle.faults.set_battery(0.15)
    assert wait_for(lambda: any("BATTERY_LOW" in line for line in killed.said), PATIENCE)
    killed.signal(signal.SIGKILL)
    killed.end(PATIENCE)
    resumed = flown.start("--resume")
    assert resumed.end(PATIENCE) == 1, resumed.said
    assert any("'a': came home for its battery" in line for line in resumed.said), resumed.said
    assert not vehicle.autopilot.armed
    assert vehicle.autopilot.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)
    assert "fault" not in {step["label"] for step in flown.steps("a")}
    assert flown.steps("b")[-1]["move"] == "stop"


def test_a_changed_battery_lets_a_run_go_on_where_it_stopped(fleet):
    flown = fleet(Pad("a", stay=2.0, policies=(("BATTERY_LOW", "RETURN", None),)))
    first = flown.start()
    vehicle = begun(flown, "a", "tour 1")
    vehicle.faults.set_battery(0.15)
    assert first.end(PATIENCE) == 1, first.said
    assert not any("internal error" in line for line in first.said)
    assert "fault" not in {step["label"] for step in flown.steps("a")}
    assert not vehicle.autopilot.armed
    assert vehicle.autopilot.body.position == pytest.approx((0.0, 0.0, 0.0), abs=AT_HOME)
    vehicle.faults.set_battery(1.0)
    before = len(vehicle.autopilot.track)
    second = flown.start("--resume")
    assert second.end(PATIENCE) == 0, second.said
    assert any(line.startswith("'a': goes on with ") for line in second.said)
    assert any(line.get("what") == "resume" for line in flown.box("a"))
    assert judged(flown) is Outcome.SUCCESS
    again = vehicle.autopilot.track[before:]
    assert min(dist((n, e), TOUR[0][:2]) for _, n, e, _ in again) < 2.0
    assert all(least_distance(vehicle, place) < 2.0 for place in (OUT, *TOUR))


@pytest.mark.parametrize(
    ("system", "why"),
    [pytest.param(7, "was system 1", marks=pytest.mark.thorough), (1, "a pilot may have it")],
)
def test_a_vehicle_that_is_not_the_robots_is_not_touched_by_a_resumed_run(fleet, system, why):
    flown = fleet(Pad("a"))
    killed = flown.start()
    own = begun(flown, "a", "out")
    killed.signal(signal.SIGKILL)
    killed.end(PATIENCE)
    own.stop()
    latitude, longitude = home_of(0)
    settings = Settings("copter", latitude, longitude, system)
    with SimulatedVehicle(int(flown._links["a"].rpartition(":")[2]), settings, speedup=10.0) as other:
        fly_by_hand(other)
        before = dict(other.autopilot.parameters), len(other.autopilot.stores[0])
        resumed = flown.start("--resume")
        assert resumed.end(PATIENCE) == 1, resumed.said
        assert why in resumed.said[-1]
        assert (dict(other.autopilot.parameters), len(other.autopilot.stores[0])) == before
        assert other.autopilot.mode_name == "loiter"


def test_a_vehicle_whose_motors_run_is_not_taken_for_a_new_run(fleet):
    flown = fleet(Pad("a"))
    fly_by_hand(flown.vehicles["a"])
    assert flown.start().end(PATIENCE) == 1
    assert "motors run already" in flown.process.said[-1]
    assert flown.vehicles["a"].autopilot.mode_name == "loiter"


def fly_by_hand(vehicle):
    """Have a pilot take off and loiter with a vehicle."""
    assert wait_for(lambda: vehicle.autopilot.ready, PATIENCE)
    with vehicle.lock:
        pilot = vehicle.autopilot
        pilot.set_mode(pilot.numbers["guided"])
        pilot.arm()
        obey(pilot, TAKE_OFF, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 15.0))
    assert wait_for(lambda: vehicle.autopilot.body.position[2] > 10.0, PATIENCE)
    vehicle.faults.take_stick("loiter")


def test_a_folder_with_logs_is_not_flown_over(fleet, told):
    flown = fleet(Pad("a"))
    flown.logs.mkdir()
    (flown.logs / "a.jsonl").write_text("", "ascii")
    code, said = told(flown)
    assert code == 2
    assert "holds logs already" in said


@pytest.mark.parametrize(
    "words", [("--inject", "foo=1"), ("--connect", "a=foo"), ("--connect", "b=udpin:127.0.0.1:1")]
)
def test_what_makes_no_sense_is_wrong_usage(fleet, told, words):
    flown = fleet(Pad("a"))
    code, said = told(flown, *words)
    assert code == 2, said
    assert words[0] in said
    assert not flown.logs.exists()


def test_a_vehicle_that_is_not_there_is_told_with_its_link(fleet):
    flown = fleet(Pad("a"))
    flown.vehicles["a"].faults.cut_link()
    assert flown.start("--backend-option", "patience=1").end(PATIENCE) == 5
    assert "no vehicle at udpin" in flown.process.said[-1]


def test_faults_on_purpose_are_made_and_the_mission_still_flies(fleet):
    flown = fleet(Pad("a", stay=1.0), speedup=10.0)
    process = flown.start("--inject", "loss=0.1,delay=0.02~0.01,seed=7")
    assert process.end(PATIENCE) == 0, process.said[-6:]
    assert judged(flown) is Outcome.SUCCESS
    assert any(line["kind"] == "injected" for line in flown.box("a"))


def test_simulated_robots_run_by_the_same_command(fleet):
    flown = fleet(*SYNCHRONISED)
    command = [sys.executable, "-m", "mmrs_core", "run", str(flown.behaviour), "--backend", "simulation"]
    command += ["--speedup", "100", "--log", str(flown.logs), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["ending"]["outcome"] == "success"
    assert judged(flown) is Outcome.SUCCESS
