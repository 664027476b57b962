"""Orders and answers to robots whose run goes on in real time."""

from __future__ import annotations

import threading
import time
from math import inf

import pytest
from live_runs import TWO, WALK, Script, do

from mmrs_core.behaviour.replay import Outcome, replay
from mmrs_core.contributions.execution import Fault
from mmrs_core.runtime.conditions import standard_conditions
from mmrs_core.runtime.orders import HOLD, LAND, RESUME, RETURN, STOP
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import notify, program, robot


def test_a_robot_that_is_held_before_anything_moves_stays_until_it_may_go_on(live):
    run = live(TWO, Script(ready=0.3))
    run.wait_for(lambda: len(run.script.robots) == 2)
    assert list(run.order(HOLD, "a").confirmed) == ["a"]
    run.wait_for(lambda: "b end walk" in run.shown())
    assert "a end walk" not in run.shown()
    run.order(RESUME, "a")
    assert run.end().outcome is Outcome.SUCCESS


def test_a_hold_before_anything_moves_can_be_taken_back(live):
    run = live(TWO, Script(ready=0.3))
    run.wait_for(lambda: len(run.script.robots) == 2)
    assert run.order(RESUME, "a").refused == {"a": "has nothing to resume"}
    run.order(HOLD, "a")
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    assert run.end().outcome is Outcome.SUCCESS


def test_a_robot_that_is_to_come_home_before_it_left_does_not_leave(live):
    run = live(TWO, Script(ready=0.3))
    run.wait_for(lambda: len(run.script.robots) == 2)
    assert list(run.order(RETURN, "a").confirmed) == ["a"]
    assert run.end().faults == {"a": Fault("ORDERED", "order to return")}
    assert "a begin walk" not in run.shown()
    assert "b end walk" in run.shown()


def test_orders_while_robots_of_other_processes_are_waited_for_end_nothing_else(live):
    met = threading.Event()

    def meet(look):
        while not met.wait(0.01):
            look()
        return {}

    run = live(TWO, Script(), meet=meet)
    run.wait_for(lambda: len(run.script.robots) == 2)
    assert list(run.order(RETURN, "a").confirmed) == ["a"]
    assert run.records == []
    met.set()
    assert run.end().faults == {"a": Fault("ORDERED", "order to return")}
    assert "b end walk" in run.shown()


def test_nothing_begins_once_every_robot_was_told_to_stop(live):
    run = live(TWO, Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.orders.give(STOP, ["a"])
    run.orders.give(STOP, ["b"])
    run.end()
    assert isinstance(run.error, KeyboardInterrupt)
    assert run.records == []
    assert "stopped before anything moved" in run.said


def test_an_answer_that_comes_before_the_question_counts(live):
    behaviour = program(robot("r", [do("h"), do("x")], choices={"h": ("answer:q", "x", "stop")}))
    run = live(behaviour, Script(ready=0.3), conditions=standard_conditions(["answer:q"]))
    run.wait_for(lambda: run.script.robots)
    run.orders.give("answer", ["r"], question="q", answer=True)
    assert run.end().outcome is Outcome.SUCCESS
    assert "r choose h true" in run.shown()


@pytest.mark.parametrize(
    ("kind", "response", "fault"),
    [(STOP, "HOLD", "STOPPED"), (RETURN, "RETURN", "ORDERED"), (LAND, "LAND", "ORDERED")],
)
def test_an_order_ends_the_program_and_is_confirmed(live, kind, response, fault):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    order = run.order(kind)
    assert run.end().outcome is Outcome.FAILED
    assert list(order.confirmed) == ["r"]
    assert run.script.robots["r"].stops == [response]
    assert (run.records[-1].label, run.records[-1].detail) == ("fault", fault)


@pytest.mark.parametrize("kind", [HOLD, RESUME, LAND, STOP])
def test_no_order_is_obeyed_while_nobody_knows_whether_a_pilot_has_the_robot(live, kind):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    walker = run.script.robots["r"]
    walker.doubted = True
    order = run.orders.give(kind, ["r"])
    time.sleep(0.2)
    assert not walker.halted
    assert walker.stops == []
    walker.fail("TAKEN_OVER")
    walker.doubted = False
    assert order.settled.wait(20.0)
    assert list(order.confirmed) == []
    assert walker.stops == ["NOTHING"]


def test_a_robot_that_waits_for_slots_obeys_too(live):
    behaviour = program(
        robot("a", [do("h")], waits={"h": ["s"]}), robot("b", [do("walk", after=(notify("a.s"),))])
    )
    run = live(behaviour, Script(walk=inf))
    run.wait_for_step("a end h")
    assert list(run.order(LAND, "a").confirmed) == ["a"]


def test_a_robot_that_holds_makes_no_step_and_then_goes_on(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    assert list(run.order(HOLD).confirmed) == ["r"]
    run.script.robots["r"]._finish("walk")
    time.sleep(0.2)
    assert "r end walk" not in run.shown()
    assert list(run.order(RESUME).confirmed) == ["r"]
    assert run.end().outcome is Outcome.SUCCESS
    assert replay(WALK, run.records).accepted


def test_orders_that_make_no_sense_are_refused_with_the_reason(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    assert run.order(RESUME).refused == {"r": "has nothing to resume"}
    assert run.order(HOLD, "somebody").refused == {"somebody": "no such robot here"}


def test_orders_that_come_too_late_are_refused(live):
    run = live(WALK, Script())
    run.end()
    assert run.order(HOLD).refused == {"r": "the run has ended"}


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
            "r",
            [do("h"), do("x")],
            choices={"h": ("answer:q", "x", "stop")},
            wait_policies={"h": (policy,)},
        )
    )
    run = live(behaviour, Script(), conditions=standard_conditions(["answer:q"]))
    assert run.end().faults["r"] == Fault("WAIT_TOO_LONG", "waits for answer:q")


def test_people_who_ask_are_told_how_robots_are_in_the_words_of_controllers(live):
    behaviour = program(robot("r", [do("h"), do("x")], choices={"h": ("answer:go on?", "x", "stop")}))
    run = live(behaviour, Script(ready=0.3), conditions=standard_conditions(["answer:go on?"]))
    standing = run.venture.standing
    assert standing.status("r") == {"phase": "waits for its vehicle"}
    run.wait_for(lambda: "asks" in standing.status("r"))
    assert standing.status("r") == {"phase": "works", "move": "h", "asks": "go on?"}
    run.orders.give("answer", ["r"], question="go on?", answer=True)
    run.end()
    assert standing.status("r")["phase"] == "has ended"
