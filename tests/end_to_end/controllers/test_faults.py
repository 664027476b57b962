import signal
import time
from dataclasses import replace
from functools import partial

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off
from patience import until

from mmrs_core.behaviour.program import Transition
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import move, notify, photo, program
from mmrs_mavlink.sitl.commands import execute
from mmrs_runtime.orders.ordering import give

pytestmark = pytest.mark.real_time("controllers")

BRAKE = 17
LOITER = 5
thorough = partial(pytest.param, marks=pytest.mark.thorough)
"""Values of a test that runs in the full counts only."""

SOON = ("--tries", "2")
"""Has a vehicle asked twice only, so that it is sooner known not to answer."""


def one_drone(*policies: Policy, hold: float = 60.0, **robot):
    moves = [
        take_off("up", 10.0),
        go_to("out", (0.0, 30.0, 12.0)),
        replace(move("stay", "HoldPosition", duration=hold), after=(photo(),)),
        LAND,
    ]
    return program(replace(robot_program("alpha", moves, **robot), policies=policies))


def interrupt_twice(process) -> None:
    """Have a process leave even a vehicle that somebody else has."""
    process.send_signal(signal.SIGINT)
    assert any("interrupt again to end without waiting" in line for line in process.stderr)
    process.send_signal(signal.SIGINT)


def at_work(vehicle):
    return lambda: vehicle.autopilot.body.distance_to((30.0, 0.0, 12.0)) < 1.0


def test_an_interrupted_robot_holds_and_says_so_when_it_does(controllers, hangar):
    made = controllers(one_drone())
    vehicles, links = hangar(made.program)
    with made.start("fleet.py", *links) as process:
        until(at_work(vehicles["alpha"]))
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "'alpha': has done HOLD" in said
    assert vehicles["alpha"].autopilot.mode == BRAKE
    assert vehicles["alpha"].autopilot.body.pace < 0.3
    assert made.replayed(partial=True).faults == {"alpha": "STOPPED"}


@pytest.mark.thorough
def test_a_policy_may_carry_on_without_a_device(controllers, hangar):
    made = controllers(one_drone(Policy("DEVICE_SILENT", "CONTINUE"), hold=1.0))
    _, links = hangar(made.program, silent=frozenset({2000}))
    code, said = made.run("fleet.py", *links, *SOON)
    assert code == 0, said
    assert "carries on" in said
    assert made.replayed().complaints == ()


@pytest.mark.thorough
def test_a_robot_that_holds_is_watched_until_its_link_is_lost(controllers, hangar):
    made = controllers(one_drone(Policy("DEVICE_SILENT", "HOLD"), hold=1.0))
    vehicles, links = hangar(made.program, silent=frozenset({2000}))
    with made.start("fleet.py", *links, *SOON) as process:
        until(lambda: vehicles["alpha"].autopilot.mode == BRAKE)
        vehicles["alpha"].faults.begin("link-down")
        _, said = process.communicate(timeout=60)
    assert process.returncode == 5, said
    assert "not known to have stopped (HOLD): LINK_LOST: the vehicle has been silent" in said


def test_a_robot_that_holds_is_left_to_whoever_takes_over(controllers, hangar):
    made = controllers(one_drone(Policy("DEVICE_SILENT", "HOLD"), hold=1.0))
    vehicles, links = hangar(made.program, silent=frozenset({2000}))
    with made.start("fleet.py", *links, *SOON) as process:
        assert any("has done HOLD" in line for line in process.stderr)
        vehicles["alpha"].faults.begin("stick", "loiter")
        assert any("hands off" in line for line in process.stderr)
        interrupt_twice(process)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    assert "cannot carry out" not in said
    assert vehicles["alpha"].autopilot.mode == LOITER


def test_a_vehicle_far_from_home_does_not_start(controllers, hangar):
    made = controllers(one_drone())
    vehicles, links = hangar(made.program)
    vehicles["alpha"].autopilot.body.position = (500.0, 0.0, 0.0)
    code, said = made.run("fleet.py", *links)
    assert code == 1
    assert "m from the home of its program" in said
    assert not vehicles["alpha"].autopilot.armed


def test_a_vehicle_that_is_never_there_is_a_lost_link(controllers):
    made = controllers(one_drone())
    code, said = made.run("fleet.py", "--patience", "0.5", "--connect", "alpha=udpin:127.0.0.1:0")
    assert code == 5
    assert "no vehicle at" in said


def waiting_pair(*policies: Policy):
    giver = robot_program("alpha", [take_off("up", 10.0), go_to("out", (0.0, 30.0, 10.0)), LAND])
    taker = robot_program(
        "beta",
        [take_off("up", 10.0), LAND],
        home=(50.0, 0.0, 0.0),
        slots=("go",),
        transitions={1: Transition(1, 2, waits=("go",))},
    )
    notified = replace(giver.moves[2], after=(notify(("beta", "go")),))
    moves = (*giver.moves[:2], notified, *giver.moves[3:])
    return program(replace(giver, moves=moves), replace(taker, policies=policies))


def test_a_robot_whose_peer_fails_responds_to_it(controllers, hangar):
    made = controllers(waiting_pair(Policy("PEER_LOST", "LAND", 5.0)))
    vehicles, links = hangar(made.program)
    with made.start("fleet.py", *links) as process:
        until(lambda: vehicles["alpha"].autopilot.body.position[0] > 5.0)
        vehicles["alpha"].faults.begin("stick", "loiter")
        assert any("'beta': has done LAND" in line for line in process.stderr)
        interrupt_twice(process)
        process.communicate(timeout=60)
    assert process.returncode == 130
    assert not vehicles["beta"].autopilot.armed
    assert made.replayed(partial=True).faults["beta"] == "PEER_LOST"


@pytest.mark.parametrize("command", [22, *map(thorough, (400, 176))])
def test_a_vehicle_that_refuses_is_a_fault(controllers, hangar, command):
    made = controllers(one_drone())
    _, links = hangar(made.program, refuse=frozenset({command}))
    code, said = made.run("fleet.py", *links)
    assert code == 1
    assert "REFUSED" in said


def test_a_program_that_crashes_leaves_its_robot_holding(controllers, hangar):
    made = controllers(one_drone(hold=5.0))
    fleet = made.folder / "fleet.py"
    breaks = (
        "from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle\n\nMavlinkVehicle.operate = None\n"
    )
    fleet.write_text(fleet.read_text("utf-8").replace("if __name__", f"{breaks}if __name__"), "utf-8")
    vehicles, links = hangar(made.program)
    with made.start("fleet.py", *links) as process:
        until(lambda: vehicles["alpha"].autopilot.mode == BRAKE)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "CRASHED" in said
    assert made.replayed(partial=True).faults == {"alpha": "CRASHED"}


def test_stop_before_there_is_a_vehicle_ends_the_program(controllers):
    made = controllers(one_drone())
    with made.start("fleet.py", "--connect", "alpha=udpin:127.0.0.1:0") as process:
        assert any("waits for a vehicle" in line for line in process.stderr)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
    assert process.returncode == 130


@pytest.mark.parametrize(
    ("fault", "mode", "policy"),
    [
        ("gps-lost", "altitude_hold", Policy("POSITION_LOST", "LAND")),
        thorough("gps-lost", "stabilize", Policy("POSITION_LOST", "LAND", 5.0)),
        thorough("obstacle", "loiter", Policy("OBSTACLE", "HOLD", 10.0)),
    ],
)
def test_a_pilot_who_takes_over_because_of_a_fault_keeps_the_vehicle(
    controllers, hangar, fault, mode, policy
):
    made = controllers(one_drone(policy))
    vehicles, links = hangar(made.program, speedup=5.0)
    with made.start("fleet.py", *links) as process:
        until(at_work(vehicles["alpha"]))
        vehicles["alpha"].faults.begin(fault)
        time.sleep(0.1)
        vehicles["alpha"].faults.begin("stick", mode)
        changes = len(vehicles["alpha"].autopilot.modes)
        assert any("hands off" in line for line in process.stderr)
        time.sleep(1.0)
        interrupt_twice(process)
        process.communicate(timeout=60)
    assert len(vehicles["alpha"].autopilot.modes) == changes
    assert made.replayed(partial=True).faults == {"alpha": "TAKEN_OVER"}


@pytest.mark.parametrize("airborne", [True, thorough(False)])
def test_a_vehicle_that_somebody_else_has_is_told_nothing(controllers, hangar, airborne):
    made = controllers(one_drone())
    vehicles, links = hangar(made.program, parameters={"DISARM_DELAY": 1000.0})
    foreign = vehicles["alpha"].autopilot
    until(lambda: foreign.ready)
    with vehicles["alpha"].lock:
        foreign.set_mode(foreign.numbers["guided"])
        foreign.arm()
        if airborne:
            execute(foreign, 22, (*[0.0] * 6, 20.0))
    if airborne:
        until(lambda: foreign.body.position[2] > 15.0)
    parameters = dict(foreign.parameters)
    code, said = made.run("fleet.py", *links)
    assert code == 1
    assert "does not get ready: the vehicle is armed already: it is under external control" in said
    assert (foreign.armed, foreign.stores[0]) == (True, [])
    assert foreign.parameters == parameters


def test_a_vehicle_that_has_fallen_is_not_armed_again(controllers, hangar):
    made = controllers(one_drone(hold=10.0))
    vehicles, links = hangar(made.program, speedup=5.0)
    alpha = vehicles["alpha"]
    with made.start("fleet.py", *links) as process:
        until(at_work(alpha))
        with alpha.lock:
            alpha.autopilot.disarm()
        fallen = alpha.autopilot.time
        _, said = process.communicate(timeout=60)
    assert process.returncode == 1, said
    assert made.replayed(partial=True).faults == {"alpha": "MOTORS_OFF"}
    assert 400 not in [command for seconds, command, _ in alpha.autopilot.history if seconds > fallen]


def test_a_battery_that_was_not_changed_is_not_flown_with(controllers, hangar):
    made = controllers(one_drone(Policy("BATTERY_LOW", "RETURN")))
    vehicles, links = hangar(made.program, recharge=1e9)
    with made.start("fleet.py", *links, "--battery-patience", "60") as process:
        until(at_work(vehicles["alpha"]))
        vehicles["alpha"].faults.begin("battery", 0.15)
        assert any("came home for its battery" in line for line in process.stderr)
        (told,) = give(made.logs, "resume", ["alpha"])
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    assert not told["confirmed"]
    assert "its battery is still at 1" in told["why"]
    assert not vehicles["alpha"].autopilot.armed
