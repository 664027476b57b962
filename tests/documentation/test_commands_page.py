"""The page about commands is what their help says; `--update-golden` writes it anew."""

from pathlib import Path

import pytest

from mmrs_core.cli import run

PAGE = Path(__file__).parents[2] / "docs" / "commands.md"
CORE = (
    "demo",
    "validate",
    "plan",
    "check",
    "generate",
    "simulate",
    "replay",
    "preview",
    "show",
    "convert",
    "diff",
    "migrate",
)
GROUPS = (
    "plugin list",
    "plugin new",
    "metamodel list",
    "metamodel diff",
    "metamodel export",
    "metamodel docs",
    "metamodel stubs",
)
HEAD = "# Commands\n\nThis page is made from the help of the commands; do not edit it.\n"


@pytest.fixture
def made(capsys, monkeypatch):
    """Return the page as the commands' help gives it."""
    monkeypatch.setenv("COLUMNS", "100")
    sections = [HEAD]
    for command in ("", *CORE, *GROUPS):
        assert run([*command.split(), "--help", "--no-plugins"]) == 0
        name = f"mmrs {command}".strip()
        sections.append(f"## {name}\n\n```text\n{capsys.readouterr().out.strip()}\n```\n")
    return "\n".join(sections)


def test_the_page_is_current(made, update_golden):
    if update_golden:
        PAGE.write_text(made, encoding="utf-8", newline="\n")
    assert PAGE.read_text(encoding="utf-8") == made


def test_every_command_is_told(made, capsys):
    run(["--help", "--no-plugins"])
    listed = capsys.readouterr().out.split("Commands:\n")[1].split("\n\n")[0]
    names = {line.split()[0] for line in listed.splitlines() if line.startswith("  ") and line[2] != " "}
    assert names == {command.split()[0] for command in (*CORE, *GROUPS)}
