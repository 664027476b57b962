"""Waiting for the robots to begin with: whatever is lost on the way, it can be ended at once."""

import time
from collections.abc import Container

import pytest
from stalls import Stalls

from mmrs_runtime.bus import Incomplete, Member, Node, Owned, begin_together
from mmrs_runtime.bus.carriers.carrier import NoCarrier
from mmrs_runtime.bus.messages import Meet, request_in, written
from mmrs_runtime.bus.watching import Roster

pytestmark = pytest.mark.real_time("parts of flights")

AT_ONCE = 1.5
"""Seconds, on a busy machine; for an answer that does not come a robot waits for longer."""

ALL = range(1_000)


class Tired(Exception):  # noqa: N818  # a wish, not a fault
    """What ends a wait here."""


class Losing(NoCarrier):
    """Carries requests to the robot that keeps the list, and answers back unless they are lost.

    Attributes:
        listed: who was ready after each request.
    """

    def __init__(self, lost: Container[int]) -> None:
        self.listed: list[tuple[str, ...]] = []
        self._roster, self._lost = Roster(), lost

    def open(self, station) -> None:
        station.noticed("a", True)

    def ask(self, sender, owner, request, answered) -> None:
        asked = request_in(request)
        if not isinstance(asked, Meet):
            return
        answer = self._roster.answer(asked)
        self.listed.append(answer.ready)
        if len(self.listed) - 1 not in self._lost:
            answered(written(answer))


@pytest.fixture
def begin():
    """Return what has ``b`` begin together with ``a``, who keeps the list."""
    opened = []

    def beginning(carrier, guard, **more) -> None:
        opened.append(Node([Member(Owned("b", (), {}, {}), frozenset("a"))], "run-0", carrier=carrier))
        begin_together(opened[-1], "b", ("a", "b"), guard, **more)

    yield beginning
    for node in opened:
        node.close()


def tired_after(seconds: float):
    until = time.monotonic() + seconds

    def guard(why: str) -> None:
        if time.monotonic() > until:
            raise Tired

    return guard


def test_waiting_for_an_answer_that_does_not_come_can_be_ended_at_once(begin):
    stalls, begun = Stalls(), time.monotonic()
    with pytest.raises(Tired):
        begin(Losing(ALL), tired_after(0.2))
    assert time.monotonic() - begun < AT_ONCE + stalls.seconds


def test_taking_leave_of_a_robot_that_answers_no_more_can_be_ended_at_once(begin):
    stalls, begun = Stalls(), time.monotonic()
    with pytest.raises(Tired):
        begin(Losing(ALL[1:]), tired_after(0.2), patience=0.01)
    assert time.monotonic() - begun < AT_ONCE + stalls.seconds


def test_a_robot_that_has_heard_no_answer_is_no_longer_listed_once_it_waits_no_more(begin):
    carrier = Losing({0})
    with pytest.raises(Incomplete):
        begin(carrier, lambda why: None, patience=0.01)
    assert (carrier.listed[0], carrier.listed[-1]) == (("b",), ())


def test_a_robot_that_is_made_to_wait_no_more_is_no_longer_listed(begin):
    carrier = Losing(ALL)
    with pytest.raises(Tired):
        begin(carrier, tired_after(0.2))
    assert (carrier.listed[0], carrier.listed[-1]) == (("b",), ())
