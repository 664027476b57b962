"""The page about commands is what their help says; `--update-golden` writes it anew."""

from pathlib import Path

import pytest
import typer

from mmrs_core.cli import run
from mmrs_core.cli.app import app_for
from mmrs_core.cli.settings import Settings

PAGE = Path(__file__).parents[2] / "docs" / "commands.md"
HEAD = "# Commands\n\nThis page is made from the help of the commands; do not edit it.\n"


def names_of(group, before=""):
    """Yield the names of all commands, those of a group behind it."""
    for name, command in group.commands.items():
        inner = getattr(command, "commands", None)
        if inner is None:
            yield before + name
        else:
            yield from names_of(command, f"{before}{name} ")


@pytest.fixture
def made(capsys, monkeypatch):
    """Return the page as the commands' help gives it."""
    monkeypatch.setenv("COLUMNS", "100")
    sections = [HEAD]
    for command in ("", *names_of(typer.main.get_command(app_for(["--help"], Settings(only_core=True))))):
        assert run([*command.split(), "--help", "--no-plugins"]) == 0
        name = f"mmrs {command}".strip()
        sections.append(f"## {name}\n\n```text\n{capsys.readouterr().out.strip()}\n```\n")
    return "\n".join(sections)


def test_the_page_is_current(made, update_golden):
    if update_golden:
        PAGE.write_text(made, encoding="utf-8", newline="\n")
    assert PAGE.read_text(encoding="utf-8") == made
