"""Runs in real time: who is woken by what, and how they begin and end."""

import time
from math import inf

import pytest
from live_runs import FAST, WALK, Script, do

from mmrs_core.behaviour.replay import replay
from mmrs_core.errors import LinkLostError, MmrsError
from mmrs_core.simulation.simulation import SIMULATION
from mmrs_core.testing.small_programs import go, hold, notify, program, robot
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("parts of flights")


def test_simulated_robots_run_in_real_time_too(live):
    behaviour = program(
        robot("a", [go("g", (12, 0, 0), after=(notify("b.s"),))]),
        robot("b", [hold("h", 1.0)], waits={"h": ["s"]}),
    )
    run = live(behaviour, SIMULATION, speedup=FAST)
    assert run.end().outcome is Outcome.SUCCESS
    result = replay(behaviour, run.records)
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_what_ends_while_it_is_looked_at_is_not_missed(live):
    """A movement of a hundredth of a millisecond ends between two looks at the clock."""
    behaviour = program(robot("r", [hold(f"h{number}", 1e-3) for number in range(200)]))
    run = live(behaviour, SIMULATION, speedup=FAST)
    assert run.end().outcome is Outcome.SUCCESS


def test_a_step_follows_the_backends_wake_at_once(live):
    run = live(WALK, Script(walk=0.2))
    run.wait_for_step("r begin walk")
    begun = next(r.time for r in run.records if r.label == "begin" and r.move == "walk")
    run.end()
    ended = next(r.time for r in run.records if r.label == "end" and r.move == "walk")
    assert 0.2 <= ended - begun < 0.2 + 0.5


def test_a_notify_wakes_the_robot_that_waits_for_it(live):
    behaviour = program(
        robot("a", [do("h", after=(notify("b.s"),))]), robot("b", [do("h")], waits={"h": ["s"]})
    )
    run = live(behaviour, Script(h=0.0))
    assert run.end().outcome is Outcome.SUCCESS


def test_no_robot_begins_before_all_are_ready(live):
    behaviour = program(robot("a", [do("h")]), robot("b", [do("h")]))
    run = live(behaviour, Script(ready=inf))
    time.sleep(0.2)
    assert {record.label for record in run.records} <= {"fault"}
    run.script.robots["a"]._finish("ready")
    time.sleep(0.2)
    assert {record.label for record in run.records} <= {"fault"}
    run.script.robots["b"]._finish("ready")
    assert run.end().outcome is Outcome.SUCCESS


@pytest.mark.parametrize(("which", "error"), [("LINK_LOST", LinkLostError), ("REFUSED", MmrsError)])
def test_a_robot_that_does_not_get_ready_ends_the_run_before_anything_moves(live, which, error):
    run = live(program(robot("a", [do("h")]), robot("b", [do("h")])), Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.script.robots["b"].fail(which)
    run.end()
    assert isinstance(run.error, error)
    assert "robot 'b'" in str(run.error)
    assert {record.label for record in run.records} <= {"fault"}
    assert all(each.closed for each in run.script.robots.values())


def test_who_does_not_get_ready_is_in_the_logs_and_the_others_black_boxes_say_why_they_have_not_begun(live):
    logged = []
    behaviour = program(robot("a", [do("h")]), robot("b", [do("h")]))
    run = live(behaviour, Script(ready=inf), observe=logged.append)
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.script.robots["b"].fail("REFUSED")
    run.end()
    (step,) = logged
    assert (step.robot, step.seq, step.label, step.detail) == ("b", 0, "fault", "REFUSED")
    assert replay(behaviour, logged, partial=True).complaints == ()
    (own,), (other,) = run.script.robots["b"].noted, run.script.robots["a"].noted
    assert own == ("decision", {"what": "REFUSED", "why": "says the test", "response": "NOTHING"})
    assert other[1]["what"] == "PEER_LOST"
    assert "'b' did not get ready" in other[1]["why"]


@pytest.mark.parametrize(("armed", "steps"), [(None, 0), (False, 1)])
def test_a_vehicle_that_was_never_heard_may_be_waited_for_again_in_the_same_folder(live, armed, steps):
    logged = []
    run = live(program(robot("a", [do("h")])), Script(ready=inf), observe=logged.append)
    run.wait_for(lambda: len(run.script.robots) == 1)
    run.script.robots["a"].armed = armed
    run.script.robots["a"].fail("LINK_LOST")
    run.end()
    assert isinstance(run.error, LinkLostError)
    assert len(logged) == steps
    assert [each["what"] for _, each in run.script.robots["a"].noted] == ["LINK_LOST"]


def test_a_log_that_cannot_be_written_hides_nothing_of_what_keeps_robots_from_beginning(live):
    def full(record):
        raise OSError(28, "no space left on device")

    run = live(program(robot("a", [do("h")])), Script(ready=inf), observe=full)
    run.wait_for(lambda: len(run.script.robots) == 1)
    run.script.robots["a"].fail("REFUSED")
    run.end()
    assert "robot 'a': does not get ready: says the test" in str(run.error)
    assert "'a': the fault is not in the log: no space left on device" in run.said


def test_a_link_that_is_lost_while_others_get_ready_ends_the_run_before_anything_moves(live):
    run = live(program(robot("a", [do("h")]), robot("b", [do("h")])), Script(ready=inf))
    run.wait_for(lambda: len(run.script.robots) == 2)
    run.script.robots["a"]._finish("ready")
    time.sleep(0.2)
    run.script.robots["a"].fail("LINK_LOST")
    run.end()
    assert "robot 'a': does not get ready" in str(run.error)
    assert {record.label for record in run.records} <= {"fault"}


def test_links_are_closed_at_the_end(live):
    run = live(WALK, Script())
    run.end()
    assert run.script.robots["r"].closed
