"""Flights on real firmware took as long as the same models are planned, and checked, to take.

MMRS_RECORDED_FLIGHTS is a folder of recorded flights, each as `benchmarks/flown_times.py` describes; the
folders of flights with a PX4 have names that begin with ``px4``.
"""

import os
from pathlib import Path

import pytest
from flown_times.comparison import LEGS_WITHIN, MOST_LEGS, compared

FOLDER = os.environ.get("MMRS_RECORDED_FLIGHTS", "")
FLIGHTS = sorted(each.parent for each in Path(FOLDER).glob("*/behaviour.xmi")) if FOLDER else []
STUCK = ("rover-arcs-stuck", "sub-guided", "sub-guided-resend-120")
"""Flights that show what an earlier driver did wrong."""

pytestmark = pytest.mark.skipif(not FLIGHTS, reason="MMRS_RECORDED_FLIGHTS is no folder of recorded flights")


@pytest.fixture(scope="module")
def found():
    flights = [each for each in FLIGHTS if each.name not in STUCK]
    return [each for flight in flights for each in compared(flight, px4=flight.name.startswith("px4"))]


def test_flights_take_what_is_planned_and_keep_to_the_bounds_of_the_check(found):
    assert any(each.whole for each in found)
    assert [f"{each.flight} {fault}" for each in found for fault in each.faults()] == []


def test_nearly_all_legs_take_what_is_planned(found):
    legs, good = sum(len(each.legs) for each in found), sum(each.good_legs for each in found)
    assert legs
    assert good >= MOST_LEGS * legs, f"{good} of {legs} within {LEGS_WITHIN:.0%}"
