"""What controllers refuse to begin without, or with."""

from __future__ import annotations

from dataclasses import replace

from flight_crew import robot_of

from mmrs_mavlink.program import Choose
from mmrs_runtime.conditions import standard
from mmrs_runtime.controllers import Local
from mmrs_runtime.controllers.user_functions import UserFunctions
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
