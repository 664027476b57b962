"""Charging, and batteries that say nothing."""

import time
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, robot_program, take_off

from mmrs_core.scene import Policy
from mmrs_core.testing.programs import move, program

pytestmark = pytest.mark.real_time("controllers")

TAKE_OFF = 22


def two_sorties(*policies: Policy, charge: float = 20.0):
    moves = [
        take_off("up", 5.0),
        LAND,
        move("charge", "Recharge", duration=charge),
        take_off("again", 5.0),
        replace(LAND, id="home"),
    ]
    made = program(replace(robot_program("alpha", moves), policies=policies))
    return replace(made, reserve=0.0)


def run_and_empty(made, vehicle, links):
    """Run the fleet; the battery is found empty when the robot has landed."""
    with made.start("fleet.py", *links) as process:
        while not (take_offs(vehicle) and not vehicle.autopilot.armed):
            assert process.poll() is None
            time.sleep(0.01)
        time.sleep(0.3)
        vehicle.faults.begin("battery", 0.0)
        _, said = process.communicate(timeout=60)
    return process.returncode, said


def take_offs(vehicle) -> int:
    return sum(command == TAKE_OFF for _, command, _ in vehicle.autopilot.history)


def test_a_battery_that_stays_empty_is_not_taken_for_a_full_one(controllers, hangar):
    made = controllers(two_sorties(charge=20.0))
    vehicles, links = hangar(made.program, recharge=1e9)
    code, said = run_and_empty(made, vehicles["alpha"], links)
    assert code == 1, said
    assert "BATTERY_LOW: after" in said
    assert "of charging the battery is at 0%" in said
    assert take_offs(vehicles["alpha"]) == 1


@pytest.mark.thorough
def test_a_policy_may_carry_on_with_what_was_charged(controllers, hangar):
    made = controllers(two_sorties(Policy("BATTERY_LOW", "CONTINUE")))
    vehicles, links = hangar(made.program, energy=100.0, recharge=1e9)
    code, said = made.run("fleet.py", *links)
    assert code == 0, said
    assert "carries on although after" in said
    assert take_offs(vehicles["alpha"]) == 2


def test_charging_goes_on_until_the_battery_is_full(controllers, hangar):
    made = controllers(two_sorties(charge=30.0))
    vehicles, links = hangar(made.program, speedup=15.0, recharge=50.0)
    code, said = run_and_empty(made, vehicles["alpha"], links)
    assert code == 0, said
    begun, ended, *_ = (step["time"] for step in made.steps("alpha") if step["move"] == "charge")
    assert ended - begun > 40.0


@pytest.mark.thorough
def test_a_robot_that_does_not_know_its_battery_says_so_and_charges_as_long_as_expected(controllers, hangar):
    made = controllers(two_sorties())
    vehicles, links = hangar(made.program, tells_battery=False)
    code, said = made.run("fleet.py", *links)
    assert code == 0, said
    assert said.count("does not tell its battery") == 1
    assert "charging: charged for 20 s; its range is unknown" in said
    assert take_offs(vehicles["alpha"]) == 2
