"""The page of constraints says what the constraints say."""

from __future__ import annotations

import runpy
from pathlib import Path

from mmrs_core.analysis.constraints import CONSTRAINTS
from mmrs_core.analysis.constraints.page import page_of

ROOT = Path(__file__).parents[4]
FIXTURES = ROOT / "tests" / "fixtures" / "constraints"


def examples(fresh) -> dict[str, str]:
    """Return the first message of each constraint's failing model."""
    found = {}
    for file in sorted(FIXTURES.glob("*_cases.py")):
        for code, (breach, *_) in runpy.run_path(str(file))["CASES"].items():
            models = fresh()
            breach(models)
            found[code] = next(fault.message for fault in models.faults() if fault.code == code)
    return found


def test_page_is_what_the_constraints_make_of_it(fresh_models, update_golden):
    page, file = page_of(CONSTRAINTS, examples(fresh_models)), ROOT / "docs" / "constraints.md"
    if update_golden:
        file.parent.mkdir(exist_ok=True)
        file.write_text(page, encoding="utf-8")
    assert file.read_text(encoding="utf-8") == page


def test_page_lists_constraints_by_code_without_examples_where_there_are_none():
    page = page_of(CONSTRAINTS[:1], {})
    assert f"### {CONSTRAINTS[0].code}\n" in page
    assert "Breach" not in page
