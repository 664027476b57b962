"""Questions of choices: which answers are taken, and that each decides one choice."""

import pytest

from mmrs_runtime.conditions import awaiting, truth
from mmrs_runtime.questions import Questions


def test_the_choice_that_an_answer_decides_uses_it_up():
    questions = Questions(["answer:again", "answer:go on?"])
    questions.give("again", True)
    questions.give("go on?", False)
    heard = questions.answers()
    assert heard["again"] is True
    questions.use_up(heard)
    assert questions.answers() == {"go on?": False}


def test_the_last_answer_before_the_choice_counts():
    questions = Questions(["answer:again"])
    questions.give("again", True)
    questions.give("again", False)
    assert questions.answers() == {"again": False}


def test_an_answer_that_nobody_looked_at_is_kept():
    questions = Questions(["answer:again"])
    questions.give("again", True)
    questions.use_up(questions.answers())
    assert questions.answers() == {"again": True}


def test_an_answer_to_another_question_is_not_taken():
    questions = Questions(["answer:go on?", "wind-above:8"])
    assert questions.give("go on", True) == "no choice asks 'go on'; there is 'go on?'"
    assert questions.answers() == {}


def test_functions_of_the_users_may_ask_what_they_like():
    assert Questions(["calm enough"]).give("is it calm", True) == ""


@pytest.mark.parametrize("found", [True, 1, 1.0])
def test_what_equals_true_is_true(found):
    assert truth(found) is True


@pytest.mark.parametrize("found", ["no", None, 2, float("nan"), [True]])
def test_what_is_neither_true_nor_false_decides_nothing(found):
    with pytest.raises(TypeError, match="is neither True nor False"):
        truth(found)


def test_people_are_told_what_a_choice_waits_for():
    assert awaiting("answer:go on?") == "waits for an answer to 'go on?'"
    assert awaiting("wind-above:8") == "waits until 'wind-above:8' is known"
