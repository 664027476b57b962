"""The page about capabilities is what trying gives; `--update-golden` writes it anew."""

from __future__ import annotations

from pathlib import Path

from mmrs_core.cli.pages.capabilities_page import page_of
from mmrs_core.pipeline import capabilities
from mmrs_core.plugins import load_plugins

PAGE = Path(__file__).parents[2] / "docs" / "capabilities.md"


def test_the_page_is_current(update_golden):
    contributions = load_plugins(only_core=True).contributions
    descriptions = {name: target.description for name, target in contributions.targets.items()}
    made = page_of(capabilities(None, contributions), descriptions)
    if update_golden:
        PAGE.write_text(made, encoding="utf-8", newline="\n")
    assert PAGE.read_text(encoding="utf-8") == made
