"""The command line as a user types it, in this process."""

import json

import pytest

from mmrs_core.cli import run
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.commands import Command
from mmrs_core.errors import PluginError
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins

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
    "plugin",
    "metamodel",
)


class Kites:
    """A plug-in with a command."""

    @hookimpl
    def mmrs_commands(self):
        return (
            Command("fly-kite", "Fly a kite.", "tests_of_kites:fly"),
            Command("lost", "Lost.", "nowhere.at.all:f"),
        )


@pytest.fixture
def with_kites(monkeypatch):
    monkeypatch.setattr(
        Settings, "plugins", lambda self: load_plugins(only_core=True, extra={"kites": Kites()})
    )


def test_help_lists_every_command(capsys):
    assert run(["--help"]) == 0
    out = capsys.readouterr().out
    assert [name for name in CORE if f"\n  {name} " not in out] == []


def test_help_tells_the_exit_codes(capsys):
    run(["--help"])
    assert "4 no feasible plan" in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    "name", [*CORE, "plugin list", "metamodel list", "metamodel export", "metamodel docs"]
)
def test_every_command_has_help(name, capsys):
    assert run([*name.split(), "--help"]) == 0
    assert capsys.readouterr().out.startswith(f"Usage: mmrs {name}")


@pytest.mark.parametrize("line", [[], ["plugin"], ["metamodel"]])
def test_no_arguments_show_the_help(line, capsys):
    assert run(line) == 2
    assert capsys.readouterr().err.startswith("Usage: mmrs")


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (["plan"], "missing"),
        (["plan", "a", "b"], "unexpected extra argument"),
        (["plan", "a", "--sed", "3"], "no such option"),
        (["fly"], "no such command 'fly'"),
        (["plan", "a", "--stop-after", "lunch"], "lunch"),
        (["plan", "a", "--seed", "x"], "--seed"),
        (["generate", "a"], "--target"),
    ],
)
def test_wrong_usage_ends_with_2_and_says_what_is_wrong(line, words, capsys):
    assert run(line) == 2
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.out == ""


def test_version_is_told(capsys):
    assert run(["--version"]) == 0
    assert capsys.readouterr().out.startswith("mmrs 0.")


def test_a_missing_project_ends_with_3_and_names_it(tmp_path, capsys):
    assert run(["validate", str(tmp_path / "nowhere")]) == 3
    assert "nowhere" in capsys.readouterr().err


def test_plugin_commands_are_in_the_help(with_kites, capsys):
    run(["--help"])
    assert "fly-kite   Fly a kite." in capsys.readouterr().out


def test_a_plugin_command_gets_its_arguments_and_gives_the_exit_code(with_kites, monkeypatch, tmp_path):
    (tmp_path / "tests_of_kites.py").write_text(
        "def fly(arguments):\n    return 5 if arguments == ['--height', '3'] else 9\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    assert run(["fly-kite", "--height", "3"]) == 5


def test_a_plugin_command_that_does_not_import_is_named(with_kites, capsys):
    assert run(["lost"]) == 1
    assert "nowhere.at.all:f" in capsys.readouterr().err


def test_help_and_list_work_with_a_broken_plugin(monkeypatch, capsys):
    def broken(self):
        raise PluginError("plug-in 'kites' of distribution 'kites': broken string")

    monkeypatch.setattr(Settings, "plugins", broken)
    assert run(["--help"]) == 0
    captured = capsys.readouterr()
    assert "validate" in captured.out
    assert "broken string" in captured.err


def test_an_interrupted_command_ends_with_130(monkeypatch, tmp_path):
    def interrupted(self):
        raise KeyboardInterrupt

    monkeypatch.setattr(Settings, "plugins", interrupted)
    assert run(["validate", str(tmp_path)]) == 130


def test_metamodels_are_listed_with_who_provides_them(capsys):
    assert run(["metamodel", "list", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)["metamodels"]
    assert {
        "ns_uri": "urn:mmrs:mission:1.0",
        "name": "mission",
        "provider": "core",
        "classes": "16",
    } in listed


def test_generate_alone_is_called_mmrs_gen(capsys):
    assert run(["--help"], program="mmrs-gen") == 0
    assert capsys.readouterr().out.startswith("Usage: mmrs-gen [OPTIONS]")
