"""Standard conditions in generated controllers: nobody writes them, and robots wait for what they ask."""

from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Transition
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import program

pytestmark = pytest.mark.real_time("controllers")


def choosing(condition, *policies):
    """Return a drone that goes to `a` if a condition holds, else home."""
    drone = robot_program(
        "alpha",
        [take_off("up", 5.0), go_to("a", (0.0, 12.0, 5.0)), LAND],
        transitions={1: Transition(1, 2, condition=condition, otherwise=3)},
    )
    return program(replace(drone, policies=policies))


@pytest.fixture
def chosen(controllers, hangar):
    """Return a function that flies a choice, and gives what the log says was chosen."""

    def flown(condition, battery=1.0, **settings):
        made = controllers(choosing(condition))
        vehicles, links = hangar(made.program, recharge=0.0, **settings)
        vehicles["alpha"].faults.begin("battery", battery)
        code, said = made.run("fleet.py", *links)
        assert code == 0, said
        assert made.replayed().complaints == ()
        return [step.detail for step in read_logs([made.logs]) if step.label == "choose"]

    return flown


@pytest.mark.parametrize(("limit", "chooses"), [("0.5", "false"), ("0.7", "true")])
def test_the_battery_decides(chosen, limit, chooses):
    assert chosen(f"battery-below:{limit}", battery=0.6) == [chooses]


@pytest.mark.parametrize(("limit", "chooses"), [("3", "true"), ("9", "false")])
def test_the_wind_decides(chosen, limit, chooses):
    assert chosen(f"wind-above:{limit}", wind=(6.0, 270.0)) == [chooses]


def test_a_robot_waits_for_an_answer_no_longer_than_its_policy_says(controllers, hangar):
    late = Policy("WAIT_TOO_LONG", "LAND", 5.0)
    made = controllers(choosing("answer:go on?", late))
    _, links = hangar(made.program)
    code, said = made.run("fleet.py", *links)
    assert code == 1
    assert "WAIT_TOO_LONG: waits for answer:go on?" in said
