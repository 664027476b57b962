"""Runs that are resumed while robots are under way: none of them waits for the others to get ready."""

import time
from math import inf

import pytest
from live_runs import TWO, Script, do

from mmrs_core.contributions.execution import Fault
from mmrs_core.errors import LinkLostError
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import notify, program, robot
from mmrs_runtime.engine.resuming import restore
from mmrs_runtime.orders.orders import HOLD, LAND, RESUME, RETURN, STOP
from mmrs_runtime.semantics import Outcome
from mmrs_runtime.slots import LocalSlots

pytestmark = pytest.mark.real_time("parts of flights")

WAITING = program(
    robot("a", [do("h")], waits={"h": ["s"]}, policies=(Policy("PEER_LOST", "LAND", 0.2),)),
    robot("b", [do("walk", after=(notify("a.s"),))]),
)


@pytest.fixture
def broken_off(live):
    """Return a function that breaks a run off with both robots under way, and resumes it with none ready."""

    def begin(behaviour, move="walk", **more):
        made = moving(live, behaviour, move)
        bus = LocalSlots(behaviour.executable)
        restore(bus, behaviour.executable, made)
        return gets_ready(live, behaviour, Script(ready=inf, **more), resumed=made, bus=bus)

    return begin


def moving(live, behaviour, move="walk"):
    """Return the records of a run that is broken off with both robots under way."""
    first = live(behaviour, Script(walk=inf, h=inf))
    first.wait_for_step(f"a begin {move}")
    first.wait_for_step("b begin walk")
    made = tuple(first.records)
    first.abort()
    return made


def gets_ready(live, behaviour, script, **more):
    """Return a run whose two robots are getting ready."""
    run = live(behaviour, script, **more)
    run.wait_for(lambda: len(run.script.robots) == 2 and all(r.begun for r in run.script.robots.values()))
    return run


def ready(run, *robots):
    for id in robots:
        run.script.robots[id]._finish("ready")


def waits_for_it(run, kind):
    """Give an order to a robot that is not ready, and return it when it is settled, once the robot is."""
    order = run.orders.give(kind, ["a"])
    time.sleep(0.2)
    assert order.open == ("a",)
    ready(run, "a")
    assert order.settled.wait(20.0)
    return order


def test_a_robot_goes_on_before_another_is_ready(broken_off):
    run = broken_off(TWO)
    ready(run, "a")
    run.wait_for_step("a end stop")
    assert run.script.robots["a"].recovered == (("start",), "walk")
    assert run.live_run.status_board.status("b")["phase"] == "waits for its vehicle"
    ready(run, "b")
    assert run.end().outcome is Outcome.SUCCESS


@pytest.mark.parametrize(("kind", "response"), [(LAND, "LAND"), (RETURN, "RETURN"), (STOP, "HOLD")])
def test_a_robot_in_the_air_obeys_at_once_whoever_is_not_ready(broken_off, kind, response):
    run = broken_off(TWO, walk=inf)
    ready(run, "a")
    run.wait_for(lambda: run.script.robots["a"].begun[-1] == "walk")
    assert list(run.order(kind, "a").confirmed) == ["a"]
    assert run.script.robots["a"].stops == [response]


def test_a_robot_is_taken_care_of_by_its_policy_where_the_other_does_not_come(broken_off):
    run = broken_off(WAITING, move="h")
    ready(run, "a")
    run.wait_for_step("a end h")
    run.script.robots["b"].fail("LINK_LOST")
    ending = run.end()
    assert run.script.robots["a"].stops == ["LAND"]
    assert ending.faults["a"].which == "PEER_LOST"
    assert ending.faults["b"] == Fault("LINK_LOST", "says the test")
    assert (ending.absent, ending.suspended) == (("b",), ("b",))
    assert run.script.robots["b"].stops == []
    assert [record for record in run.records if record.robot == "b"] == []
    assert "'b': does not get ready: says the test" in run.said


def test_orders_to_a_robot_that_did_not_come_are_refused(broken_off):
    run = broken_off(TWO, walk=inf)
    ready(run, "a")
    before = run.orders.give(RETURN, ["b"])
    run.script.robots["b"].fail("REFUSED")
    assert before.settled.wait(20.0)
    for order in (before, run.order(LAND, "b"), run.order(RESUME, "b")):
        assert order.refused == {"b": "it did not get ready: REFUSED: says the test"}
    assert run.script.robots["b"].stops == []
    assert run.live_run.status_board.status("b")["phase"] == "has ended"


def test_the_run_does_not_go_on_where_no_robot_comes(broken_off):
    run = broken_off(TWO)
    for id in ("b", "a"):
        run.script.robots[id].fail("LINK_LOST")
    run.end()
    assert isinstance(run.error, LinkLostError)
    assert "robot 'a': does not get ready: says the test" in str(run.error)
    assert run.records == []


def test_a_robot_in_the_air_that_is_to_land_is_told_so_as_soon_as_it_is_known_and_does_not_go_on(broken_off):
    run = broken_off(TWO)
    assert list(waits_for_it(run, LAND).confirmed) == ["a"]
    assert run.script.robots["a"].begun == ["ready", "stop LAND"]


def test_a_robot_whose_motors_are_off_confirms_at_once_that_it_stays(broken_off):
    run = broken_off(TWO)
    run.script.robots["a"].armed = False
    for kind in (HOLD, RETURN, LAND, HOLD):
        assert list(run.order(kind, "a").confirmed) == ["a"]
    ready(run, "a")
    run.wait_for_step("a fault walk ORDERED")
    assert run.script.robots["a"].recovered is None


def test_a_robot_that_is_held_before_it_is_ready_halts_and_goes_on_when_it_may(broken_off):
    run = broken_off(TWO)
    waits_for_it(run, HOLD)
    walker = run.script.robots["a"]
    assert (walker.halted, walker.recovered) == (True, None)
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    run.wait_for_step("a end stop")


def test_a_hold_before_a_robot_is_ready_can_be_taken_back(broken_off):
    run = broken_off(TWO)
    assert run.order(RESUME, "a").refused == {"a": "it is not held"}
    held = run.orders.give(HOLD, ["a"])
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    assert held.settled.wait(20.0)
    assert held.refused == {"a": "resume was ordered since"}
    ready(run, "a")
    run.wait_for_step("a end stop")


def test_a_robot_that_is_not_ready_is_not_touched_where_the_run_is_broken_off_again(live):
    def interrupt(record):
        raise KeyboardInterrupt

    made = moving(live, TWO)
    run = gets_ready(live, TWO, Script(ready=inf), resumed=made, observe=interrupt)
    ready(run, "a")
    run.end()
    assert isinstance(run.error, KeyboardInterrupt)
    assert run.script.robots["a"].stops == ["HOLD"]
    assert run.script.robots["b"].stops == []


LOW = program(*(robot(id, [do("walk")], policies=(Policy("BATTERY_LOW", "RETURN"),)) for id in ("a", "b")))


def come_home(broken_off):
    """Return a run whose robot has come home for its battery before it was ready, and the robot."""
    run = broken_off(LOW)
    walker = run.script.robots["a"]
    walker.recognised = True
    walker.fail("BATTERY_LOW")
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    return run, walker


def test_what_goes_wrong_with_a_robot_that_is_known_is_answered_by_its_policy_before_it_is_ready(broken_off):
    run, walker = come_home(broken_off)
    assert walker.stops == ["RETURN"]
    ready(run, "b")
    ending = run.end()
    assert (ending.suspended, ending.absent) == (("a",), ())
    assert ending.came_down == {"a": "came home for its battery"}
    assert "b end stop" in run.shown()


def test_a_robot_that_came_home_before_it_was_ready_goes_on_with_a_new_battery(broken_off):
    run, walker = come_home(broken_off)
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    run.wait_for_step("a end stop")
    assert walker.recovered == (("start",), "walk")


@pytest.mark.parametrize(("kind", "response"), [(LAND, "LAND"), (RETURN, "RETURN"), (STOP, "HOLD")])
def test_a_robot_that_is_known_obeys_before_it_is_ready(broken_off, kind, response):
    run = broken_off(TWO)
    walker = run.script.robots["a"]
    order = run.orders.give(kind, ["a"])
    time.sleep(0.2)
    assert order.open == ("a",)
    walker.recognised = True
    assert order.settled.wait(20.0)
    assert list(order.confirmed) == ["a"]
    assert walker.begun == ["ready", f"stop {response}"]


def test_a_robot_that_is_known_halts_before_it_is_ready_and_goes_on_when_it_may(broken_off):
    run = broken_off(TWO)
    walker = run.script.robots["a"]
    held = run.orders.give(HOLD, ["a"])
    time.sleep(0.2)
    assert not walker.halted
    walker.recognised = True
    assert held.settled.wait(20.0)
    assert walker.halted
    ready(run, "a")
    time.sleep(0.2)
    assert walker.recovered is None
    assert list(run.order(RESUME, "a").confirmed) == ["a"]
    run.wait_for_step("a end stop")
