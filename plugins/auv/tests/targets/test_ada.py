from __future__ import annotations

import os
import re
import shutil

import pytest
from ada_centres import judge, write
from dives import dive, swim
from hypothesis import given, settings
from hypothesis import strategies as st
from mmrs_auv.targets.ada import literals
from mmrs_auv.targets.ada.bus import catalogue

from mmrs_core.behaviour.program import Transition
from mmrs_core.testing.programs import feedback
from mmrs_core.testing.small_programs import notify

NASTY = ('"; end Build; --', "é\n🦑\x7f\t", "'" * 300)
names = st.text(st.characters(exclude_categories=("Cs",)), min_size=1, max_size=60)


@pytest.fixture(scope="module")
def compiler():
    if shutil.which("gnatmake") is None:
        message = "gnatmake is not installed: compiles decision centres in Ada"
        pytest.fail(message) if os.environ.get("MMRS_REQUIRE_PEERS") == "1" else pytest.skip(message)


def read_back(expression):
    """Return the text that an expression of Ada stands for, read by nothing of ours."""
    data = bytearray()
    for plain, code in re.findall(r'"((?:[^"])*)"|Character\'Val \((\d+)\)', expression):
        data += plain.encode("ascii") if not code else bytes([int(code)])
    return data.decode("utf-8")


@settings(max_examples=100)
@given(st.text(st.characters(exclude_categories=("Cs",))))
def test_a_text_is_written_so_that_it_can_be_read_back_and_lines_stay_short(text):
    made = literals.string(text)
    assert read_back(made) == text
    assert made.isascii()
    assert max(map(len, made.splitlines())) < 250


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_keeps_its_value(number):
    made = literals.value(number)
    assert re.fullmatch(r"\(?-?\d+\.\d+(E-?\d+)?\)?", made)
    assert float(made.strip("()")) == number


@pytest.mark.parametrize("wrong", [float("nan"), float("inf"), object(), None])
def test_what_ada_has_no_expression_for_is_refused(wrong):
    with pytest.raises(ValueError):
        literals.value(wrong)


def named(words):
    """Return a behaviour in which everything is called so."""
    first, second, third = (f"{word}{number}" for number, word in enumerate(words))
    moves = [
        swim(first, 1.0, 2.0, 1.0, after=(feedback(second), notify(("naiad", third))), task=second),
        swim(second, -1.0, 2.0, 1.0, task=third, rule=first),
    ]
    ways = {1: Transition(1, 2, waits=(third,), condition=words[0], otherwise=3)}
    return dive(*moves, slots=(third,), transitions=ways)


@pytest.mark.parametrize("order", range(3))
def test_names_of_any_kind_compile_without_a_warning(order, tmp_path, compiler):
    words = NASTY[order:] + NASTY[:order]
    assert judge(write(named(words), tmp_path)) == ""


@pytest.mark.parametrize(
    ("condition", "undecided"),
    [("battery-below:0.3", 0), ('detected:a "b\n', 0), ("wind-above:3", 1), ("battery-below:low", 1)],
)
def test_conditions_of_any_kind_compile_without_a_warning(condition, undecided, tmp_path, compiler):
    ways = {1: Transition(1, 2, condition=condition, otherwise=3)}
    moves = [swim("a", 1.0, 2.0, 1.0), swim("b", 0.0, 2.0, 1.0)]
    robot = write(dive(*moves, transitions=ways), tmp_path)
    assert judge(robot) == ""
    assert (robot / "conditions.adb").read_text().count("Nobody_Says (") == 1 + undecided


@pytest.mark.thorough
@settings(max_examples=40, deadline=None)
@given(st.tuples(names, names, names))
def test_random_names_compile_without_a_warning(tmp_path_factory, compiler, words):
    assert judge(write(named(words), tmp_path_factory.mktemp("ada"))) == ""


def test_the_catalogue_holds_what_a_decision_centre_says_and_hears():
    messages = {each["name"]: each for each in catalogue()["messages"]}
    assert messages["GoalPose"]["id"] == 0x401
    assert {field["name"] for field in messages["Progress"]["fields"]} == {
        "Goal", "State", "Distance", "Sequence", "Check",
    }  # fmt: skip
