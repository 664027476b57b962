"""Orders and answers to robots whose run goes on in real time."""

from __future__ import annotations

import threading
import time
from math import inf

import pytest
from live_runs import TWO, WALK, Script, Walker, do

from mmrs_core.behaviour.replay import Outcome, replay
from mmrs_core.contributions.backends import BackendFactory
from mmrs_core.contributions.execution import Fault
from mmrs_core.errors import LinkLostError
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
    assert run.order(RESUME, "a").refused == {"a": "it is not held"}
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


def test_a_robot_that_is_there_is_answered_while_others_are_connected(live):
    script, given, answered = Script(), [], []

    def connect(robot_input):
        if robot_input.robot.id == "b":
            given.append(run_of["it"].orders.give(RETURN, ["a"]))
        elif robot_input.robot.id == "c":
            answered.append(given[0].settled.wait(10.0))
        walker = Walker(robot_input, script)
        walker.armed = False
        return walker

    three = program(*(robot(id, [do("walk")]) for id in "abc"))
    begun, run_of = threading.Event(), {}

    def connect_later(robot_input):
        assert begun.wait(10.0)
        return connect(robot_input)

    run_of["it"] = run = live(three, BackendFactory("walker", "a robot of the test", connect_later))
    begun.set()
    assert run.end().faults == {"a": Fault("ORDERED", "order to return")}
    assert answered == [True]


def test_nothing_begins_once_every_robot_was_told_to_stop(live):
    run = live(TWO, Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.orders.give(STOP, ["a"])
    run.orders.give(STOP, ["b"])
    run.end()
    assert isinstance(run.error, KeyboardInterrupt)
    assert run.records == []
    assert "stopped before anything moved" in run.said


def test_logs_tell_of_programs_that_were_ended_before_anything_moved(live):
    observed = []
    run = live(TWO, Script(ready=inf), observe=observed.append)
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.orders.give(RETURN, ["a"])
    run.orders.give(STOP, ["b"])
    run.end()
    assert [(r.robot, r.seq, r.label, r.move, r.detail) for r in observed] == [
        ("a", 0, "fault", "start", "ORDERED"),
        ("b", 0, "fault", "start", "STOPPED"),
    ]
    assert replay(TWO, observed).outcome is Outcome.FAILED


def test_nothing_is_left_of_a_run_that_was_interrupted_before_anything_moved(live):
    observed = []
    run = live(TWO, Script(ready=inf), observe=observed.append)
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.orders.give(STOP, ["a", "b"], interrupt=True)
    run.end()
    assert isinstance(run.error, KeyboardInterrupt)
    assert observed == []


def test_a_hold_is_confirmed_when_the_robot_is_ready_and_not_before(live):
    run = live(TWO, Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    held = run.orders.give(HOLD, ["a"])
    time.sleep(0.2)
    assert held.open == ("a",)
    run.script.robots["a"]._finish("ready")
    assert held.settled.wait(20.0)
    assert list(held.confirmed) == ["a"]


def test_a_hold_that_is_taken_back_before_the_robot_is_ready_is_refused(live):
    run = live(TWO, Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    held = run.orders.give(HOLD, ["a"])
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    assert held.refused == {"a": "it is to go on"}


def test_nobody_begins_together_while_a_robot_is_held(live):
    looks = []

    def meet(look):
        while len(looks) < 20:
            look()
            looks.append(None)
            time.sleep(0.01)
        return {}

    run = live(TWO, Script(), meet=meet)
    run.wait_for(lambda: looks)
    assert list(run.order(HOLD, "a").confirmed) == ["a"]
    before = len(looks)
    time.sleep(0.5)
    assert len(looks) <= before + 1
    assert run.records == []
    run.order(RESUME, "a")
    assert run.end().outcome is Outcome.SUCCESS


def test_a_resumed_robot_that_is_to_land_before_it_goes_on_is_seen_to_land(live):
    first = live(WALK, Script(walk=inf))
    first.wait_for_step("r begin walk")
    made = tuple(first.records)
    run = live(WALK, Script(ready=0.3), resumed=made)
    run.wait_for(lambda: run.script.robots)
    landed = run.orders.give(LAND, ["r"])
    assert run.end().faults == {"r": Fault("ORDERED", "order to land")}
    assert list(landed.confirmed) == ["r"]
    assert run.script.robots["r"].stops == ["LAND"]


def test_what_is_ordered_while_robots_begin_counts_after_what_was_ordered_before(live):
    given = []

    def meet(look):
        given.append(run.orders.give(RESUME, ["a"]))
        return {}

    run = live(TWO, Script(ready=inf), meet=meet)
    run.wait_for(lambda: len(run.script.robots) == 2)
    held = run.orders.give(HOLD, ["a"])
    run.wait_for(lambda: not run.orders.waiting)
    for each in run.script.robots.values():
        each._finish("ready")
    assert run.end().outcome is Outcome.SUCCESS
    assert [list(order.confirmed) for order in (held, *given)] == [["a"], ["a"]]


@pytest.mark.parametrize("kind", [HOLD, RETURN])
def test_orders_are_refused_where_nothing_begins(live, kind):
    run = live(TWO, Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.script.robots["a"].armed = None
    order = run.orders.give(kind, ["a"])
    run.wait_for(lambda: not run.orders.waiting)
    run.script.robots["b"].fail("LINK_LOST")
    run.end()
    assert isinstance(run.error, LinkLostError)
    assert order.refused == {"a": "the run has ended"}
    assert run.order(kind, "a").refused == {"a": "the run has ended"}


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


def test_an_order_is_obeyed_as_soon_as_it_is_known_that_no_pilot_has_the_robot(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].doubted = True
    order = run.orders.give(LAND, ["r"])
    time.sleep(0.2)
    run.script.robots["r"].doubted = False
    assert order.settled.wait(20.0)
    assert list(order.confirmed) == ["r"]
    assert run.script.robots["r"].stops == ["LAND"]


def test_a_hold_is_refused_once_the_robot_may_go_on_before_it_was_seen_to_halt(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].paused = lambda now: False
    held = run.orders.give(HOLD, ["r"])
    assert list(run.order(RESUME).confirmed) == ["r"]
    assert held.settled.wait(20.0)
    assert held.refused == {"r": "resume was ordered since"}


def test_going_on_is_refused_once_the_robot_is_held_again_before_it_was_seen_to_go_on(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    walker = run.script.robots["r"]
    run.order(HOLD)
    walker.resume = lambda now: None
    resumed = run.orders.give(RESUME, ["r"])
    assert list(run.order(HOLD).confirmed) == ["r"]
    assert resumed.settled.wait(20.0)
    assert resumed.refused == {"r": "hold was ordered since"}


def test_a_robot_that_is_named_twice_obeys_once(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    assert list(run.order(HOLD, "r", "r").confirmed) == ["r"]
    assert run.order(RESUME, "r", "r").refused == {}


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


def responding(live, response="RETURN", **seconds):
    """Return a run whose robot carries out a response to a fault."""
    policy = Policy("DEVICE_SILENT", response)
    behaviour = program(robot("r", [do("walk")], policies=(policy,)))
    run = live(behaviour, Script(walk=inf, **seconds))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].fail("DEVICE_SILENT")
    run.wait_for(lambda: run.script.robots["r"].stops == [response])
    return run


def test_a_response_can_be_held_and_gone_on_with(live):
    run = responding(live, stop_RETURN=inf)
    run.script.robots["r"].watched_for = True
    assert list(run.order(HOLD).confirmed) == ["r"]
    assert run.order(HOLD).refused == {}
    assert list(run.order(RESUME).confirmed) == ["r"]
    assert run.script.robots["r"].stops == ["RETURN", "HOLD", "HOLD", "RETURN"]
    assert run.order(RESUME).refused == {"r": "its program has ended"}


def test_a_return_that_was_ordered_and_is_held_is_watched_until_it_goes_on(live):
    run = live(WALK, Script(walk=inf, stop_RETURN=inf))
    run.wait_for_step("r begin walk")
    walker = run.script.robots["r"]
    run.order(RETURN)
    walker.watched_for = True
    assert list(run.order(HOLD).confirmed) == ["r"]
    run.wait_for(lambda: "'r': has done HOLD" in run.said)
    time.sleep(0.3)
    assert run.ending is None
    assert list(run.order(RESUME).confirmed) == ["r"]
    assert walker.stops == ["RETURN", "HOLD", "RETURN"]
    walker.watched_for = False
    walker._finish("stop RETURN")
    assert run.end().faults == {"r": Fault("ORDERED", "order to return")}


def test_a_robot_that_was_stopped_need_not_be_watched_whatever_it_did_before(live):
    run = responding(live, stop_RETURN=inf)
    run.script.robots["r"].watched_for = True
    run.order(HOLD)
    run.order(STOP)
    run.end()
    assert run.script.robots["r"].stops == ["RETURN", "HOLD", "HOLD"]


def test_the_time_in_which_a_robot_is_held_does_not_count_as_waiting(live):
    policy = Policy("WAIT_TOO_LONG", "LAND", 0.6)
    behaviour = program(
        robot("a", [do("h")], waits={"h": ["s"]}, wait_policies={"h": (policy,)}),
        robot("b", [do("walk", after=(notify("a.s"),))]),
    )
    run = live(behaviour, Script(walk=inf))
    run.wait_for_step("a end h")
    run.order(HOLD, "a")
    time.sleep(0.7)
    run.order(RESUME, "a")
    run.script.robots["b"]._finish("walk")
    assert run.end().outcome is Outcome.SUCCESS


def test_a_robot_that_has_landed_elsewhere_does_not_confirm_that_it_returns(live):
    run = responding(live, "LAND", stop_LAND=inf)
    run.script.robots["r"].astray = "it stands 98 m from its home"
    order = run.order(RETURN)
    assert order.refused == {"r": "it stands 98 m from its home"}
    run.end()
    assert "'r': has not done RETURN: it stands 98 m from its home" in run.said


def test_nothing_is_confirmed_by_who_has_come_down_and_has_nothing_left_to_do(live):
    policy = Policy("DEVICE_SILENT", "LAND")
    behaviour = program(robot("a", [do("walk")], policies=(policy,)), robot("b", [do("rest")]))
    run = live(behaviour, Script(walk=inf, rest=inf))
    run.wait_for_step("a begin walk")
    run.script.robots["a"].fail("DEVICE_SILENT")
    run.wait_for(lambda: "'a': has done LAND" in run.said)
    for kind in (RETURN, LAND, HOLD, RESUME):
        assert run.order(kind, "a").refused == {"a": "its program has ended"}


def test_an_order_that_another_has_replaced_is_not_confirmed_by_that(live):
    run = live(WALK, Script(walk=inf, stop_RETURN=inf))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].obeys = lambda now: False
    first = run.orders.give(RETURN, ["r"])
    run.wait_for(lambda: run.script.robots["r"].stops == ["RETURN"])
    last = run.orders.give(LAND, ["r"])
    run.end()
    assert first.refused == {"r": "something else has happened since: LAND"}
    assert list(last.confirmed) == ["r"]


def test_a_robot_whose_link_comes_back_is_waited_for_and_obeys(live):
    run = live(WALK, Script(walk=inf, stop_RETURN=inf))
    run.wait_for_step("r begin walk")
    walker = run.script.robots["r"]
    walker.stop = lambda now, response: None
    walker.heard, walker.watched = False, lambda now: True
    walker.fail("LINK_LOST")
    run.wait_for(lambda: run.records[-1].label == "fault")
    run.wait_for(lambda: any("not known to have stopped" in line for line in run.said))
    assert run.order(LAND).refused == {"r": "its link is lost"}
    del walker.stop, walker.watched
    walker.watched_for, walker.heard, walker.trouble = True, True, None
    run.wait_for(lambda: "'r': is heard again: orders are obeyed" in run.said)
    assert list(run.order(LAND).confirmed) == ["r"]
    walker.watched_for = False
    run.end()


def returning(live):
    """Return a run whose robot was told to stop, and is on its way home when its link is lost."""
    run = live(WALK, Script(walk=inf, stop_RETURN=inf))
    run.orders.on_stop = "RETURN"
    run.wait_for_step("r begin walk")
    walker = run.script.robots["r"]
    run.orders.give(STOP, ["r"])
    run.wait_for(lambda: walker.stops == ["RETURN"])
    walker.watched_for, walker.heard = True, False
    walker.fail("LINK_LOST")
    run.wait_for(lambda: any("not known to have stopped" in line for line in run.said))
    return run, walker


def test_a_robot_that_was_told_to_stop_before_its_link_was_lost_is_listened_for(live):
    run, walker = returning(live)
    walker.heard = True
    run.wait_for(lambda: "'r': is heard again: orders are obeyed" in run.said)
    assert run.order(LAND, "r").confirmed
    walker.watched_for = False
    ending = run.end()
    assert (ending.lost, ending.unconfirmed) == (("r",), ())


def test_a_robot_whose_link_is_lost_is_listened_for_no_longer_once_it_is_to_stop(live):
    run, _ = returning(live)
    assert run.order(STOP, "r").refused == {"r": "its link is lost"}
    ending = run.end()
    assert (ending.lost, ending.unconfirmed) == (("r",), ("r",))


def test_orders_that_make_no_sense_are_refused_with_the_reason(live):
    run = live(WALK, Script(walk=inf))
    run.wait_for_step("r begin walk")
    assert run.order(RESUME).refused == {"r": "it is not held"}
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


def test_people_who_ask_are_told_what_a_robot_does_instead_of_its_program_and_who_has_it(live):
    run = live(WALK, Script(walk=inf, stop_RETURN=inf))
    run.wait_for_step("r begin walk")
    walker, standing = run.script.robots["r"], run.venture.standing
    run.orders.give(RETURN, ["r"])
    run.wait_for(lambda: walker.stops == ["RETURN"])
    told = standing.status("r")
    assert (told["phase"], told["response"]) == ("responds", "RETURN")
    walker.fail("TAKEN_OVER")
    run.wait_for(lambda: walker.stops == ["RETURN", "NOTHING"])
    told = standing.status("r")
    assert (told["phase"], "response" in told) == ("somebody else has it", False)
    run.end()


def test_people_who_ask_are_told_how_robots_are_in_the_words_of_controllers(live):
    behaviour = program(robot("r", [do("h"), do("x")], choices={"h": ("answer:go on?", "x", "stop")}))
    run = live(behaviour, Script(ready=0.3), conditions=standard_conditions(["answer:go on?"]))
    standing = run.venture.standing
    assert standing.status("r")["phase"] == "waits for its vehicle"
    run.wait_for(lambda: "asks" in standing.status("r"))
    assert standing.status("r") == {"phase": "works", "move": "h", "armed": True, "asks": "go on?"}
    run.orders.give("answer", ["r"], question="go on?", answer=True)
    run.end()
    assert standing.status("r")["phase"] == "has ended"
