"""The pages about capabilities are what trying gives; `--update-golden` writes them anew."""

from pathlib import Path

import pytest
from capabilities_page import page_of

from mmrs_core.generation.capabilities.judging import capabilities_of

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize(
    ("page", "title", "targets"),
    [
        ("capabilities.md", "Capabilities of the targets", ("mavlink-python", "qgc-plan", "wpl")),
        (
            "capabilities-underwater.md",
            "Capabilities: underwater vehicles",
            ("ada", "can-c", "can-python", "imc", "moos"),
        ),
    ],
)
def test_a_page_is_current(page, title, targets, contributions, update_golden):
    known = contributions.targets
    tables = {name: capabilities_of(known[name], contributions) for name in targets}
    made = page_of(title, tables, {name: known[name].description for name in targets})
    if update_golden:
        (DOCS / page).write_text(made, encoding="utf-8", newline="\n")
    assert (DOCS / page).read_text(encoding="utf-8") == made
