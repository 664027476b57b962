"""Battery changes that operators confirm while robots run."""

from math import inf

import pytest
from live_runs import WALK, Script, do

from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import program, robot
from mmrs_runtime.orders.orders import BATTERY_CHANGED, RESUME, STOP
from mmrs_runtime.vehicle import Vehicle

pytestmark = pytest.mark.real_time("parts of flights")

LOW = (Policy("BATTERY_LOW", "RETURN"),)
PAIR = program(robot("a", [do("one"), do("two")], policies=LOW), robot("b", [do("walk")]))


def at_rest(live, **script):
    """Return a run in which `a` stands for its battery, while `b` works, and its robot."""
    run = live(PAIR, Script(two=inf, walk=inf, **script))
    run.wait_for_step("a begin two")
    walker = run.script.robots["a"]
    walker.fail("BATTERY_LOW")
    run.wait_for(lambda: "'a': has done RETURN" in run.said)
    walker.armed = False
    return run, walker


def test_a_robot_that_stands_for_its_battery_counts_it_as_changed_and_can_be_resumed(live):
    run, walker = at_rest(live)
    assert run.order(BATTERY_CHANGED, "a").confirmed
    assert walker.changes == 1
    assert run.order(RESUME, "a").confirmed
    run.order(STOP)


def test_the_change_is_confirmed_once_the_vehicle_counts_it(live):
    run, walker = at_rest(live)
    run.script.battery_change = None
    order = run.orders.give(BATTERY_CHANGED, ["a"])
    run.wait_for(lambda: walker.changes == 1)
    assert not order.settled.wait(0.1)
    run.script.battery_change = ""
    assert order.settled.wait(20.0)
    assert order.confirmed
    run.order(STOP)


@pytest.mark.parametrize(
    ("armed", "change", "why"),
    [
        (False, "its vehicle still reports 27%", "its vehicle still reports 27%"),
        (True, "", "it is not seen to be disarmed"),
    ],
)
def test_a_change_that_does_not_count_is_refused_with_the_reason(live, armed, change, why):
    run, walker = at_rest(live)
    walker.armed, run.script.battery_change = armed, change
    assert run.order(BATTERY_CHANGED, "a").refused == {"a": why}
    walker.armed = False
    run.order(STOP)


def test_a_robot_whose_program_has_ended_refuses_it(live):
    run = live(program(robot("a", [do("one")]), robot("b", [do("walk")])), Script(walk=inf))
    run.wait_for_step("a end stop")
    assert run.order(BATTERY_CHANGED, "a").refused == {"a": "its program has ended"}
    run.order(STOP, "b")


def test_a_robot_that_has_not_begun_refuses_it(live):
    run = live(WALK, Script(ready=inf))
    order = run.order(BATTERY_CHANGED, "r")
    assert order.refused == {"r": "it has not begun: its battery is compared when it gets ready"}
    run.order(STOP)


def test_a_vehicle_that_knows_nothing_of_changes_says_so():
    class Plain(Vehicle):
        def do(self, order, now, *, through=False):
            raise NotImplementedError

        respond = state = do

    assert Plain().battery_change(0.0) == "its charge counts as its battery reports it"
