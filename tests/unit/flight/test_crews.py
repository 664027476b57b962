"""The robots of a process: which of them still work, and who is woken by an order."""

from __future__ import annotations

import pytest

from mmrs_mavlink.crews import Crews
from mmrs_runtime.orders.orders import Order
from mmrs_runtime.phases import ENDED, HELD, HELD_EARLY, SUSPENDED, WAITS, WORKS


@pytest.fixture
def crews():
    return Crews(["alpha", "beta"])


def test_robots_wait_for_their_vehicles_at_first_and_that_counts_as_work(crews):
    assert crews.status("alpha") == {"phase": WAITS}
    assert crews.others_work("alpha")


@pytest.mark.parametrize(
    ("leave", "phase"), [(Crews.suspend, SUSPENDED), (Crews.dismiss, ENDED), (Crews.engage, WORKS)]
)
def test_who_waits_for_a_battery_or_has_ended_does_not_work(crews, leave, phase):
    leave(crews, "beta")
    assert crews.status("beta") == {"phase": phase}
    assert crews.others_work("alpha") is (phase == WORKS)
    assert crews.others_work("beta")


@pytest.mark.parametrize(
    ("enter", "phase"),
    [(None, HELD_EARLY), (Crews.engage, HELD), (Crews.suspend, SUSPENDED), (Crews.dismiss, ENDED)],
)
def test_people_who_ask_are_told_that_a_robot_is_held(crews, enter, phase):
    crews.held["beta"] = lambda: True
    if enter is not None:
        enter(crews, "beta")
    assert crews.status("beta") == {"phase": phase}
    assert crews.status("alpha") == {"phase": WAITS}


def test_a_robot_is_no_other_to_itself():
    assert not Crews(["alpha"]).others_work("alpha")


def test_who_has_ended_refuses_what_it_was_told_and_what_it_is_told(crews):
    before = crews.inboxes["alpha"].give(Order("hold"))
    crews.dismiss("alpha")
    after = crews.inboxes["alpha"].give(Order("hold"))
    assert [receipt.why for receipt in (before, after)] == ["its program has ended"] * 2
    assert crews.inboxes["beta"].give(Order("hold")).confirmed is None


def test_an_order_wakes_its_robot_and_no_other(crews):
    woken = []
    crews.wake = {name: lambda name=name: woken.append(name) for name in ("alpha", "beta")}
    crews.inboxes["beta"].give(Order("hold"))
    assert woken == ["beta"]
