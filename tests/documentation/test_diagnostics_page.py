"""The page about diagnostics is what the code says, and its examples are true."""

import runpy
from pathlib import Path

import pytest
from diagnostics_page import page_of
from fault_examples import (
    contrast,
    core_examples,
    judged,
    judged_cases,
    judged_examples,
    plugin_examples,
    reading_cases,
    reading_examples,
    verdict_examples,
)

from mmrs_core.cli.catalogue import catalogue_of
from mmrs_core.contributions.checks import Status

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "diagnostics.md"
PLUGINS = {"mmrs-auv", "mmrs-mavlink", "mmrs-multicopter", "mmrs-rover", "mmrs-solar", "mmrs-survey"}
CONFTEST = runpy.run_path(str(ROOT / "tests" / "unit" / "analysis" / "constraints" / "conftest.py"))


def fresh_models():
    registry = CONFTEST["registry"].__wrapped__()
    made = (CONFTEST["errand"](registry), CONFTEST["place"](), CONFTEST["quad"](), CONFTEST["program"]())
    return CONFTEST["Models"](registry, *made)


@pytest.fixture(scope="module")
def entries(contributions):
    found = catalogue_of(contributions).values()
    return [entry for entry in found if not entry.plugin or entry.plugin in PLUGINS]


@pytest.fixture(scope="module")
def examples(tmp_path_factory, contributions):
    reading = reading_examples(tmp_path_factory.mktemp("read"), fresh_models)
    verdicts = verdict_examples() | judged_examples(contributions.checks)
    return reading | core_examples(fresh_models) | plugin_examples() | verdicts


def test_the_page_is_what_the_code_makes_of_it(entries, examples, update_golden):
    page = page_of(entries, examples)
    if update_golden:
        PAGE.write_text(page, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page


def test_every_fault_of_a_model_has_an_example(entries, examples):
    assert {entry.code for entry in entries} == set(examples)


def test_every_example_shows_what_fails_and_what_passes_and_that_they_differ(examples):
    assert [code for code, each in examples.items() if not (each.failing and each.passing)] == []
    assert [code for code, each in examples.items() if each.failing == each.passing] == []


@pytest.mark.parametrize("code", sorted(reading_cases(ROOT, fresh_models)))
def test_what_fails_has_the_fault_and_what_passes_has_not(code, tmp_path):
    finder, failing, passing = reading_cases(tmp_path, fresh_models)[code]
    assert code in {fault.code for fault in finder(failing)}
    assert code not in {fault.code for fault in finder(passing)}


@pytest.mark.parametrize("name", sorted(judged_cases()))
def test_what_is_wrong_is_violated_and_what_is_right_is_safe(contributions, name):
    wrong, right = (judged(contributions.checks, name, case) for case in judged_cases()[name])
    assert {each.status for each in wrong} == {Status.VIOLATED}
    assert {each.status for each in right} == {Status.SAFE}


def test_every_entry_says_what_is_expected_and_how_to_mend_it(entries):
    for entry in entries:
        assert entry.expected, entry.code
        assert entry.hint, entry.code


def test_words_about_codes_are_lower_case_without_a_full_stop(entries):
    for entry in entries:
        for words in (entry.meaning, entry.expected, entry.hint):
            assert not words.endswith("."), f"{entry.code}: {words}"
            first = words.split()[0]
            assert words[0].islower() or first.isupper() or len(first) == 1 or first[0].isupper(), entry.code


def test_a_contrast_shows_the_attributes_that_differ():
    failing, passing = contrast(b'<a name="x" p="1" q="2"/>', b'<a name="x" p="1" q="3"/>')
    assert (failing, passing) == ('<a name="x" q="2" …/>', '<a name="x" q="3" …/>')
