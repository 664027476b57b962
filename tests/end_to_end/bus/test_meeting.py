"""Beginning together: nobody begins before all are ready, and then all at one instant."""

import threading
import time

import pytest
from stalls import Stalls

from mmrs_runtime.bus import Incomplete, begin_together

pytestmark = pytest.mark.real_time("buses")

NAMES = ("a", "b", "c")
CLOCKS_AGREE = 1e-4
"""Seconds that rounding may cost."""


class Ready:
    """A robot that is ready and waits for the others, in a thread."""

    def __init__(self, node, robot: str, ahead: float = 0.0) -> None:
        self.begun = self.found = None
        self.missing: list[str] = []
        self._node, self._robot, self._ahead = node, robot, ahead
        self.thread = threading.Thread(target=self._run)
        self.thread.start()

    def _run(self) -> None:
        clock = lambda: time.monotonic() + self._ahead  # noqa: E731
        self.found = begin_together(self._node, self._robot, NAMES, self.missing.append, clock)
        self.begun = time.monotonic()


@pytest.mark.thorough
def test_robots_of_several_processes_begin_at_one_instant(ends):
    stalls = Stalls()
    ready = [Ready(ends.open(robot), robot) for robot in NAMES]
    for each in ready:
        each.thread.join(20.0)
    instants = [each.begun for each in ready]
    skews = [each.found.skew for each in ready]
    assert max(instants) - min(instants) < 0.25 + stalls.seconds
    assert max(instants) - min(instants) <= 2 * max(skews) + 0.05 + stalls.seconds


def test_clocks_that_differ_are_measured(ends):
    stalls = Stalls()
    ready = [
        Ready(ends.open(robot), robot, ahead)
        for robot, ahead in zip(NAMES, (0.0, 1000.0, -50.0), strict=True)
    ]
    for each in ready:
        each.thread.join(20.0)
    for each, ahead in zip(ready[1:], (-1000.0, 50.0), strict=True):
        assert each.found.offset == pytest.approx(ahead, abs=each.found.uncertainty + CLOCKS_AGREE)
        assert each.found.uncertainty < 0.2 + stalls.seconds
    instants = [each.begun for each in ready]
    assert max(instants) - min(instants) < 0.25 + stalls.seconds


def test_nobody_begins_before_all_are_ready_and_each_is_told_who_is(ends):
    first = [Ready(ends.open(robot), robot) for robot in NAMES[:2]]
    time.sleep(1.5)
    assert [each.begun for each in first] == [None, None]
    assert any("2 of 3 are ready: 'a', 'b'" in why for why in first[1].missing)
    last = Ready(ends.open("c"), "c")
    for each in (*first, last):
        each.thread.join(20.0)
        assert each.begun is not None


def ignore(why: str) -> None:
    """Need no words."""


def test_whoever_waits_for_too_long_says_who_has_not_come(ends):
    first = ends.open("a")
    with pytest.raises(Incomplete, match="'b', 'c' are not ready; never seen on the bus: 'b', 'c'"):
        begin_together(first, "a", NAMES, ignore, patience=0.2)


def test_a_robot_whose_list_keeper_has_not_come_says_so(ends):
    with pytest.raises(Incomplete, match="'a', 'c' are not ready"):
        begin_together(ends.open("b"), "b", NAMES, ignore, patience=0.2)


def test_a_robot_that_waits_no_longer_is_not_counted_as_ready(ends):
    for robot in NAMES[:2]:
        ends.open(robot)
    with pytest.raises(Incomplete, match="'a', 'c' are not ready"):
        begin_together(ends.nodes[1], "b", NAMES, ignore, patience=1.0)
    with pytest.raises(Incomplete, match="'b' is not ready"):
        begin_together(ends.nodes[0], "a", ("a", "b"), ignore, patience=0.5)


def test_waiting_for_the_others_can_be_ended(ends):
    class Tired(Exception):  # noqa: N818
        pass

    def guard(why: str) -> None:
        raise Tired

    with pytest.raises(Tired):
        begin_together(ends.open("b"), "b", NAMES, guard)
