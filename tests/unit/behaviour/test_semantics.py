"""The step rules."""

from dataclasses import replace

import pytest

from mmrs_core.testing.small_programs import go, hold, notify, program, robot, use
from mmrs_runtime.semantics import (
    GlobalState,
    Phase,
    Point,
    apply,
    enabled,
    entry,
    fault,
    initial,
    is_deadlock,
    is_success,
    missing,
    steps,
    waiting,
)


def alone(each):
    """Return a robot as the engine executes it."""
    return program(each).executable.robots[0]


def labels(each):
    return [f"{step.label} {step.move} {step.detail}".strip() for step in each]


def run_alone(each):
    """Return the labels of a robot that never waits, taking the first arm of each choice."""
    point, found = entry(each, each.start), []
    while not point.is_final:
        step = steps(each, point, frozenset())[0]
        found += labels([step])
        point = step.leads_to
    return found


def test_a_move_begins_and_ends_between_its_actions():
    move = hold("h", before=(use("arm", "open"),), after=(notify("r.s"), use("arm", "close")))
    assert run_alone(alone(robot("r", [move], slots=("s",)))) == [
        "begin start",
        "end start",
        "take start h",
        "act h pre:0",
        "begin h",
        "end h",
        "ntf h post:0",
        "act h post:1",
        "take h stop",
        "begin stop",
        "end stop",
    ]


def test_actions_of_stop_come_before_the_end():
    each = robot("r", [])
    each = replace(each, moves=(each.moves[0], replace(each.moves[1], after=(use("horn", "blow"),))))
    assert run_alone(alone(each))[-1] == "act stop post:0"


def test_a_wait_lets_no_step_through_until_every_slot_is_active():
    each = alone(robot("r", [hold("h")], waits={"h": ["a", "b"]}))
    out = Point("h", Phase.OUT)
    assert steps(each, out, {("r", "a")}) == ()
    assert missing(each, out, {("r", "a")}) == ("b",)
    assert labels(steps(each, out, {("r", "a"), ("r", "b")})) == ["take h stop"]


def test_a_slot_of_that_name_in_another_robot_does_not_count():
    each = alone(robot("r", [hold("h")], waits={"h": ["a"]}))
    assert steps(each, Point("h", Phase.OUT), {("q", "a")}) == ()


def test_a_choice_may_go_either_way_once_its_wait_is_over():
    each = alone(
        robot("r", [hold("h"), hold("x"), hold("y")], choices={"h": ("c", "x", "y")}, waits={"h": ["s"]})
    )
    out = Point("h", Phase.OUT)
    assert steps(each, out, frozenset()) == ()
    ways = steps(each, out, {("r", "s")})
    assert labels(ways) == ["choose h true", "choose h false"]
    assert [way.leads_to.move for way in ways] == ["x", "y"]


def test_passing_a_wait_leaves_the_slot_active():
    behaviour = program(robot("r", [hold("h")], waits={"h": ["s"]})).executable
    state = GlobalState((Point("h", Phase.OUT),), frozenset({("r", "s")}))
    (step,) = enabled(behaviour, state)
    assert apply(behaviour, state, step).active == {("r", "s")}


@pytest.mark.parametrize(("active", "left"), [(True, {("a", "s"), ("b", "s")}), (False, set())])
def test_a_notify_sets_all_its_slots_at_once(active, left):
    behaviour = program(
        robot("a", [hold("h", after=(notify("a.s", "b.s", active=active),))], slots=("s",)),
        robot("b", [], slots=("s",)),
    ).executable
    state = GlobalState((Point("h", Phase.AFTER), Point("start", Phase.READY)), frozenset({("b", "s")}))
    step = next(iter(enabled(behaviour, state)))
    assert step.slot == ("+" if active else "-") + "a.s b.s"
    assert apply(behaviour, state, step).active == left


def test_a_fault_ends_a_robot_wherever_it_is():
    behaviour = program(robot("r", [go("g", (1, 0, 0))])).executable
    step = fault(behaviour.robots[0], Point("g", Phase.BUSY), "WIND")
    state = apply(behaviour, initial(behaviour), step)
    assert list(enabled(behaviour, state)) == []
    assert is_deadlock(behaviour, state)


def test_a_robot_that_waits_for_nobody_is_a_deadlock():
    behaviour = program(robot("r", [hold("h")], waits={"h": ["s"]})).executable
    state = GlobalState((Point("h", Phase.OUT),))
    assert is_deadlock(behaviour, state)
    (only,) = waiting(behaviour, state)
    assert (only.robot, only.move, only.slots) == ("r", "h", ("s",))


def test_all_robots_at_their_end_are_a_success():
    behaviour = program(robot("a", []), robot("b", [])).executable
    assert not is_success(initial(behaviour))
    done = GlobalState((Point("stop", Phase.DONE), Point("stop", Phase.DONE)))
    assert is_success(done)
    assert not is_deadlock(behaviour, done)
