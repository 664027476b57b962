"""The command line as a user types it, in this process."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
import typer

from mmrs_core.cli import run
from mmrs_core.cli.app import program_for
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.commands import CORE_NAMES, Command
from mmrs_core.errors import PluginError
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource
from mmrs_core.plugins import load_plugins

CORE = sorted(CORE_NAMES)


class Kites:
    """A plug-in with a command."""

    @hookimpl
    def mmrs_commands(self):
        return (
            Command("fly-kite", "Fly a kite.", "tests_of_kites:fly"),
            Command("lost", "Lost.", "nowhere.at.all:f"),
            Command("fail", "Fail.", "failing_kites:fly"),
        )


@pytest.fixture
def with_kites(monkeypatch):
    monkeypatch.setattr(
        Settings, "plugins", lambda self: load_plugins(only_core=True, extra={"kites": Kites()})
    )


def test_help_lists_every_command_and_the_exit_codes(capsys):
    assert run(["--help"]) == 0
    out = capsys.readouterr().out
    assert [name for name in CORE if f"\n  {name} " not in out] == []
    assert "4 no feasible plan" in " ".join(out.split())


@pytest.mark.parametrize("name", CORE)
def test_the_list_of_commands_says_what_each_command_says_of_itself(name):
    settings = Settings(only_core=True)
    listed, called = (
        typer.main.get_command(program_for("mmrs", [each], settings).app) for each in ("--help", name)
    )
    shown = [group.commands[name].get_short_help_str(99) for group in (listed, called)]
    assert shown[0] == shown[1]


PARK = Path(__file__).parents[3] / "examples" / "carbon-dioxide"


def completions(words, capfd, monkeypatch):
    """Return what bash is answered, as its completion script asks."""
    program = words.partition(" ")[0]
    monkeypatch.setenv(f"_{program.replace('-', '_').upper()}_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(words.count(" ")))
    assert run([], program=program) == 0
    return capfd.readouterr().out.split()


@pytest.mark.parametrize(
    ("words", "completed"),
    [
        ("mmrs val", ["validate"]),
        ("mmrs validate --dr", ["--dry-run"]),
        ("mmrs bus k", ["keys"]),
        ("mmrs demo ca", ["carbon-dioxide"]),
        ("mmrs generate field --target mavl", ["mavlink-python"]),
        (f"mmrs run {PARK} --robot ", ["Alba", "Brezza", "Cirro"]),
        (f"mmrs bus gateway {PARK / 'mission.xmi'} --robot B", ["Brezza"]),
        ("mmrs run nowhere --robot ", []),
        ("mmrs run field --on-stop ", ["hold", "return", "land"]),
        ("mmrs run field --backend mav", ["mavlink"]),
        ("mmrs simulate field --backend ", ["can-sim", "simulation"]),
        ("mmrs control re", ["resume", "return"]),
        ("mmrs plugin new roof --with ", ["task", "robot", "target", "check", "vehicle"]),
        ("mmrs plugin new roof --with task,", ["task,robot", "task,target", "task,check", "task,vehicle"]),
        ("mmrs plugin new roof --task p", ["polygon", "point"]),
        ("mmrs si", ["simulate", "sitl"]),
        ("mmrs sitl --f", ["--firmware", "--fault", "--for"]),
        ("mmrs sitl --firmware ", ["ardupilot", "px4"]),
        ("mmrs migrate --m", ["--mapping", "--metamodels"]),
        ("mmrs can ", ["dbc", "hub", "monitor", "load"]),
        ("mmrs auv sitl --sp", ["--speedup"]),
        ("mmrs-gen field --target mavl", ["mavlink-python"]),
        ("mmrs-gen explain --m", ["--move"]),
    ],
)
def test_a_shell_completes_commands_options_and_values(words, completed, capfd, monkeypatch):
    assert completions(words, capfd, monkeypatch) == completed


def test_a_shell_completes_robots_and_tasks_of_generated_files(capfd, monkeypatch, tmp_path):
    pool, behaviour, code = PARK.parent / "pool", str(tmp_path / "behaviour.xmi"), tmp_path / "code"
    assert run(["plan", str(pool), "-o", behaviour]) == 0
    models = ["--robots", str(pool / "robots"), "--context", str(pool / "context.xmi")]
    assert run(["generate", behaviour, *models, "--target", "mavlink-python", "-o", str(code)]) == 0
    capfd.readouterr()
    assert completions(f"mmrs explain {code} --robot N", capfd, monkeypatch) == ["Naiad"]
    assert "gate" in completions(f"mmrs explain {code} --task g", capfd, monkeypatch)


def test_a_shell_completes_robots_that_have_logs(capfd, monkeypatch, tmp_path):
    (tmp_path / "a.jsonl").write_text('{"robot": "Alba", "seq": 0}\n')
    (tmp_path / "b.jsonl").write_text("no log")
    assert completions(f"mmrs control hold --log {tmp_path} ", capfd, monkeypatch) == ["Alba"]


@pytest.mark.parametrize("program", ["mmrs", "mmrs-gen"])
def test_a_shell_is_given_a_completion_script(program, capfd, monkeypatch):
    monkeypatch.setenv(f"_{program.replace('-', '_').upper()}_COMPLETE", "source_bash")
    assert run([], program=program) == 0
    assert f"_completion {program}\n" in capfd.readouterr().out


def test_completing_a_command_imports_no_other_command():
    code = "import sys; from mmrs_core.cli import run; run([]); sys.exit('mmrs_core.cli.plan' in sys.modules)"
    environment = os.environ | {
        "_MMRS_COMPLETE": "complete_bash",
        "COMP_WORDS": "mmrs val",
        "COMP_CWORD": "1",
    }
    assert subprocess.run([sys.executable, "-c", code], env=environment, timeout=60).returncode == 0


def test_without_zenoh_the_commands_of_the_bus_have_help_and_name_what_to_install():
    code = (
        "import sys; sys.modules['zenoh'] = None; from mmrs_core.cli import run;"
        "sys.exit(10 * run(['bus', '--help']) + run(['bus', 'state', 'survey']))"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert ended.returncode == 1, ended.stderr
    assert ended.stderr == "mmrs: bus: needs eclipse-zenoh; pip install 'mmrs-core[bus]'\n"


@pytest.mark.parametrize("group", ["", "plugin", "metamodel", "bus", "auv", "can"])
def test_the_list_of_commands_cuts_no_sentence(group, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    run([*group.split(), "--help"])
    listed = capsys.readouterr().out.partition("Commands:\n")[2]
    assert listed
    assert "..." not in listed


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
        (["valdate"], "no such command 'valdate'. Did you mean 'validate', 'calibrate'? try 'mmrs --help'"),
        (["plan", "a", "--stop-after", "lunch"], "lunch"),
        (["plan", "a", "--seed", "x"], "--seed"),
        (["plan", "a", "--explain", "--stop-after", "plan"], "--explain goes with a whole plan"),
        (["generate", "a"], "mmrs: missing: --target, --output; try 'mmrs generate --help'"),
        (["control", "hodl"], "mmrs: hodl: unknown command; expected one of hold, resume"),
        (["explain", "."], ".: expected FILE:LINE; for a folder, add --robot, --move or --task"),
        (["plugin", "new", "Roof"], "'Roof': expected a name in lower-case letters"),
        (["plugin", "new", "roof", "--with", "tusk"], "--with tusk: unknown; there are task, robot"),
        (
            ["plugin", "new", "roof", "--with", "robot", "--task", "line"],
            "creates no task; add task to --with",
        ),
        (["simulate", "a", "--assume", "calm"], "--assume calm: expected CONDITION=yes or CONDITION=no"),
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


def test_a_metamodel_is_for_a_model_not_for_a_project(tmp_path, capsys):
    assert run(["validate", str(tmp_path), "--metamodel", "lab.ecore"]) == 2
    assert "--metamodel is for one model: name its file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (["plan", "nowhere"], "nowhere: error: no such file [FIL001]\n    expected: an existing file"),
        (["plan", "."], "no mission.xmi in this folder"),
        (["check", "."], "no behaviour.xmi in this folder; 'mmrs plan .' makes one"),
        (["run", str(PARK / "mission.xmi")], "contains a mission, not a behaviour; 'mmrs plan "),
        (["diff", ".", "nowhere"], "nowhere: no such file or folder"),
        (["diff", ".", str(PARK / "mission.xmi")], "mission.xmi is a file; name two files or two folders"),
        (["control", "hold"], "logs: no running robots use this log folder; name the folder of the run with"),
        (["explain", "x.py:3"], "x.py: no such file"),
        (["demo", "nope"], "nope: unknown example; there are barn, carbon-dioxide"),
    ],
)
def test_what_is_not_there_is_named_with_what_helps(line, words, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert run(line) in (1, 3, 5)
    assert words in capsys.readouterr().err


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


FAILURES = (
    ("pass\n1 / 0", 1, "failing_kites:fly cannot be imported: ZeroDivisionError"),
    ("raise KeyError('string')", 1, "KeyError('string')"),
    ("raise ValueError('knot')", 1, "ValueError('knot')"),
    ("from mmrs_core.errors import LinkLostError; raise LinkLostError('kite: lost')", 5, "mmrs: kite: lost"),
    ("open('/no/such/kite')", 3, "/no/such/kite: no such file"),
)


@pytest.mark.parametrize(("failure", "code", "words"), FAILURES)
def test_a_plugin_command_that_fails_names_the_plugin(
    with_kites, monkeypatch, tmp_path, capsys, failure, code, words
):
    (tmp_path / "failing_kites.py").write_text(f"def fly(arguments):\n    {failure}\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "failing_kites", raising=False)
    assert run(["fail"]) == code
    err = capsys.readouterr().err
    assert words in err
    blamed = "plug-in 'kites' of distribution 'given by the caller': command 'fail' fails"
    assert (blamed in err) == (code == 1 and "imported" not in words)
    assert ("plug-in 'kites' of distribution" in err) == (code == 1)
    assert "internal error" not in err


def test_no_plugin_can_have_a_name_of_the_core():
    own = typer.main.get_command(program_for("mmrs", ["--help"], Settings(only_core=True)).app)
    assert own.commands.keys() == CORE_NAMES


class Usurper:
    """A plug-in that wants a command of the core."""

    @hookimpl
    def mmrs_commands(self):
        return (Command("plan", "Plan kites.", "kites:plan"),)


@pytest.fixture
def with_usurper(monkeypatch):
    monkeypatch.setattr(
        Settings, "plugins", lambda self: load_plugins(only_core=True, extra={"usurper": Usurper()})
    )


USURPED = "command 'plan': contributed by both 'core' and 'usurper'"


def test_a_command_named_like_one_of_the_core_is_told_beside_the_help_and_stops_those_of_plugins(
    with_usurper, capsys
):
    assert run(["--help"]) == 0
    assert USURPED in capsys.readouterr().err
    assert run(["fly-kite"]) == 1
    assert USURPED in capsys.readouterr().err


def test_plugins_in_conflict_are_listed_with_the_conflict(with_usurper, capsys):
    assert run(["plugin", "list"]) == 1
    captured = capsys.readouterr()
    assert USURPED in captured.err
    assert "usurper (given by the caller)\n  commands: plan" in captured.out
    assert run(["plugin", "list", "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert told["error"] == USURPED
    assert "usurper" in told["plugins"]


class Torn:
    """A plug-in whose metamodel is no XML."""

    def __init__(self, ecore):
        self.ecore = ecore

    @hookimpl
    def mmrs_metamodels(self):
        return (MetamodelSource("urn:torn", self.ecore, "torn"),)


def test_a_plugin_whose_metamodel_cannot_be_read_is_listed(monkeypatch, tmp_path, capsys):
    torn = Torn(tmp_path / "torn.ecore")
    torn.ecore.write_text("<ecore:EPackage")
    monkeypatch.setattr(Settings, "plugins", lambda _: load_plugins(only_core=True, extra={"torn": torn}))
    assert run(["plugin", "list"]) == 1
    captured = capsys.readouterr()
    assert f"torn: {torn.ecore}:1: not well-formed XML" in captured.err
    assert "torn (given by the caller)\n  metamodels: urn:torn" in captured.out
    assert run(["show", str(tmp_path / "any.xmi")]) == 1
    captured = capsys.readouterr()
    assert f"mmrs: torn: {torn.ecore}:1: not well-formed XML" in captured.err
    assert "--no-plugins runs without plug-ins" in captured.err


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
        "classes": "17",
    } in listed


def test_generate_alone_is_called_mmrs_gen(capsys):
    assert run(["--help"], program="mmrs-gen") == 0
    assert capsys.readouterr().out.startswith("Usage: mmrs-gen [OPTIONS]")
