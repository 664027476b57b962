"""``mmrs-gen``, ``mmrs-gen explain`` and templates of one's own, as a user types them."""

import json
import shutil
from pathlib import Path

import pytest

from mmrs_core.cli import run

EXAMPLE = Path(__file__).parents[3] / "examples" / "handwritten"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Return a folder with a behaviour and the controllers that were generated from it."""
    folder = tmp_path_factory.mktemp("explained")
    shutil.copytree(EXAMPLE, folder / "project")
    assert generate(folder / "project", folder / "code") == 0
    return folder


@pytest.fixture(autouse=True)
def here(made, monkeypatch):
    monkeypatch.chdir(made)


def generate(project, code, *more):
    line = [str(project), "--target", "mavlink-python", "-o", str(code), *more]
    return run(line, program="mmrs-gen")


def explained(*arguments):
    return run(["explain", *arguments], program="mmrs-gen")


def controller():
    return sorted(Path("code").glob("robot_*.py"))[0]


def go_to():
    """Return a line of the first controller with a GoTo."""
    lines = controller().read_text().splitlines()
    return next(number for number, line in enumerate(lines, 1) if "GoTo(" in line)


def test_a_line_is_explained_by_its_move_and_the_line_of_the_model(capsys):
    assert explained(f"{controller()}:{go_to()}") == 0
    told = capsys.readouterr().out
    assert "move '" in told
    assert "move in behaviour.xmi:" in told
    assert "from robot.py.jinja of target mavlink-python" in told
    explained(f"{controller()}:{go_to()}", "--json")
    (served,) = json.loads(capsys.readouterr().out)["serves"]
    file, line = served["model"].split(":")
    assert f'"{served["move"]}"' in (Path("project") / file).read_text().splitlines()[int(line) - 1]


def test_a_line_about_a_robot_is_explained_by_the_line_of_the_robot(capsys):
    lines = controller().read_text().splitlines()
    home = next(number for number, line in enumerate(lines, 1) if line.startswith("    home="))
    assert explained(f"{controller()}:{home}", "--json") == 0
    (served,) = json.loads(capsys.readouterr().out)["serves"]
    file, line = served["model"].split(":")
    assert f'id="{served["robot"]}"' in (Path("project") / file).read_text().splitlines()[int(line) - 1]


def test_the_lines_of_a_move_are_listed(capsys):
    explained(f"{controller()}:{go_to()}", "--json")
    (served,) = json.loads(capsys.readouterr().out)["serves"]
    assert explained("code", "--move", served["move"], "--robot", served["robot"]) == 0
    assert f"{controller()}:{served['lines'][0]}" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "code"),
    [(["code"], 2), (["code/fleet.py:x"], 2), (["code/nothing.py:1"], 3), (["code", "--move", "none"], 1)],
)
def test_what_cannot_be_explained_is_said(arguments, code, capsys):
    assert explained(*arguments) == code
    assert capsys.readouterr().err.startswith("mmrs: ")


def test_a_changed_file_is_said_to_be_changed(capsys, tmp_path):
    shutil.copytree("code", tmp_path / "code")
    file = tmp_path / "code" / controller().name
    file.write_text(file.read_text() + "# mine\n")
    assert explained(f"{file}:{go_to()}") == 0
    assert "was changed after it was generated" in capsys.readouterr().err


def test_a_robot_engineer_adds_a_line_to_every_controller(capsys, tmp_path):
    own = tmp_path / "templates" / "mavlink-python"
    own.mkdir(parents=True)
    block = '{% block main %}\nVERSION = "ours"\n\n{{ super() }}\n{%- endblock %}\n'
    (own / "robot.py.jinja").write_text('{% extends "shipped/robot.py.jinja" %}\n' + block)
    assert generate("project", tmp_path / "code", "--templates", str(tmp_path / "templates")) == 0
    assert "with a file of yours in place of the target's own:\n  robot.py.jinja" in capsys.readouterr().out
    controllers = list((tmp_path / "code").glob("robot_*.py"))
    assert controllers
    for file in controllers:
        text = file.read_text()
        compile(text, file, "exec")
        assert text.count('VERSION = "ours"') == 1


def test_an_unknown_template_is_refused(capsys, tmp_path):
    (tmp_path / "mavlink-python").mkdir()
    (tmp_path / "mavlink-python" / "robott.py.jinja").touch()
    assert generate("project", tmp_path / "code", "--templates", str(tmp_path)) == 1
    assert "has no such file" in capsys.readouterr().err


def test_what_was_left_out_is_told_at_the_end(capsys, tmp_path):
    line = ["project", "--target", "wpl", "-o", str(tmp_path)]
    assert run(line, program="mmrs-gen") == 1
    refused = [words[4:] for words in capsys.readouterr().err.splitlines() if words.startswith("  - ")]
    assert refused
    assert run([*line, "--allow-lossy"], program="mmrs-gen") == 0
    _, told = capsys.readouterr().out.split("left out, since the target cannot express it:\n")
    told, _ = told.split("left for you to do before it works:\n")
    assert [words[2:] for words in told.splitlines()] == refused
    assert json.loads((tmp_path / "wpl.manifest.json").read_text())["losses"] == refused
