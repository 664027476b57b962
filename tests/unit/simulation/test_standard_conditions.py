import re

import pytest

from mmrs_core.contributions.execution import RobotState
from mmrs_core.errors import UsageError
from mmrs_core.simulation.run import refuse_unasked
from mmrs_core.testing.small_programs import hold, program, robot
from mmrs_runtime.engine.decisions import standard_conditions


def state(**known):
    return RobotState(0.0, (0.0, 0.0, 0.0), 0.0, 0.0, None, **known)


def asked(identifier, **known):
    condition = standard_conditions([identifier])[identifier]
    return condition.holds(state(**known)) if condition.known(state(**known)) else None


@pytest.mark.parametrize(("charge", "holds"), [(0.29, True), (0.3, False), (None, None)])
def test_a_battery_is_below_a_part_of_its_charge(charge, holds):
    assert asked("battery-below:0.3", charge=charge) is holds


@pytest.mark.parametrize(("wind", "holds"), [(8.5, True), (8.0, False), (None, None)])
def test_wind_is_above_a_speed(wind, holds):
    assert asked("wind-above:8", wind=wind) is holds


def test_something_is_detected_or_not():
    assert asked("detected:fire", detected=frozenset({"fire"})) is True
    assert asked("detected:fire", detected=frozenset({"smoke"})) is False


@pytest.mark.parametrize("answer", [True, False, None])
def test_a_question_waits_for_its_answer(answer):
    answers = {} if answer is None else {"go on?": answer}
    assert asked("answer:go on?", answers=answers) is answer


@pytest.mark.parametrize(
    "identifier", ["battery-below:low", "wind-above:", "answer:", "sunny", "detected", ""]
)
def test_other_identifiers_are_nobodys(identifier):
    assert standard_conditions([identifier]) == {}


CHOOSES = program(robot("r", [hold("h"), hold("x")], choices={"h": ("sunny", "x", "stop")}), robot("s", []))


def test_what_some_robot_asks_may_be_answered_beforehand():
    refuse_unasked(CHOOSES, {"sunny": True})


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        (CHOOSES, "condition 'suny': no Choice uses it; conditions in use: 'sunny'; did you mean sunny?"),
        (program(robot("s", [])), "condition 'suny': no Choice uses it; conditions in use: none"),
    ],
)
def test_an_answer_that_no_choice_asks_for_is_refused_with_what_is_asked(asked, told):
    with pytest.raises(UsageError, match=f"^{re.escape(told)}$"):
        refuse_unasked(asked, {"suny": True})
