"""The page about commands is what their help says; `--update-golden` writes it anew."""

import tomllib
from pathlib import Path

import pytest
import typer

from mmrs_core.cli import run
from mmrs_core.cli.app import program_for
from mmrs_core.cli.settings import Settings
from mmrs_core.plugins import load_plugins

OURS = {
    tomllib.loads(file.read_text(encoding="utf-8"))["project"]["name"]
    for file in Path(__file__).parents[2].glob("plugins/*/pyproject.toml")
}
PAGE = Path(__file__).parents[2] / "docs" / "commands.md"
HEAD = "# Commands\n\nThis page is made from the help of the commands; do not edit it.\n"


def called(name):
    """Return the commands by name, the called one with all that is in it."""
    return typer.main.get_command(program_for("mmrs", [name], Settings()).app).commands


def from_plugins():
    """Return the names of the commands of this repository's plug-ins."""
    contributions = load_plugins().contributions
    return [
        each.name
        for each in contributions.commands
        if contributions.distribution_of("commands", each) in OURS
    ]


def names_of_all():
    """Yield the names of all commands, those of a group behind it."""
    for name in (*names_of_core(), *sorted(from_plugins())):
        yield name
        yield from (f"{name} {inner}" for inner in getattr(called(name)[name], "commands", ()))


def names_of_core():
    return typer.main.get_command(program_for("mmrs", ["--help"], Settings(only_core=True)).app).commands


def section(name: str, text: str) -> str:
    return f"## {name}\n\n```text\n{text.strip()}\n```\n"


@pytest.fixture
def made(capsys, monkeypatch):
    """Return the page as the commands' help gives it."""
    monkeypatch.setenv("COLUMNS", "100")
    sections = [HEAD]
    assert run(["--help", "--no-plugins"]) == 0
    sections.append(section("mmrs", capsys.readouterr().out))
    for command in names_of_all():
        assert run([*command.split(), "--help"]) == 0
        sections.append(section(f"mmrs {command}", capsys.readouterr().out))
    return "\n".join(sections)


def test_the_page_is_current(made, update_golden):
    if update_golden:
        PAGE.write_text(made, encoding="utf-8", newline="\n")
    assert PAGE.read_text(encoding="utf-8") == made
