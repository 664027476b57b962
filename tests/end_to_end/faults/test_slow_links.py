"""Orders over links on which everything takes its time: no request of ours is a pilot's."""

import threading

import pytest
from fault_table.fleet import GENERATED, Fleet
from fault_table.project import Pad
from patience import wait_for

from mmrs_runtime.orders.ordering import give

SPEEDUP = 5.0
DELAY = 0.15 * SPEEDUP
"""Seconds of the run, either way."""

PATIENCE = 60.0

pytestmark = [pytest.mark.real_time("faults"), pytest.mark.thorough]
"""Setting a vehicle up takes half a minute so; what a request is has tests of its own."""


@pytest.fixture
def flown(tmp_path):
    """Return a robot whose vehicle hears, and is heard, late; its program has begun."""
    with Fleet(tmp_path, [Pad("a", stay=30.0)], GENERATED, speedup=SPEEDUP) as fleet:
        fleet.start("--inject", f"delay={DELAY}")
        yield fleet


def begun(fleet, move):
    found = lambda: any(s["label"] == "begin" and s["move"] == move for s in fleet.steps("a"))  # noqa: E731
    assert wait_for(found, PATIENCE), fleet.process.said


def ordered(fleet, *orders):
    """Give orders a tenth of a second apart; return the replies of the robot in their order."""
    replies: dict[str, object] = {}

    def ask(order):
        (replies[order],) = give(fleet.logs, order, ["a"], seconds=20.0)

    threads = [threading.Thread(target=ask, args=(order,)) for order in orders]
    for thread in threads:
        thread.start()
        threading.Event().wait(0.1)
    for thread in threads:
        thread.join()
    return [replies[order] for order in orders]


def is_nobodys_but_ours(fleet):
    said = "\n".join(fleet.process.said)
    boxes = [line.get("what") for line in fleet.box("a")]
    return "somebody else" not in said and "hands off" not in said and "TAKEN_OVER" not in boxes


def test_an_order_while_the_first_mode_is_on_its_way_is_obeyed(flown):
    begun(flown, "up")
    (landing,) = ordered(flown, "land")
    flown.process.end(PATIENCE)
    assert landing["confirmed"], landing
    assert not flown.vehicles["a"].autopilot.armed
    assert is_nobodys_but_ours(flown), flown.process.said


def test_somebody_who_changes_his_mind_again_and_again_is_obeyed_each_time(flown):
    begun(flown, "stay")
    replies = ordered(flown, "hold", "land", "return")
    assert replies[-1]["confirmed"], replies
    flown.process.end(PATIENCE)
    vehicle = flown.vehicles["a"].autopilot
    assert not vehicle.armed
    assert vehicle.body.position == pytest.approx((0.0, 0.0, 0.0), abs=0.6)
    assert is_nobodys_but_ours(flown), flown.process.said
