"""Runs in real time that are broken off, for a battery or for good, and go on."""

import time
from dataclasses import replace
from math import inf

import pytest
from live_runs import TWO, WALK, Script, do

from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.execution import Fault
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import Policy
from mmrs_core.simulation.live import live_run_for, run_live
from mmrs_core.simulation.run import inputs_of
from mmrs_core.testing.small_programs import ROBOT_TYPE, notify, program, robot, robot_type
from mmrs_runtime.engine.resuming import restore
from mmrs_runtime.orders.orders import HOLD, LAND, RESUME, RETURN, STOP
from mmrs_runtime.semantics import Outcome
from mmrs_runtime.slots import LocalSlots

pytestmark = pytest.mark.real_time("parts of flights")

LOW = (Policy("BATTERY_LOW", "RETURN"),)


SURVEY = program(
    robot("a", [do("one"), do("two", after=(notify("b.s"),)), do("three")], policies=LOW),
    robot("b", [do("h")], waits={"h": ["s"]}),
)


ALONE = program(robot("a", [do("one"), do("two"), do("three")], policies=LOW))


def suspended(live, behaviour=SURVEY, **more):
    run = live(behaviour, Script(two=inf), **more)
    run.wait_for_step("a begin two")
    run.script.robots["a"].fail("BATTERY_LOW")
    return run


def killed(live):
    """Return the steps of a run whose process was killed when `a` had come home and `b` waited for it."""
    run = suspended(live)
    run.wait_for_step("b end h")
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    return tuple(run.records)


def test_a_low_battery_breaks_the_program_off_without_a_fault_in_the_log(live):
    run = suspended(live, ALONE)
    ending = run.end()
    assert ending.suspended == ("a",)
    assert ending.came_down == {"a": "came home for its battery"}
    assert ending.responses["a"] == "RETURN"
    assert ending.outcome is Outcome.INCOMPLETE
    assert run.script.robots["a"].stops == ["RETURN"]
    assert all(record.label != "fault" for record in run.records)
    assert replay(ALONE, run.records, partial=True).accepted


def test_where_a_robot_came_down_for_its_battery_is_told_by_what_happened(live):
    run = live(ALONE, Script(two=inf))
    run.wait_for_step("a begin two")
    run.script.robots["a"].astray = "it stands 30 m from its home: carry it home"
    run.script.robots["a"].fail("BATTERY_LOW")
    words = "came down for its battery, but it stands 30 m from its home: carry it home"
    assert run.end().came_down == {"a": words}
    assert (
        f"'a': {words}; change it, order battery-changed if its charge does not rise, then resume,"
        " or start again with --resume"
    ) in run.said


def test_a_robot_whose_sortie_began_away_from_home_came_down_there(live):
    run = live(ALONE, Script(two=inf))
    run.wait_for_step("a begin two")
    run.script.robots["a"].elsewhere = "it stands 30 m from its home: carry it home"
    run.script.robots["a"].fail("BATTERY_LOW")
    words = "came down for its battery where its sortie began, away from home"
    assert run.end().came_down == {"a": words}


def test_a_robot_that_is_not_known_to_have_come_down_is_not_told_to_have(live):
    run = live(ALONE, Script(two=inf, stop_RETURN=inf))
    run.wait_for_step("a begin two")
    run.script.robots["a"].fail("BATTERY_LOW")
    walker, noted = run.script.robots["a"], []
    walker.note = lambda kind, content: noted.append((kind, *content.values()))
    run.wait_for(lambda: walker.stops == ["RETURN"])
    walker.fail("NO_PROGRESS")
    ending = run.end()
    why = "RETURN cannot be carried out: says the test"
    assert noted[-1] == ("decision", "NO_PROGRESS", why, "NOTHING")
    assert (ending.suspended, ending.unconfirmed, dict(ending.came_down)) == (("a",), ("a",), {})


def test_a_robot_that_confirms_a_later_order_counts_as_stopped(live):
    run = live(TWO, Script(walk=inf, stop_HOLD=inf))
    run.wait_for_step("a begin walk")
    run.wait_for_step("b begin walk")
    walker = run.script.robots["a"]
    walker.fail("LINK_LOST")
    run.wait_for(lambda: walker.stops == ["HOLD"])
    walker.fail("NO_PROGRESS")
    run.wait_for(lambda: any("not known to have stopped" in line for line in run.said))
    walker.watched_for, walker.trouble = True, None
    assert run.order(LAND, "a").confirmed
    run.wait_for(lambda: "'a': has done LAND" in run.said)
    walker.watched_for = False
    run.order(LAND, "b")
    assert run.end().unconfirmed == ()


def test_a_low_battery_that_is_answered_in_the_air_is_a_fault(live):
    behaviour = program(robot("r", [do("walk")], policies=(Policy("BATTERY_LOW", "HOLD"),)))
    run = live(behaviour, Script(walk=inf))
    run.wait_for_step("r begin walk")
    run.script.robots["r"].fail("BATTERY_LOW")
    assert run.end().faults["r"].which == "BATTERY_LOW"


def test_a_changed_battery_lets_the_program_go_on_in_the_same_process(live):
    run = suspended(live, patience=20.0)
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    run.script.seconds["two"] = 0.0
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    assert run.end().outcome is Outcome.SUCCESS
    assert run.script.robots["a"].recovered == (("start", "one"), "two")
    assert replay(SURVEY, run.records).accepted


def test_a_robot_whose_battery_got_low_while_it_was_held_goes_on_with_its_program(live):
    run = live(SURVEY, Script(two=inf), patience=20.0)
    run.wait_for_step("a begin two")
    assert run.order(HOLD, "a").confirmed
    run.script.robots["a"].fail("BATTERY_LOW")
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    run.script.seconds["two"] = 0.0
    assert run.order(RESUME, "a").confirmed
    assert run.end().outcome is Outcome.SUCCESS


def test_a_robot_that_still_comes_down_for_its_battery_does_not_go_on(live):
    run = live(SURVEY, Script(two=inf, stop_RETURN=inf), patience=20.0)
    run.wait_for_step("a begin two")
    run.script.robots["a"].fail("BATTERY_LOW")
    run.wait_for(lambda: run.script.robots["a"].stops == ["RETURN"])
    assert run.order(RESUME, "a").refused == {"a": "has still to do RETURN"}
    assert run.script.robots["a"].recovered is None


def test_a_battery_that_was_not_changed_is_told_and_nothing_moves(live):
    run = suspended(live, patience=20.0)
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    run.script.charge = 0.15
    assert run.order(RESUME, "a").refused == {"a": "its battery is still at 15%"}
    assert run.script.robots["a"].recovered is None


def test_a_resume_is_confirmed_when_the_motors_run_and_not_only_when_the_way_back_was_flown(live):
    run = suspended(live, patience=20.0)
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    run.script.seconds["recovered"] = inf
    walker = run.script.robots["a"]
    walker.armed = False
    order = run.orders.give(RESUME, ["a"])
    run.wait_for(lambda: walker.recovered is not None)
    time.sleep(0.2)
    assert order.open == ("a",)
    walker.armed = True
    assert order.settled.wait(20.0)
    assert list(order.confirmed) == ["a"]
    assert walker.begun[-1] == "recovered"


@pytest.mark.parametrize(("kind", "response"), [(HOLD, "HOLD"), (LAND, "LAND"), (RETURN, "RETURN")])
def test_a_robot_that_failed_to_come_down_for_its_battery_obeys_in_the_air(live, kind, response):
    run = live(SURVEY, Script(two=inf, stop_RETURN=inf), patience=20.0)
    run.wait_for_step("a begin two")
    walker = run.script.robots["a"]
    walker.fail("BATTERY_LOW")
    run.wait_for(lambda: walker.stops == ["RETURN"])
    walker.fail("CRASHED")
    run.wait_for(lambda: any("not known to have stopped" in line for line in run.said))
    assert list(run.order(kind, "a").confirmed) == ["a"]
    assert walker.stops == ["RETURN", response]


@pytest.mark.parametrize("kind", [HOLD, LAND, RETURN])
def test_a_robot_that_came_down_stands_also_where_its_motors_are_not_said_to_be_off(live, kind):
    run = suspended(live, patience=20.0)
    walker = run.script.robots["a"]
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    assert walker.armed
    assert list(run.order(kind, "a").confirmed) == ["a"]
    assert walker.stops == ["RETURN"]
    assert run.order(RESUME, "a").confirmed


@pytest.mark.parametrize("kind", [HOLD, LAND, RETURN, RESUME])
def test_nothing_is_obeyed_on_the_ground_while_somebody_else_has_started_the_motors(live, kind):
    run = live(SURVEY, Script(two=inf), patience=20.0)
    run.wait_for_step("a begin two")
    walker = run.script.robots["a"]
    walker.armed = False
    walker.fail("BATTERY_LOW")
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    walker.armed = True
    assert run.order(kind, "a").refused == {"a": "it is armed: the vehicle is under external control"}
    assert walker.stops == ["RETURN"]


def test_robots_that_wait_for_one_whose_battery_is_changed_are_not_left_alone(live):
    run = suspended(live)
    run.wait_for(lambda: any("nothing continues without an order" in line for line in run.said))
    assert any("'b' waits after 'h' for 's'" in line for line in run.said)
    time.sleep(0.2)
    assert run.script.robots["b"].stops == []
    run.script.seconds["two"] = 0.0
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    ending = run.end()
    assert (ending.outcome, ending.waiting) == (Outcome.SUCCESS, ())


def test_robots_in_the_air_that_nobody_will_ever_free_are_not_left_alone(live):
    behaviour = program(robot("a", [do("h")], waits={"h": ["s"]}), robot("b", [do("walk")], policies=LOW))
    run = live(behaviour, Script())
    run.wait_for(lambda: any("nothing continues without an order" in line for line in run.said))
    assert list(run.order(LAND, "a").confirmed) == ["a"]
    assert [each.robot for each in run.end().waiting] == ["a"]


def test_a_run_is_resumed_from_its_log(live):
    records = killed(live)
    bus = LocalSlots(SURVEY.executable)
    restore(bus, SURVEY.executable, records)
    second = live(SURVEY, Script(), resumed=records, bus=bus)
    assert second.end().outcome is Outcome.SUCCESS
    assert second.script.robots["a"].recovered == (("start", "one"), "two")
    assert second.script.robots["a"].begun[:3] == ["ready", "recovered", "two"]
    result = replay(SURVEY, [*records, *(r._replace(time=r.time + 1e3) for r in second.records)])
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_a_robot_that_cannot_be_taken_up_again_can_be_tried_again_later(live):
    records = killed(live)
    bus = LocalSlots(SURVEY.executable)
    restore(bus, SURVEY.executable, records)
    second = live(SURVEY, Script(recovered=inf), resumed=records, bus=bus)
    second.wait_for(lambda: len(second.script.robots) == 2 and second.script.robots["b"].recovered)
    second.script.robots["a"].fail("REFUSED")
    second.script.robots["b"]._finish("recovered")
    second.wait_for(lambda: "'a': has done HOLD" in second.said)
    second.script.robots["a"].armed = False
    second.script.robots["a"].armed = False
    for id in ("a", "b"):
        second.order(STOP, id)
    ending = second.end()
    assert ending.suspended == ("a",)
    assert ending.faults["a"].which == "REFUSED"
    assert [record.label for record in second.records if record.robot == "a"] == []


def test_a_robot_that_ended_by_a_fault_is_left_alone_and_the_others_go_on(live):
    first = live(TWO, Script(walk=inf))
    first.wait_for_step("a begin walk")
    first.wait_for_step("b begin walk")
    first.order(LAND, "a")
    first.script.robots["b"].fail("BATTERY_LOW")
    first.wait_for(lambda: "'a': has done LAND" in first.said)
    first.order(STOP, "b")
    records = tuple(record for record in first.records if record.detail != "STOPPED")
    second = live(TWO, Script(), resumed=records)
    ending = second.end()
    assert list(second.script.robots) == ["b"]
    assert ending.outcome is Outcome.FAILED
    assert ending.faults == {"a": Fault("ORDERED")}
    assert "b end stop" in second.shown()


def test_a_robot_that_waits_for_one_that_failed_before_is_told_so(live):
    behaviour = program(
        robot("a", [do("walk", after=(notify("b.s"),))]),
        robot("b", [do("h")], waits={"h": ["s"]}, policies=(Policy("PEER_LOST", "LAND", 0.1),)),
    )
    first = live(behaviour, Script(walk=inf, h=inf))
    first.wait_for_step("b begin h")
    first.order(LAND, "a")
    records = tuple(first.records)
    second = live(behaviour, Script(), resumed=records)
    assert second.end().faults["b"].which == "PEER_LOST"


@pytest.mark.parametrize("kept", range(1, 14))
def test_a_run_is_resumed_after_any_of_its_steps(live, kept):
    behaviour = program(
        robot("a", [do("one", after=(notify("b.s"),)), do("two")]),
        robot("b", [do("h"), do("i")], waits={"h": ["s"]}),
    )
    whole = live(behaviour, Script())
    whole.end()
    records = tuple(whole.records[:kept])
    bus = LocalSlots(behaviour.executable)
    restore(bus, behaviour.executable, records)
    rest = live(behaviour, Script(), resumed=records, bus=bus)
    assert rest.end().outcome is Outcome.SUCCESS
    result = replay(behaviour, [*records, *(r._replace(time=r.time + 1e3) for r in rest.records)])
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_a_log_of_another_behaviour_is_refused(live, kinds):
    run = live(WALK, Script())
    run.end()
    other = program(robot("r", [do("swim")]))
    given = inputs_of(TargetInput(other, {ROBOT_TYPE: robot_type()}, **kinds), {})
    live_run = live_run_for(other, given, Script().factory, LocalSlots(other.executable), {})
    with pytest.raises(ValueError, match="not one of its program's"):
        run_live(replace(live_run, resumed=tuple(run.records)))
