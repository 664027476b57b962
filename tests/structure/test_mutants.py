"""The hand-made faults can be put where `benchmarks/mutants.py` says, and the tests that find them exist."""

from pathlib import Path

import pytest

from benchmarks.mutants import MUTANTS

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_a_fault_has_its_place_and_its_tests(mutant):
    assert (ROOT / mutant.file).read_text("utf-8").count(mutant.old) == 1
    assert [each for each in mutant.tests if not (ROOT / each).exists()] == []
