"""Who has ended: what robots say themselves goes before what others say of them."""

import time

import pytest
from hub import Hub

from mmrs_runtime.bus import Member, Node, Owned
from mmrs_runtime.bus.messages import CommandId, Ended, written
from mmrs_runtime.bus.watching import Watching

pytestmark = pytest.mark.real_time("parts of flights")

RUN = "run-0"


@pytest.fixture
def ends():
    """Return a function that plugs a robot into a hub: it sets the slot of 'early'."""
    hub, made = Hub(), []

    def start(robot: str, slots=(), setters=()) -> Node:
        owned = Owned(robot, slots, dict.fromkeys(slots, setters), {})
        node = Node([Member(owned, frozenset() if slots else frozenset({"early"}))], RUN, carrier=hub.plug())
        made.append(node)
        return node

    yield start
    for node in made:
        node.close()


def until(test) -> None:
    end = time.monotonic() + 5.0
    while not test():
        assert time.monotonic() < end
        time.sleep(0.01)


def early(ends) -> Node:
    return ends("early", ("word",), ("late",))


def said(node: Node, robot: str, lamport: int) -> None:
    """Have a robot tell a node that another one has ended."""
    (told,) = node.robots
    node.serve(told, "gossip", written(Ended(CommandId(RUN, "gossip", "1", 0), ((robot, lamport),))))


def test_a_robot_that_comes_late_is_told_who_has_ended_and_when(ends):
    witness, gone = ends("witness"), early(ends)
    gone.use(41)
    gone.leave("early")
    gone.close()
    late = ends("late")
    until(lambda: late.lost(["early"]) == ("early",))
    assert late.lamport >= 41
    assert witness.lost(["early"]) == ("early",)


def test_a_notify_to_a_robot_that_has_ended_before_needs_no_answer_of_it(ends):
    ends("witness")
    gone = early(ends)
    gone.leave("early")
    gone.close()
    late = ends("late")
    delivery = late.prepare(CommandId(RUN, "late", "", 1), (("early", "word"),), True)
    until(lambda: delivery.lamport is not None)
    delivery.send(delivery.lamport)
    until(lambda: not delivery.waiting)


def test_nobody_is_told_anything_where_nobody_has_ended(ends):
    witness = ends("witness")
    late = ends("late")
    assert late.lost(["witness", "early"]) == ()
    assert witness.lost(["late"]) == ()


def test_a_robot_that_is_here_has_not_ended_whatever_others_say(ends):
    node = ends("late")
    early(ends)
    said(node, "early", 5)
    assert node.lost(["early"]) == ()


def test_a_robot_that_comes_after_all_had_not_ended(ends):
    node = ends("late")
    said(node, "early", 5)
    assert node.lost(["early"]) == ("early",)
    early(ends)
    assert node.lost(["early"]) == ()


def test_nobody_else_ends_the_robots_of_a_process(ends):
    node = ends("late")
    said(node, "late", 5)
    assert node.lost(["late"]) == ()


def test_what_others_say_is_passed_on():
    watching = Watching()
    assert watching.hear_say("a", 3)
    watching.left["b"] = 4
    assert watching.ended() == {"a": 3, "b": 4}
