"""The robot types that plug-ins ship: valid, under their name, with the sources of their figures."""

import re
from pathlib import Path

import pytest

from mmrs_core.cli import run
from mmrs_core.languages.reading import read_model
from mmrs_core.plugins import load_plugins

SHIPPED = load_plugins().contributions.robot_types
PAGE = (Path(__file__).parents[3] / "docs" / "robot-types.md").read_text(encoding="utf-8")
ADDRESS = re.compile(r"https://[^\s<>)]+")


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_type_is_valid_and_has_the_name_it_is_contributed_under(name, plugins, capsys):
    file = SHIPPED[name].file
    assert run(["validate", str(file)]) == 0
    assert capsys.readouterr() == (f"{file}: valid\n", "")
    (root,) = read_model(file, plugins.contributions.languages).roots
    assert root.name == name


@pytest.mark.parametrize("name", SHIPPED)
def test_the_comment_of_a_shipped_type_names_its_sources_and_assumptions(name):
    comment = SHIPPED[name].file.read_text(encoding="utf-8").partition("-->")[0]
    sources = ADDRESS.findall(comment)
    assert sources
    assert "Assumptions" in comment
    assert [address for address in sources if f"({address})" not in PAGE] == []
    assert f"\n| {name} | " in PAGE
