"""Flights on real firmware took as long as the same models are planned, and checked, to take.

MMRS_RECORDED_FLIGHTS is a folder of recorded flights, each as `benchmarks/flown_times.py` describes; the
folders of flights with a PX4 have names that begin with ``px4``.
"""

import os
from functools import cache
from pathlib import Path

import pytest
from flown_times.calibrated import calibrate, class_of, copied, flights_of
from flown_times.comparison import LEGS_WITHIN, MOST_LEGS, compared

FOLDER = os.environ.get("MMRS_RECORDED_FLIGHTS", "")
FLIGHTS = sorted(each.parent for each in Path(FOLDER).glob("*/behaviour.xmi")) if FOLDER else []
STUCK = ("rover-arcs-stuck", "sub-guided", "sub-guided-resend-120")
"""Flights that show what an earlier driver did wrong."""

GUESSED = 'maxAcceleration="5" maxJerk="20" settlingTime="0"'
"""Figures of legs by which copters are planned to take 5 to 39 % less than they took."""

pytestmark = pytest.mark.skipif(not FLIGHTS, reason="MMRS_RECORDED_FLIGHTS is no folder of recorded flights")


@pytest.fixture(scope="module")
def found():
    flights = [each for each in FLIGHTS if each.name not in STUCK]
    return [each for flight in flights for each in compared(flight, px4=flight.name.startswith("px4"))]


def halves():
    """Return two halves of the recorded flights: every second one of each class and way of commanding."""
    kinds = {}
    for each in FLIGHTS:
        if each.name not in STUCK:
            kinds.setdefault((class_of(each), "auto" in each.name), []).append(each)
    return tuple([each for kind in kinds.values() for each in kind[half::2]] for half in (0, 1))


@cache
def flights_in(half, kind, scratch):
    """Return the flights of one half, of vehicles of one class; of PX4s no track was recorded."""
    folders = [each for each in halves()[half] if class_of(each) == kind]
    return [flight for folder in folders for flight in flights_of(folder, scratch)]


@pytest.fixture(scope="module")
def scratch(tmp_path_factory):
    return tmp_path_factory.mktemp("logs") / "flight.tlog"


def calibrated(folders, by, scratch, into, stated=""):
    """Return comparisons of flights with models that have the figures of the other half of all flights.

    Args:
        folders: of the flights. by: the other half.
        into: folder for copies of the models.
        stated: of legs, by the robot types before; empty: nothing.
    """
    copies = [copied(each, into) for each in folders]
    for file in (file for each in copies for file in (each / "robots").iterdir() if stated):
        before, end, after = file.read_text("utf-8").partition("</movementCapabilities>")
        ways = "".join(f'<legTimings flownAs="{way}" {stated}/>' for way in ("STEP", "MISSION"))
        file.write_text(before + ways + end + after, "utf-8")
    for kind in {class_of(each) for each in copies}:
        if flights := flights_in(by, kind, scratch):
            calibrate([each for each in copies if class_of(each) == kind], flights)
    return [each for copy in copies for each in compared(copy, px4=class_of(copy) == "px4")]


def test_flights_take_what_is_planned_and_keep_to_the_bounds_of_the_check(found):
    assert any(each.whole for each in found)
    assert [f"{each.flight} {fault}" for each in found for fault in each.faults()] == []


def test_nearly_all_legs_take_what_is_planned(found):
    legs, good = sum(len(each.legs) for each in found), sum(each.good_legs for each in found)
    assert legs
    assert good >= MOST_LEGS * legs, f"{good} of {legs} within {LEGS_WITHIN:.0%}"


@pytest.mark.parametrize("half", [0, 1])
def test_half_of_the_flights_take_what_is_planned_by_the_figures_of_the_other(half, scratch, tmp_path):
    """Those of PX4s, and the only one of a submarine, are planned by the figures of their autopilots."""
    found = calibrated(halves()[half], 1 - half, scratch, tmp_path)
    assert [f"{each.flight} {fault}" for each in found for fault in each.faults()] == []
    legs, good = sum(len(each.legs) for each in found), sum(each.good_legs for each in found)
    assert good >= MOST_LEGS * legs, f"{good} of {legs} within {LEGS_WITHIN:.0%}"


@pytest.mark.parametrize(
    ("by", "names"), [(0, ("lawn-auto", "handwritten-guided")), (1, ("carbon-dioxide-auto",))]
)
def test_figures_that_were_guessed_are_mended_by_the_other_half(by, names, scratch, tmp_path):
    """The second half has only four legs of copters between stops that were commanded one by one: too few."""
    folders = [each for each in halves()[1 - by] if each.name in names]
    assert len(folders) == len(names)
    found = calibrated(folders, by, scratch, tmp_path, GUESSED)
    assert [f"{each.flight} {fault}" for each in found for fault in each.faults()] == []
    assert all(each.good_legs >= MOST_LEGS * len(each.legs) for each in found)
