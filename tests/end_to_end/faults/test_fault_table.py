"""What goes wrong: what was declared must happen, by the vehicle's own record.

There is a row for each fault and each class of its response that takes a way of its own through the engine
or the driver: going somewhere (RETURN, EMERGENCY_AREA), coming down (LAND, SURFACE), staying (HOLD), and
carrying on; at different moments of the flight. Rows fly together, each with a robot of its own, and none
flies twice.
"""

from typing import get_args

import pytest
from fault_table.blows import DRILLS
from fault_table.journeys import JOURNEYS
from fault_table.orders import ORDERS
from fault_table.rows import ROWS
from fault_table.trial import batches, fly

from mmrs_core.scene import PolicyEvent

pytestmark = pytest.mark.real_time("faults")

ALL = (*ROWS, *ORDERS)
FAST = tuple(row for row in ALL if row.fast)
REST = tuple(row for row in ROWS if not row.fast)
OTHER_ORDERS = tuple(row for row in ORDERS if not row.fast)
MOST_ROWS = 82
CLASSES = {"RETURN": "goes", "EMERGENCY_AREA": "goes", "LAND": "comes down", "SURFACE": "comes down"}

USUAL_SPEED = 2.5
"""Leaves a machine that tests much else at the same time enough real time for each second of the run."""


def title(case) -> str:
    return case.title


def flown_by(rows, folder, speedup, size=10):
    outcomes = [
        outcome
        for number, batch in enumerate(batches(rows, size))
        for outcome in fly(batch, folder / f"batch-{number}", speedup=speedup)
    ]
    return dict(zip((row.title for row in rows), outcomes, strict=True))


@pytest.fixture(scope="module")
def usual(tmp_path_factory):
    """Return what became of the rows that are always tested, flown together."""
    return flown_by(FAST, tmp_path_factory.mktemp("usual"), USUAL_SPEED, len(FAST))


@pytest.fixture(scope="module")
def others(tmp_path_factory):
    """Return what became of all other faults."""
    return flown_by(REST, tmp_path_factory.mktemp("others"), 2.0 * USUAL_SPEED)


@pytest.fixture(scope="module")
def ordered(tmp_path_factory):
    """Return what became of all other orders, given in real time."""
    return flown_by(OTHER_ORDERS, tmp_path_factory.mktemp("orders"), 1.0, len(OTHER_ORDERS))


@pytest.mark.parametrize("row", FAST, ids=title)
def test_what_goes_wrong_is_answered_as_declared(usual, row):
    assert usual[row.title].problems == []


@pytest.mark.thorough
@pytest.mark.timeout(900)
@pytest.mark.parametrize("row", REST, ids=title)
def test_everything_that_goes_wrong_is_answered_as_declared(others, row):
    assert others[row.title].problems == []


@pytest.mark.thorough
@pytest.mark.timeout(900)
@pytest.mark.parametrize("row", OTHER_ORDERS, ids=title)
def test_every_order_is_obeyed_in_every_state_in_less_than_a_second(ordered, row):
    assert ordered[row.title].problems == []


@pytest.mark.parametrize(
    "drill",
    [pytest.param(each, marks=[] if each.fast else pytest.mark.thorough, id=each.name) for each in DRILLS],
)
def test_robots_come_to_a_declared_end_whatever_happens_to_their_process(drill, tmp_path):
    outcomes = drill.fly(tmp_path)
    assert outcomes
    assert [(outcome.title, outcome.problems) for outcome in outcomes if outcome.problems] == []


@pytest.mark.thorough
@pytest.mark.parametrize("stages", JOURNEYS, ids=lambda each: each.name)
def test_every_journey_of_several_processes_comes_to_a_declared_end(stages, tmp_path):
    assert stages.fly(tmp_path).problems == []


def rows_of_all():
    return (*ALL, *(row for drill in DRILLS for row in drill.rows))


def test_titles_tell_rows_apart():
    titles = [row.title for row in ALL]
    assert len(set(titles)) == len(titles)


def test_the_table_stays_small():
    assert len(rows_of_all()) + len(JOURNEYS) <= MOST_ROWS


@pytest.mark.parametrize("event", get_args(PolicyEvent))
def test_every_event_of_policies_is_answered_in_two_ways(event):
    """Those of the disk, and of the vehicle's battery when it is charged, have one answer each."""
    answers = {row.policy[1] for row in rows_of_all() if row.policy is not None and row.policy[0] == event}
    classes = {CLASSES.get(answer, answer) for answer in answers}
    assert len(classes) >= (1 if event == "LOG_FAILED" else 2)
