"""What becomes of what the user's functions find, or fail to find."""

from __future__ import annotations

import sys
import threading
from math import nan

import pytest
from flight_crew import HOME, NORTH

from mmrs_mavlink.program import Geographic, Local, Object
from mmrs_runtime.controllers import user_functions as objects
from mmrs_runtime.controllers.state import State
from mmrs_runtime.controllers.user_functions import place_of
from mmrs_runtime.faults import FaultError

HERE = State(0.0, HOME, 0.0, 0.0, 1.0)


def found(locate, expected=None, tolerance=None):
    return place_of(Object("the hive", expected, tolerance), {"the hive": locate}, HERE)


def test_an_object_is_where_it_was_found():
    assert found(lambda state, expected: NORTH) == NORTH


@pytest.mark.parametrize(
    "locate",
    [
        lambda state, expected: None,
        lambda state, expected: (42.0, 13.0),
        lambda state, expected: Local(0.0, 0.0, 0.0),
        lambda state, expected: Geographic(nan, 13.0, 0.0),
        lambda state, expected: Geographic("north", 13.0, 0.0),
        lambda state, expected: 1 / 0,
        lambda state, expected: sys.exit(),
    ],
)
@pytest.mark.parametrize("expected", [None, NORTH])
def test_a_function_of_the_users_that_finds_no_place_ends_the_program_by_a_fault_of_its_own(locate, expected):
    with pytest.raises(FaultError, match="object 'the hive': ") as fault:
        found(locate, expected, 5.0)
    assert fault.value.event == "OBJECT_NOT_FOUND"


def test_an_object_too_far_from_where_it_should_be_is_not_gone_to():
    with pytest.raises(FaultError, match=r"22\.\d m from where it should be"):
        found(lambda state, expected: HOME, Geographic(NORTH.latitude, NORTH.longitude, 0.0), 5.0)


@pytest.fixture
def hanging():
    release = threading.Event()
    yield lambda state, expected: release.wait(30.0)
    release.set()


def test_a_function_that_does_not_answer_in_time_finds_nothing(monkeypatch, hanging):
    monkeypatch.setattr(objects, "ANSWER_SECONDS", 0.2)
    with pytest.raises(FaultError, match=r"its locator has not answered for 0\.2 s") as missed:
        found(hanging)
    assert missed.value.event == "OBJECT_NOT_FOUND"


def test_orders_are_obeyed_while_a_function_looks(hanging):
    class OrderedError(Exception):
        pass

    def guard():
        raise OrderedError

    with pytest.raises(OrderedError):
        place_of(Object("the hive"), {"the hive": hanging}, HERE, guard)
