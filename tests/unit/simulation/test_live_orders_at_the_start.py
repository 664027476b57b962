"""Orders to robots that are not under way yet, or again."""

import threading
import time
from math import inf

import pytest
from live_runs import TWO, WALK, Script, Walker, do

from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.execution import Fault
from mmrs_core.contributions.vehicles import VehicleFactory
from mmrs_core.errors import LinkLostError
from mmrs_core.testing.small_programs import program, robot
from mmrs_runtime.orders.orders import HOLD, LAND, RESUME, RETURN, STOP
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("parts of flights")


def connected(live, script, **more):
    """Return a run of two robots that are connected, and get ready."""
    run = live(TWO, script, **more)
    run.wait_for(lambda: len(run.script.robots) == 2)
    return run


def test_a_robot_that_is_held_before_anything_moves_stays_until_it_may_go_on(live):
    run = connected(live, Script(ready=0.3))
    standing, order = run.live_run.status_board, run.orders.give(HOLD, ["a"])
    run.wait_for(lambda: standing.status("a")["phase"] == "is held before it begins")
    assert standing.status("b")["phase"] == "waits for its vehicle"
    run.wait_for(lambda: list(order.confirmed) == ["a"])
    run.wait_for(lambda: "b end walk" in run.shown())
    assert standing.status("a")["phase"] == "is held"
    assert "a end walk" not in run.shown()
    run.order(RESUME, "a")
    assert run.end().outcome is Outcome.SUCCESS


def test_a_hold_before_anything_moves_can_be_taken_back(live):
    run = connected(live, Script(ready=0.3))
    assert run.order(RESUME, "a").refused == {"a": "it is not held"}
    run.order(HOLD, "a")
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    assert run.end().outcome is Outcome.SUCCESS


def test_a_robot_that_is_to_come_home_before_it_left_does_not_leave(live):
    run = connected(live, Script(ready=0.3))
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

    run = connected(live, Script(), meet=meet)
    assert list(run.order(RETURN, "a").confirmed) == ["a"]
    assert {record.label for record in run.records} <= {"fault"}
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

    run_of["it"] = run = live(three, VehicleFactory("walker", "a robot of the test", connect_later))
    begun.set()
    assert run.end().faults == {"a": Fault("ORDERED", "order to return")}
    assert answered == [True]


def test_nothing_begins_once_every_robot_was_told_to_stop(live):
    run = connected(live, Script(ready=inf))
    run.orders.give(STOP, ["a"])
    run.orders.give(STOP, ["b"])
    run.end()
    assert isinstance(run.error, KeyboardInterrupt)
    assert {record.label for record in run.records} <= {"fault"}
    assert "stopped before anything moved" in run.said


def test_logs_tell_of_programs_that_were_ended_before_anything_moved(live):
    observed = []
    run = connected(live, Script(ready=inf), observe=observed.append)
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
    run = connected(live, Script(ready=inf), observe=observed.append)
    run.orders.give(STOP, ["a", "b"], interrupt=True)
    run.end()
    assert isinstance(run.error, KeyboardInterrupt)
    assert observed == []


def test_a_hold_is_confirmed_when_the_robot_is_ready_and_not_before(live):
    run = connected(live, Script(ready=inf))
    held = run.orders.give(HOLD, ["a"])
    time.sleep(0.2)
    assert held.open == ("a",)
    run.script.robots["a"]._finish("ready")
    assert held.settled.wait(20.0)
    assert list(held.confirmed) == ["a"]


def test_a_hold_that_is_taken_back_before_the_robot_is_ready_is_refused(live):
    run = connected(live, Script(ready=inf))
    held = run.orders.give(HOLD, ["a"])
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    assert held.refused == {"a": "it is ordered to continue"}


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
    assert {record.label for record in run.records} <= {"fault"}
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

    run = connected(live, Script(ready=inf), meet=meet)
    held = run.orders.give(HOLD, ["a"])
    run.wait_for(lambda: not run.orders.waiting)
    for each in run.script.robots.values():
        each._finish("ready")
    assert run.end().outcome is Outcome.SUCCESS
    assert [list(order.confirmed) for order in (held, *given)] == [["a"], ["a"]]


@pytest.mark.parametrize("kind", [HOLD, RETURN])
def test_orders_are_refused_where_nothing_begins(live, kind):
    run = connected(live, Script(ready=inf))
    run.script.robots["a"].armed = None
    order = run.orders.give(kind, ["a"])
    run.wait_for(lambda: not run.orders.waiting)
    run.script.robots["b"].fail("LINK_LOST")
    run.end()
    assert isinstance(run.error, LinkLostError)
    assert order.refused == {"a": "the run has ended"}
    assert run.order(kind, "a").refused == {"a": "the run has ended"}
