"""Answers to robots whose run goes on in real time, and what people are told of them."""

import time
from math import inf

import pytest
from live_runs import Script, do, walking

from mmrs_core.contributions.execution import Fault
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import program, robot
from mmrs_runtime.engine.decisions import standard_conditions
from mmrs_runtime.orders.orders import RETURN
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("parts of flights")


def test_an_answer_that_comes_before_the_question_counts(live):
    behaviour = program(robot("r", [do("h"), do("x")], choices={"h": ("answer:q", "x", "stop")}))
    run = live(behaviour, Script(ready=0.3), conditions=standard_conditions(["answer:q"]))
    run.wait_for(lambda: run.script.robots)
    run.orders.give("answer", ["r"], question="q", answer=True)
    assert run.end().outcome is Outcome.SUCCESS
    assert "r choose h true" in run.shown()


def test_a_question_waits_for_the_operators_answer(live):
    behaviour = program(robot("r", [do("h"), do("x"), do("y")], choices={"h": ("answer:go left?", "x", "y")}))
    run = live(behaviour, Script(), conditions=standard_conditions(["answer:go left?"]))
    run.wait_for_step("r end h")
    time.sleep(0.2)
    assert "r choose h true" not in run.shown()
    run.orders.give("answer", ["r"], question="go left?", answer=False)
    assert run.end().outcome is Outcome.SUCCESS
    assert "r choose h false" in run.shown()


def test_a_choice_that_comes_round_again_asks_again(live):
    behaviour = program(robot("r", [do("h"), do("x")], choices={"h": ("answer:again", "h", "x")}))
    run = live(behaviour, Script(), conditions=standard_conditions(["answer:again"]))
    for lap in (1, 2):
        run.wait_for(lambda lap=lap: run.said.count("'r': waits for an answer to 'again'") == lap)
        assert run.shown().count("r choose h true") == lap - 1
        run.orders.give("answer", ["r"], question="again", answer=True)
    run.wait_for(lambda: run.said.count("'r': waits for an answer to 'again'") == 3)
    run.orders.give("answer", ["r"], question="again", answer=False)
    assert run.end().outcome is Outcome.SUCCESS
    assert run.shown().count("r choose h true") == 2


def test_an_answer_to_a_question_that_no_choice_asks_is_refused(live):
    behaviour = program(robot("r", [do("h"), do("x")], choices={"h": ("answer:go on?", "x", "stop")}))
    run = live(behaviour, Script(), conditions=standard_conditions(["answer:go on?"]))
    run.wait_for_step("r end h")
    order = run.orders.give("answer", ["r"], question="go on", answer=True)
    assert order.settled.wait(20.0)
    assert order.refused == {"r": "no choice asks 'go on'; there is 'go on?'"}
    run.orders.give("answer", ["r"], question="go on?", answer=True)
    assert run.end().outcome is Outcome.SUCCESS


def test_a_question_nobody_answers_ends_by_the_policy_of_long_waits(live):
    policy = Policy("WAIT_TOO_LONG", "LAND", 0.2)
    behaviour = program(
        robot(
            "r", [do("h"), do("x")], choices={"h": ("answer:q", "x", "stop")}, wait_policies={"h": (policy,)}
        )
    )
    run = live(behaviour, Script(), conditions=standard_conditions(["answer:q"]))
    assert run.end().faults["r"] == Fault("WAIT_TOO_LONG", "waits for answer:q")


def test_people_who_ask_are_told_what_a_robot_does_instead_of_its_program_and_who_has_it(live):
    run, walker = walking(live, stop_RETURN=inf)
    standing = run.live_run.status_board
    run.orders.give(RETURN, ["r"])
    run.wait_for(lambda: walker.stops == ["RETURN"])
    told = standing.status("r")
    assert (told["phase"], told["response"]) == ("responds", "RETURN")
    walker.fail("TAKEN_OVER")
    run.wait_for(lambda: walker.stops == ["RETURN", "NOTHING"])
    told = standing.status("r")
    assert (told["phase"], "response" in told) == ("under external control", False)
    run.end()


def test_people_who_ask_are_told_how_robots_are_in_the_words_of_controllers(live):
    behaviour = program(robot("r", [do("h"), do("x")], choices={"h": ("answer:go on?", "x", "stop")}))
    run = live(behaviour, Script(ready=0.3), conditions=standard_conditions(["answer:go on?"]))
    standing = run.live_run.status_board
    assert standing.status("r")["phase"] == "waits for its vehicle"
    run.wait_for(lambda: "asks" in standing.status("r"))
    status = dict(standing.status("r"))
    assert 0.0 < status.pop("time") < 20.0
    assert status == {"phase": "works", "move": "h", "step": "end", "armed": True, "asks": "go on?"}
    run.orders.give("answer", ["r"], question="go on?", answer=True)
    run.end()
    assert standing.status("r")["phase"] == "has ended"
