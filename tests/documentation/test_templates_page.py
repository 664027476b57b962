"""The page about templates tells what each of them sees."""

from __future__ import annotations

from pathlib import Path

import pytest

from mmrs_core.mavlink.targets import TARGETS
from mmrs_core.testing.programs import target_input, two_drones

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "templates.md").read_text(encoding="utf-8")


ROWS = [line for line in PAGE.splitlines() if line.startswith("|")]


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_every_name_that_a_template_sees_is_told(target):
    for spec in target.files(target_input(two_drones())):
        if spec.view:
            (row,) = [
                line for line in PAGE.splitlines() if line.startswith("|") and f"{spec.template}`" in line
            ]
            assert [name for name in spec.view if f"`{name}`" not in row] == []


def test_every_template_is_told():
    names = [path.name for target in TARGETS for path in target.templates.glob("*.jinja")]
    assert [name for name in names if f"{name}`" not in PAGE] == []
