"""Orders to robots whose run goes on in real time."""

import time
from math import inf

import pytest
from live_runs import WALK, Script, do, walking

from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.execution import Fault
from mmrs_core.scene import Policy
from mmrs_core.testing.small_programs import notify, program, robot
from mmrs_runtime.orders.orders import HOLD, LAND, RESUME, RETURN, STOP
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("parts of flights")


@pytest.mark.parametrize(
    ("kind", "response", "fault"),
    [(STOP, "HOLD", "STOPPED"), (RETURN, "RETURN", "ORDERED"), (LAND, "LAND", "ORDERED")],
)
def test_an_order_ends_the_program_and_is_confirmed(live, kind, response, fault):
    run, walker = walking(live)
    order = run.order(kind)
    assert run.end().outcome is Outcome.FAILED
    assert list(order.confirmed) == ["r"]
    assert walker.stops == [response]
    assert (run.records[-1].label, run.records[-1].detail) == ("fault", fault)


@pytest.mark.parametrize(("kind", "confirmed"), [(HOLD, True), (RETURN, True), (RESUME, False)])
def test_a_black_box_knows_what_became_of_an_order_before_people_do(live, kind, confirmed):
    run, walker = walking(live)
    happened = []
    walker.note = lambda what, content: happened.append((what, content.get("confirmed")))
    order = run.orders.give(kind, ["r"], answered=lambda robot, why: happened.append(("told", why is None)))
    assert order.settled.wait(20.0)
    answers = [each for each in happened if each[0] != "decision"]
    assert answers == [("order", confirmed), ("told", confirmed)]


@pytest.mark.parametrize("kind", [HOLD, RESUME, LAND, STOP])
def test_no_order_is_obeyed_while_nobody_knows_whether_a_pilot_has_the_robot(live, kind):
    run, walker = walking(live)
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
    run, walker = walking(live)
    walker.doubted = True
    order = run.orders.give(LAND, ["r"])
    time.sleep(0.2)
    walker.doubted = False
    assert order.settled.wait(20.0)
    assert list(order.confirmed) == ["r"]
    assert walker.stops == ["LAND"]


def test_a_hold_is_refused_once_the_robot_may_go_on_before_it_was_seen_to_halt(live):
    run, walker = walking(live)
    walker.paused = lambda now: False
    held = run.orders.give(HOLD, ["r"])
    assert list(run.order(RESUME).confirmed) == ["r"]
    assert held.settled.wait(20.0)
    assert held.refused == {"r": "resume was ordered since"}


def test_going_on_is_refused_once_the_robot_is_held_again_before_it_was_seen_to_go_on(live):
    run, walker = walking(live)
    run.order(HOLD)
    walker.resume = lambda now: None
    resumed = run.orders.give(RESUME, ["r"])
    assert list(run.order(HOLD).confirmed) == ["r"]
    assert resumed.settled.wait(20.0)
    assert resumed.refused == {"r": "hold was ordered since"}


def test_a_robot_that_is_named_twice_obeys_once(live):
    run, _ = walking(live)
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
    run, walker = walking(live)
    assert list(run.order(HOLD).confirmed) == ["r"]
    walker._finish("walk")
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
    run, walker = walking(live, stop_RETURN=inf)
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
    run, walker = walking(live, stop_RETURN=inf)
    walker.obeys = lambda now: False
    first = run.orders.give(RETURN, ["r"])
    run.wait_for(lambda: walker.stops == ["RETURN"])
    last = run.orders.give(LAND, ["r"])
    run.end()
    assert first.refused == {"r": "something else has happened since: LAND"}
    assert list(last.confirmed) == ["r"]


def test_a_robot_whose_link_comes_back_is_waited_for_and_obeys(live):
    run, walker = walking(live, stop_RETURN=inf)
    walker.respond = lambda response, now: None
    walker.heard, walker.watched = False, lambda now: True
    walker.fail("LINK_LOST")
    run.wait_for(lambda: run.records[-1].label == "fault")
    run.wait_for(lambda: any("not known to have stopped" in line for line in run.said))
    assert run.order(LAND).refused == {"r": "its link is lost"}
    del walker.respond, walker.watched
    walker.watched_for, walker.heard, walker.trouble = True, True, None
    run.wait_for(lambda: "'r': link restored: orders are obeyed" in run.said)
    assert list(run.order(LAND).confirmed) == ["r"]
    walker.watched_for = False
    run.end()


def returning(live):
    """Return a run whose robot was told to stop, and is on its way home when its link is lost."""
    run, walker = walking(live, stop_RETURN=inf)
    run.orders.on_stop = "RETURN"
    run.orders.give(STOP, ["r"])
    run.wait_for(lambda: walker.stops == ["RETURN"])
    walker.watched_for, walker.heard = True, False
    walker.fail("LINK_LOST")
    run.wait_for(lambda: any("not known to have stopped" in line for line in run.said))
    return run, walker


def test_a_robot_that_was_told_to_stop_before_its_link_was_lost_is_listened_for(live):
    run, walker = returning(live)
    walker.heard = True
    run.wait_for(lambda: "'r': link restored: orders are obeyed" in run.said)
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
    run, _ = walking(live)
    assert run.order(RESUME).refused == {"r": "it is not held"}
    assert run.order(HOLD, "somebody").refused == {"somebody": "no such robot here"}


def test_orders_that_come_too_late_are_refused(live):
    run = live(WALK, Script())
    run.end()
    assert run.order(HOLD).refused == {"r": "the run has ended"}
