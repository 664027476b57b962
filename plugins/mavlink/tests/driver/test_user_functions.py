"""What controllers refuse to begin without, and what becomes of what the user's functions find."""

import sys
import threading
from dataclasses import replace
from math import nan

import pytest
from flight_crew import HOME, NORTH, robot_of

from mmrs_mavlink.program import Choose, Geographic, Local, Object
from mmrs_runtime.conditions import standard
from mmrs_runtime.controllers import user_functions as objects
from mmrs_runtime.controllers.state import State
from mmrs_runtime.controllers.user_functions import UserFunctions, place_of
from mmrs_runtime.faults import FaultError
from mmrs_runtime.vehicle import VehicleState

ASKS = "battery-below:0.3"


def robot(id="alpha", fleet=("alpha", "beta"), asks=""):
    """Return a robot of a fleet; `asks`: the condition of its first choice."""
    made = replace(robot_of(), id=id, fleet=fleet)
    if not asks:
        return made
    first = replace(made.steps[0], then=Choose(asks, made.steps[1].move, made.steps[-1].move))
    return replace(made, steps=(first, *made.steps[1:]))


def decides(*names):
    return UserFunctions(dict.fromkeys(names, lambda state: True), {})


def test_a_condition_that_no_choice_of_a_whole_fleet_asks_for_is_refused_since_it_may_be_misspelt():
    (fault,) = decides("battery-below:0.30").faults([robot(asks=ASKS), robot("beta")])
    assert (
        fault
        == f"conditions.py: condition 'battery-below:0.30': no Choice uses it; conditions in use: '{ASKS}'"
    )


def test_conditions_of_robots_that_run_elsewhere_may_be_there():
    assert decides(ASKS, "calm").faults([robot(asks=ASKS)]) == []


def test_standard_conditions_need_no_thread_but_those_that_users_write_do():
    low, high = "battery-below:0.3", "battery-below:0.9"
    conditions = {low: standard(low), high: lambda state: True}
    robots = [robot("alpha", asks=low), robot("beta", asks=high)]
    decides = UserFunctions(conditions, {}).decides(robots)
    assert {name: each.instant for name, each in decides.items()} == {low: True, high: False}


def test_conditions_are_asked_in_the_words_of_controllers_whatever_the_vehicle_tells():
    asked = []
    decides = UserFunctions({"calm": asked.append}, {}).decides([robot(asks="calm")])
    plain = VehicleState(
        4.0, (1.0, 2.0, 3.0), 0.5, 90.0, None, charge=0.8, found=frozenset({"float"}), answers={"go": True}
    )
    assert decides["calm"].asked(plain) is None
    (state,) = asked
    assert (state.place, state.energy, state.found) == (Local(2.0, 1.0, 3.0), 0.8, {"float"})
    assert (state.time, state.speed, state.heading, state.answers) == (4.0, 0.5, 90.0, {"go": True})


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
