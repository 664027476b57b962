"""A plan chooses as its flight did."""

import pytest
from mmrs_multicopter.testing import robot_program

from mmrs_core.behaviour.program import Transition
from mmrs_core.contributions.execution import Condition, RobotState
from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_core.pictures.flights.planned import choosing_as
from mmrs_core.testing.programs import move, program
from mmrs_runtime.records.steps import StepRecord

STATE = RobotState(0.0, (0.0, 0.0, 0.0), 0.0, 0.0, None)


def robot(id):
    """Return a robot that looks again and again, as long as a condition holds."""
    loop = {1: Transition(1, 1, condition="again", otherwise=2)}
    stays = [move("look", "HoldPosition", duration=1.0), move("back", "HoldPosition", duration=1.0)]
    return robot_program(id, stays, transitions=loop)


BEHAVIOUR = program(robot("alpha"), robot("beta"))


def flight(**answers):
    flown = {}
    for id in ("alpha", "beta"):
        steps = enumerate(answers.get(id, ()))
        flown[id] = Flown(
            id, tuple(StepRecord("r", id, i, i, 0.0, "choose", "look", each) for i, each in steps)
        )
    return Flight("r", flown)


def choosing(flown, assume=None, known=None):
    made = choosing_as(flown, BEHAVIOUR, assume or {}, known or {})
    asked = {each.id: each.transitions[1].condition for each in made.program.robots}
    return made, {id: lambda own=own: made.conditions[own].holds(STATE) for id, own in asked.items()}


def test_every_choice_answers_in_the_order_of_its_own_log():
    _, ask = choosing(flight(alpha=("true", "true", "false"), beta=("false",)))
    assert [ask["alpha"]() for _ in range(3)] == [True, True, False]
    assert ask["beta"]() is False


def test_a_loop_that_was_broken_off_ends_in_the_plan():
    _, ask = choosing(flight(alpha=("true",)))
    answers = [ask["alpha"]() for _ in range(200)]
    assert answers[:50] == [True] * 50
    assert False in answers


def test_a_choice_that_was_never_asked_answers_as_the_condition_did_elsewhere():
    made, ask = choosing(flight(alpha=("false",)))
    assert ask["beta"]() is False
    assert not made.notes


@pytest.mark.parametrize("answer", [True, False])
def test_a_choice_that_was_never_asked_answers_as_it_is_told_to(answer):
    made, ask = choosing(flight(), assume={"again": answer})
    assert ask["alpha"]() is answer
    assert not made.notes


def test_a_choice_that_was_never_asked_is_decided_by_what_is_known_of_its_condition():
    made, ask = choosing(flight(), known={"again": Condition("again", lambda state: state.speed > 1.0)})
    assert ask["alpha"]() is False
    assert not made.notes


def test_a_condition_of_which_nobody_knows_anything_holds_and_a_note_says_so():
    made, ask = choosing(flight())
    assert ask["alpha"]() is True
    assert list(made.notes) == ["condition 'again' was never evaluated; the plan assumes that it holds"]
