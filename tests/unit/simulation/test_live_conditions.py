"""Functions of users decide choices in threads of their own: whatever they do, the run goes on."""

import threading
import time
from math import inf

import pytest
from live_runs import Script, do

from mmrs_core.testing.small_programs import program, robot
from mmrs_runtime.engine import decisions as judging
from mmrs_runtime.orders.orders import HOLD, RETURN
from mmrs_runtime.semantics import Outcome
from mmrs_runtime.vehicle import Condition

pytestmark = pytest.mark.real_time("parts of flights")

CHOOSES = robot("r", [do("h"), do("x"), do("y")], choices={"h": ("sunny", "x", "y")})
OTHER = robot("other", [do("walk"), do("rest")])


@pytest.fixture
def asked(live):
    """Return a function that runs a robot whose choice a function decides, beside another robot."""
    release = threading.Event()

    def ask(holds, **seconds):
        def waits(state):
            return holds(release)

        conditions = {"sunny": Condition("sunny", waits)}
        return live(program(CHOOSES, OTHER), Script(**seconds), conditions=conditions)

    yield ask
    release.set()


def hangs(release) -> bool:
    release.wait(30.0)
    return True


def test_an_answer_is_heard_as_soon_as_it_is_there(asked):
    def thinks(release):
        time.sleep(0.3)
        return True

    run = asked(thinks)
    assert run.end().outcome is Outcome.SUCCESS
    steps = {f"{each.label} {each.move}": each.time for each in run.records if each.robot == "r"}
    assert "r choose h true" in run.shown()
    assert 0.29 < steps["choose h"] - steps["end h"] < 0.6
    assert not [line for line in run.said if "sunny" in line]


def test_robots_obey_while_a_function_hangs(asked):
    run = asked(hangs, walk=inf)
    run.wait_for_step("r end h")
    run.wait_for_step("other begin walk")
    begun = time.monotonic()
    run.order(HOLD)
    run.order(RETURN)
    assert time.monotonic() - begun < 1.0
    assert run.script.robots["r"].stops == run.script.robots["other"].stops == ["RETURN"]
    run.end()


def test_a_function_that_does_not_answer_in_time_is_a_fault(asked, monkeypatch):
    monkeypatch.setattr(judging, "ANSWER_SECONDS", 0.3)
    ending = asked(hangs).end()
    assert str(ending.faults["r"]) == "CONDITION_FAILED: condition 'sunny' has not answered for 0.3 s"
    assert "other" not in ending.faults


def test_a_function_that_fails_is_a_fault(asked):
    def fails(release):
        return 1 / 0

    fault = asked(fails).end().faults["r"]
    assert str(fault) == "CONDITION_FAILED: condition 'sunny' fails: ZeroDivisionError: division by zero"


def test_what_nobody_can_know_yet_is_asked_again_and_told_once(live):
    seen = []

    def known(state):
        seen.append(time.monotonic())
        return len(seen) > 3

    run = live(
        program(CHOOSES), Script(), conditions={"sunny": Condition("sunny", lambda state: False, known)}
    )
    assert run.end().outcome is Outcome.SUCCESS
    assert len(seen) == 4
    assert seen[3] - seen[0] > 0.1
    assert "r choose h false" in run.shown()
    assert len([line for line in run.said if "sunny" in line]) == 1


def test_people_are_told_that_a_function_takes_its_time(asked, monkeypatch):
    monkeypatch.setattr(judging, "SLOW_SECONDS", 0.1)
    monkeypatch.setattr(judging, "ANSWER_SECONDS", 0.6)
    run = asked(hangs)
    run.end()
    assert next(line for line in run.said if "sunny" in line) == "'r': waits until 'sunny' is known"
