"""The page about templates tells what each of them sees."""

from dataclasses import replace
from pathlib import Path

import pytest
from mmrs_multicopter.testing import target_input, two_drones

from mmrs_core.contributions.targets import Target
from mmrs_core.plugins import load_plugins
from mmrs_core.testing.programs import installed, sample_of

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "templates.md").read_text(encoding="utf-8")
TARGETS = sorted(load_plugins().contributions.targets.values(), key=lambda target: target.name)
INPUTS = {
    "copter": target_input(two_drones()),
    "sub": replace(sample_of("auv").plain, robot_kinds=installed().robot_kinds),
}


def row_of(target: Target, template: str) -> str:
    """Return the row of the table about a template; empty where there is none."""
    rows = (line for line in PAGE.splitlines() if line.startswith(f"| `{target.name}/"))
    return next((row for row in rows if f"/{template}`" in row or f"`{template}`" in row), "")


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_every_name_that_a_template_sees_is_told(target):
    for spec in target.files(INPUTS[target.tried_with]):
        row = row_of(target, spec.template)
        assert [name for name in spec.view if f"`{name}`" not in row] == []


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_every_template_is_told(target):
    names = [path.name for path in target.templates.glob("*.jinja")]
    assert names
    assert [name for name in names if not row_of(target, name)] == []
