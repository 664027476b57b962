"""The page about commands is what their help says; `--update-golden` writes it anew."""

from pathlib import Path

import pytest
import typer

from mmrs_core.cli import run
from mmrs_core.cli.app import app_for
from mmrs_core.cli.settings import Settings

FROM_PLUGINS = ("sitl",)

PAGE = Path(__file__).parents[2] / "docs" / "commands.md"
HEAD = "# Commands\n\nThis page is made from the help of the commands; do not edit it.\n"


def called(arguments):
    """Return the core's commands by name, the called one with all that is in it."""
    return typer.main.get_command(app_for(arguments, Settings(only_core=True))).commands


def names_of_all():
    """Yield the names of all commands, those of a group behind it."""
    for name in called(["--help"]):
        yield from (f"{name} {inner}".strip() for inner in getattr(called([name])[name], "commands", [""]))


def section(name: str, text: str) -> str:
    return f"## {name}\n\n```text\n{text.strip()}\n```\n"


@pytest.fixture
def made(capsys, monkeypatch):
    """Return the page as the commands' help gives it."""
    monkeypatch.setenv("COLUMNS", "100")
    sections = [HEAD]
    for command in ("", *names_of_all()):
        assert run([*command.split(), "--help", "--no-plugins"]) == 0
        name = f"mmrs {command}".strip()
        sections.append(section(name, capsys.readouterr().out))
    for command in FROM_PLUGINS:
        assert run([command, "--help"]) == 0
        sections.append(section(f"mmrs {command}", capsys.readouterr().out))
    return "\n".join(sections)


def test_the_page_is_current(made, update_golden):
    if update_golden:
        PAGE.write_text(made, encoding="utf-8", newline="\n")
    assert PAGE.read_text(encoding="utf-8") == made
