"""What commands print and draw stays as people know it; `--update-golden` writes it anew."""

import shutil
from pathlib import Path

import pytest
from lxml import etree

from mmrs_core.cli import run

HERE = Path(__file__).parent
EXPECTED = HERE / "expected"
BROKEN = '<mission:Mission xmlns:mission="urn:mmrs:mission:1.0" nmae="a">\n  <team/>\n</mission:Mission>\n'


@pytest.fixture
def project(tmp_path, monkeypatch):
    """Go to a folder that holds a copy of the project, so that no absolute path is printed."""
    shutil.copytree(HERE / "project", tmp_path / "project")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")
    return Path("project")


@pytest.fixture
def compare(update_golden):
    """Return a function that compares words with those of a golden file."""

    def against(name, words):
        file = EXPECTED / name
        if update_golden:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(words, encoding="utf-8", newline="\n")
        assert words == file.read_text(encoding="utf-8")

    return against


@pytest.mark.parametrize("command", ["check", "simulate"])
def test_words_about_a_behaviour(command, project, compare, capsys):
    assert run([command, str(project)]) == 0
    compare(f"{command}.txt", capsys.readouterr().out)


def test_the_tree_of_a_model(project, compare, capsys):
    assert run(["show", str(project / "behaviour.xmi")]) == 0
    compare("show.txt", capsys.readouterr().out)


def test_the_faults_of_a_mission(project, compare, capsys):
    (project / "mission.xmi").write_text(BROKEN, encoding="utf-8")
    assert run(["validate", str(project)]) == 1
    captured = capsys.readouterr()
    compare("validate.txt", captured.err + captured.out)


def test_what_a_target_refuses(project, compare, capsys):
    assert run(["generate", str(project), "--target", "qgc-plan", "-o", "out"]) == 1
    compare("generate-refused.txt", capsys.readouterr().err)


def test_the_map_of_a_run(project, compare):
    assert run(["preview", str(project / "behaviour.xmi"), "-o", "pictures"]) == 0
    words = Path("pictures/preview.svg").read_text(encoding="utf-8")
    assert etree.fromstring(words.encode()).tag == "{http://www.w3.org/2000/svg}svg"
    compare("preview.svg", words)


def test_no_golden_file_is_left_over():
    expected = [
        "check.txt",
        "simulate.txt",
        "show.txt",
        "validate.txt",
        "generate-refused.txt",
        "preview.svg",
    ]
    assert {path.name for path in EXPECTED.iterdir()} == set(expected)
