"""Every constraint is broken by one model and kept by another."""

import runpy
from pathlib import Path

import pytest

from mmrs_core.analysis.constraints import CONSTRAINTS

FIXTURES = Path(__file__).parents[3] / "fixtures" / "constraints"
CASES = {
    code: case
    for file in sorted(FIXTURES.glob("*_cases.py"))
    for code, case in runpy.run_path(str(file))["CASES"].items()
}


def test_sound_project_breaks_no_constraint(models):
    assert [str(fault) for fault in models.faults()] == []


def test_every_constraint_has_a_failing_and_a_passing_model():
    assert set(CASES) == {constraint.code for constraint in CONSTRAINTS}


@pytest.mark.parametrize("code", sorted(CASES))
def test_constraint_is_broken_by_its_failing_model_and_says_what_where_and_how_to_mend_it(models, code):
    breach, _, *others = CASES[code]
    breach(models)
    assert models.codes() - set(others) == {code}
    for fault in models.faults([each for each in CONSTRAINTS if each.code == code]):
        assert fault.hint
        assert fault.place.path
        assert not fault.message.endswith(".")
        assert "\n" not in fault.message


@pytest.mark.parametrize("constraint", CONSTRAINTS, ids=lambda each: each.code)
def test_constraint_is_kept_by_its_passing_model(models, constraint):
    _, near, *_others = CASES[constraint.code]
    near(models)
    assert not models.faults([constraint])


def test_codes_differ():
    assert len({constraint.code for constraint in CONSTRAINTS}) == len(CONSTRAINTS)


def test_titles_are_sentences():
    assert all(each.title[0].isupper() and each.title.endswith(".") for each in CONSTRAINTS)


def test_hints_are_no_sentences():
    assert all(each.hint and not each.hint.endswith(".") for each in CONSTRAINTS)
